/// `tractus calibrate`: what a CT's values mean, and what stands against making a case of it.
#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/command.hpp"
#include "app/lengths.hpp"
#include "cases/carving.hpp"
#include "core/try.hpp"
#include "volume/calibration.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace commands {
namespace {

struct CalibrateOptions {
  std::string volume, entry, target;
  bool json = false;
};

core::Result<void> add_bone(const CalibrateOptions& o, const volume::Volume& ct,
                            volume::Calibration& out) {
  cases::CarvingPlan plan;
  plan.entry_m = TRY(point_m(o.entry, "--entry"));
  plan.target_m = TRY(point_m(o.target, "--target"));
  plan.preparation = volume::Preparation::filled;
  const auto placed = TRY(cases::place(ct, volume::TransferFunction::bone(), plan));
  volume::calibrate_bone(ct, *placed.envelope, placed.tract, out);
  return {};
}

void print_calibration(const volume::Calibration& found) {
  const auto line = [](const char* tissue, const std::optional<double>& value) {
    fmt::print("{:<12} {}\n", tissue, value ? fmt::format("{:.0f} HU", *value) : "not found");
  };
  line("air", found.air);
  line("fat", found.fat);
  line("soft tissue", found.soft_tissue);
  if (found.cancellous) line("cancellous", found.cancellous);
  if (found.cortical) line("cortical", found.cortical);
  if (found.cortex_m)
    fmt::print("{:<12} {:.2f} mm thick (median)\n", "cortex", *found.cortex_m * 1e3);
  for (const auto& warning : found.warnings) fmt::print("warning: {}\n", warning);
}

core::Json calibration_json(const volume::Calibration& found) {
  return {{"air_HU", core::or_null(found.air)},
          {"fat_HU", core::or_null(found.fat)},
          {"soft_tissue_HU", core::or_null(found.soft_tissue)},
          {"cancellous_HU", core::or_null(found.cancellous)},
          {"cortical_HU", core::or_null(found.cortical)},
          {"cortex_m", core::or_null(found.cortex_m)},
          {"warnings", found.warnings}};
}

Outcome run_calibrate(const CalibrateOptions& o) {
  if (o.entry.empty() != o.target.empty())
    return core::Error{core::Errc::bad_input, "--entry and --target go together"};
  const auto ct = TRY(volume_io::read_volume(o.volume, core::terminal_progress("reading")));
  auto found = volume::calibrate(volume::histogram_of(ct.volume), ct.volume.geometry);
  if (!o.entry.empty())
    if (auto bone = add_bone(o, ct.volume, found); !bone)
      return core::Error{bone.error().code, o.volume + ": " + bone.error().what};
  o.json ? void(std::puts(calibration_json(found).dump(2).c_str())) : print_calibration(found);
  return 0;
}

}  // namespace

Command calibrate_command() {
  return {"calibrate", "Show what a CT's values mean: the peaks of tissues, and warnings",
          "tractus calibrate l3.nii.gz --entry 46,200,-61 --target 39,158,-61", [](CLI::App& app) {
            auto o = std::make_shared<CalibrateOptions>();
            app.add_option("FILE", o->volume, "any file or folder that tractus import reads")
                ->required();
            app.add_option("--entry", o->entry,
                           "entry of a tract as x,y,z in mm, LPS: its bone is measured too");
            app.add_option("--target", o->target, "a point on the tract's axis beyond the entry");
            app.add_flag("--json", o->json, "print the result as JSON");
            return [o] { return run_calibrate(*o); };
          }};
}

}  // namespace commands
}  // namespace tractus
