/// `tractus slicer`: a case, and what was done in it, as files that 3D Slicer opens.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <memory>

#include "app/command.hpp"
#include "cases/case.hpp"
#include "cases/markups.hpp"
#include "core/file.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"
#include "trial/signals.hpp"
#include "trial/trial_file.hpp"
#include "volume/io/write_nrrd.hpp"
#include "volume/io/write_surface.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace commands {
namespace {

using core::Errc;
using core::Error;
using core::Json;
namespace fs = std::filesystem;

constexpr std::size_t kPathPoints = 1000;  // more control points make Slicer slow

struct SlicerOptions {
  std::string case_folder, trial, out;
  double surface = 0.0;
  bool surface_given = false, json = false;
};

/// The CT value of half opacity: where the probe begins to feel bone.
double half_opacity_value(const volume::TransferFunction& transfer) {
  const auto& points = transfer.points();
  const double half = 0.5 * (points.front().opacity + points.back().opacity);
  double low = points.front().value, high = points.back().value;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (transfer.opacity(middle) < half ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

core::Result<volume::Volume> read_bone(const cases::OpenedCase& opened) {
  const auto file = TRY(volume::VolumeFile::open(opened.folder / cases::kVolumePart));
  return file.read_all(core::terminal_progress("reading"));
}

core::Result<std::vector<math::Vec3>> read_tip_path(const std::string& file,
                                                    const cases::OpenedCase& opened) {
  const auto trial = TRY(trial::read_trial(file));
  if (trial.header.rig != trial::Rig::palpation)
    return Error{Errc::bad_input, file + ": a palpation trial is expected"};
  if (trial.header.case_id != opened.id)
    return Error{Errc::bad_input,
                 fmt::format("{}: this trial is of {:.12}…, but {} is {:.12}…", file,
                             trial.header.case_id, opened.folder.string(), opened.id)};
  trial::Signals signals(trial.header, {});
  signals.add(trial.block());
  auto path = signals.path(kPathPoints);
  if (path.tip_m.empty())
    return Error{Errc::bad_input, file + ": the header does not say where the tip is"};
  return std::move(path.tip_m);
}

struct Written {
  std::size_t triangles = 0, path_points = 0;
  double surface = 0.0;
  std::vector<std::string> files;
};

core::Result<Written> write_files(const SlicerOptions& o, const cases::OpenedCase& opened,
                                  const fs::path& folder) {
  Written out;
  const auto& definition = opened.definition;
  const auto bone = TRY(read_bone(opened));
  out.surface = o.surface_given ? o.surface : half_opacity_value(definition.model.transfer);
  TRY(volume_io::write_nrrd(folder / "volume.nrrd", bone));
  const auto triangles = volume_io::write_bone_stl(folder / "bone.stl", bone, out.surface);
  if (!triangles) return Error{triangles.error().code, "--surface: " + triangles.error().what};
  out.triangles = *triangles;
  TRY(volume_io::write_tract_stl(folder / "channel.stl", definition.tract));
  const cases::PlannedLine line{definition.tract.entry_m, definition.tract.end_m()};
  TRY(core::write_json(folder / "plan.mrk.json", cases::line_markup(line, "plan")));
  out.files = {"volume.nrrd", "bone.stl", "channel.stl", "plan.mrk.json"};
  if (o.trial.empty()) return out;
  const auto tip_m = TRY(read_tip_path(o.trial, opened));
  out.path_points = tip_m.size();
  TRY(core::write_json(folder / "tip_path.mrk.json", cases::curve_markup(tip_m, "tip path")));
  out.files.push_back("tip_path.mrk.json");
  return out;
}

Outcome run_slicer(const SlicerOptions& o) {
  if (std::error_code ignored; fs::exists(o.out, ignored))
    return Error{Errc::conflict,
                 fmt::format("{}: exists already; remove it or choose another name", o.out)};
  const auto opened = TRY(cases::open_case(o.case_folder));
  auto folder = TRY(core::ScratchFolder::make(o.out));
  const auto written = TRY(write_files(o, opened, folder.path()));
  TRY(folder.keep_as(o.out));
  if (o.json) {
    std::puts(Json({{"folder", o.out},
                    {"files", written.files},
                    {"surface_value", written.surface},
                    {"triangles", written.triangles},
                    {"path_points", written.path_points}})
                  .dump(2)
                  .c_str());
    return 0;
  }
  fmt::print("{}: {}\nbone.stl: {} triangles at the CT value {:g}\n", o.out,
             fmt::join(written.files, ", "), written.triangles, written.surface);
  if (written.path_points > 0)
    fmt::print("tip_path.mrk.json: {} points, of equal stretches the one of the largest force\n",
               written.path_points);
  return 0;
}

}  // namespace

Command slicer_command() {
  return {"slicer",
          "Write a case as files for 3D Slicer: volume, bone and channel, plan, a trial's tip path",
          "tractus slicer --case l3-left-medial --trial 018f.ttrial --out l3-slicer",
          [](CLI::App& app) {
            auto options = std::make_shared<SlicerOptions>();
            app.add_option("--case", options->case_folder, "folder of the case")->required();
            app.add_option("--trial", options->trial,
                           "palpation trial of this case, whose tip path is written too");
            auto* surface = app.add_option(
                "--surface", options->surface,
                "CT value of the bone's surface (default: half opacity of the case's model)");
            app.add_option("--out", options->out, "new folder for the files")->required();
            app.add_flag("--json", options->json, "print the result as JSON");
            return [options, surface] {
              options->surface_given = surface->count() > 0;
              return run_slicer(*options);
            };
          }};
}

}  // namespace commands
}  // namespace tractus
