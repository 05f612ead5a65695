/// `tractus drill`: drills a recorded trial again, and holds what was made against the plan.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "app/command.hpp"
#include "app/drill_forces.hpp"
#include "cases/case.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "drilling/channel.hpp"
#include "metrics/breach_class.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace commands {
namespace {

using core::Errc;
using core::Error;
using core::Json;

constexpr double kSame_N = 1e-6;

struct DrillOptions {
  std::string trial, volume, case_folder, out;
  bool json = false;
};

/// A bone to drill, with the case it is of where that is known.
struct Bone {
  volume::Volume volume;
  std::optional<cases::OpenedCase> opened;
};

core::Result<Bone> bone_of(const DrillOptions& o) {
  if (o.volume.empty() == o.case_folder.empty())
    return Error{Errc::bad_input, "drill: either --volume FILE or --case FOLDER is expected"};
  Bone bone;
  if (!o.case_folder.empty()) {
    auto opened = TRY(cases::open_case(o.case_folder));
    bone.opened = std::move(opened);
  }
  const std::filesystem::path path =
      bone.opened ? bone.opened->folder / cases::kVolumePart : std::filesystem::path(o.volume);
  const auto file = TRY(volume::VolumeFile::open(path));
  auto volume = TRY(file.read_all(core::terminal_progress("reading")));
  bone.volume = std::move(volume);
  return bone;
}

/// Forces can be had again where the case's own model ran, without effects.
core::Result<std::unique_ptr<DrillForces>> forces_of(const DrillOptions& o, const Bone& bone) {
  if (!bone.opened || !bone.opened->definition.model.effects.empty())
    return std::unique_ptr<DrillForces>();
  const auto trial = TRY(trial::scan_trial(o.trial, [](const trial::Block&) {}));
  const auto setup = drilling::Setup::of(trial.header);
  if (!setup) return Error{setup.error().code, o.trial + ": " + setup.error().what};
  models::PalpationModel model = bone.opened->definition.model;
  model.base.radius_m = setup->burr.shank_radius_m;
  return DrillForces::make(bone.volume, model);
}

Json json_of(const drilling::Redrilled& again, const DrillForces* forces) {
  Json out = {{"trial_id", again.header.id}, {"simulated", again.header.simulated}};
  out.update(drilling::drilled_of(again.erosion).to_json());
  const auto agrees = again.agrees();
  out["agrees"] = agrees ? Json(*agrees) : Json();
  out["forces"] = Json();
  if (forces)
    out["forces"] = {{"compared", forces->compared()},
                     {"largest_difference_N", forces->largest_N()},
                     {"in_order", forces->in_order()}};
  return out;
}

void print_replay(const Json& told) {
  fmt::print("{:.2f} mm3 of bone drilled in {} changes{}\n",
             told.at("removed_m3").get<double>() * 1e9, told.at("changes").get<int>(),
             told.at("simulated").get<bool>() ? "  (SIMULATED hand)" : "");
  const Json &agrees = told.at("agrees"), &forces = told.at("forces");
  fmt::print("the voxels are {}\n",
             agrees.is_null()
                 ? "not compared: the trial was cut short and has no hash of its voxels"
             : agrees.get<bool>()
                 ? "the same as in the trial, by their hash"
                 : "NOT the same as in the trial: another volume, or another build of the program");
  if (!forces.is_null())
    fmt::print("{} forces computed again, largest difference {:.1e} N{}\n",
               forces.at("compared").get<std::uint64_t>(),
               forces.at("largest_difference_N").get<double>(),
               forces.at("in_order").get<bool>() ? "" : "; a force changed BEFORE its cause");
}

Outcome replay(const DrillOptions& o) {
  const auto bone = TRY(bone_of(o));
  const auto made = TRY(forces_of(o, bone));
  DrillForces* const forces = made.get();
  const auto again = TRY(drilling::redrill(
      o.trial, bone.volume,
      [forces](const trial::Sample& sample) {
        if (forces) forces->feel(sample);
      },
      [forces](const drilling::Change& change, const volume::Volume& drilled) {
        if (forces) forces->follow(change, drilled);
      }));
  if (!o.out.empty()) {
    TRY(volume::write_volume(o.out, again.erosion.volume(),
                             {"trial " + again.header.id, "drilled again"},
                             core::terminal_progress("writing")));
  }
  const Json told = json_of(again, forces);
  o.json ? void(std::puts(told.dump(2).c_str())) : print_replay(told);
  const bool felt = !forces || (forces->in_order() && forces->largest_N() <= kSame_N);
  return again.agrees().value_or(true) && felt ? 0 : 1;
}

void print_channel(const drilling::PilotHole& made, const volume::Tract& tract) {
  if (!made.depth_m) {
    fmt::print("no voxel lost half of its bone: there is no channel\n");
    return;
  }
  if (made.angle_rad)
    fmt::print("entry {:.1f} mm {} and {:.1f} mm {} of the plan, turned by {:.1f} degrees\n",
               std::abs(made.entry_offset_m->x()) * 1e3,
               made.entry_offset_m->x() >= 0.0 ? "medial" : "lateral",
               std::abs(made.entry_offset_m->y()) * 1e3,
               made.entry_offset_m->y() >= 0.0 ? "superior" : "inferior",
               *made.angle_rad * 180.0 / std::numbers::pi);
  else
    fmt::print("the channel is too short to have a direction\n");
  fmt::print("deepest at {:.1f} mm; the plan ends at {:.1f} mm\n", *made.depth_m * 1e3,
             tract.length_m * 1e3);
  for (const volume::Wall wall : volume::kWalls) {
    const auto beyond = made.beyond_m[std::size_t(wall)];
    if (!beyond)
      fmt::print("{:>9}: the channel does not reach the part where this wall is known\n",
                 volume::name(wall));
    else if (*beyond > 0.0)
      fmt::print("{:>9}: BREACHED, {:.1f} mm beyond the bone\n", volume::name(wall), *beyond * 1e3);
    else
      fmt::print("{:>9}: within the bone, {:.1f} mm to its outer face\n", volume::name(wall),
                 -*beyond * 1e3);
  }
  if (made.worst)
    fmt::print("Gertzbein-Robbins class {}: farthest {:+.1f} mm beyond the cortex, at {:.0f} mm\n",
               name(metrics::breach_class_of(made.worst->beyond_m)), made.worst->beyond_m * 1e3,
               made.worst->depth_m * 1e3);
}

Outcome report(const DrillOptions& o) {
  const auto bone = TRY(bone_of(o));
  if (!bone.opened)
    return Error{Errc::bad_input,
                 "drill report: --case FOLDER is expected, because the case contains the plan"};
  const auto again = TRY(drilling::redrill(o.trial, bone.volume));
  const cases::Case& definition = bone.opened->definition;
  const drilling::PilotHole made =
      drilling::channel_of(again.erosion, definition.model.transfer, definition.tract);
  Json told = json_of(again, nullptr);
  told["channel"] = made.to_json();
  if (o.json)
    std::puts(told.dump(2).c_str());
  else
    print_replay(told), print_channel(made, definition.tract);
  return again.agrees().value_or(true) ? 0 : 1;
}

void add_options(CLI::App& app, DrillOptions& o) {
  app.add_option("trial", o.trial, "file of a trial with a burr, .ttrial")->required();
  app.add_option("--case", o.case_folder, "folder of the case that was drilled");
  app.add_option("--volume", o.volume, "volume of the case, .tvol, in place of --case");
  app.add_flag("--json", o.json, "print the result as JSON, in SI units");
}

}  // namespace

Command drill_command() {
  return {
      "drill",
      "Replay a recorded drilling: check its voxels and forces, or compare the drilled channel "
      "with the plan",
      "tractus drill replay st/trials/ID.ttrial --case undrilled/ --out drilled.tvol\n"
      "  tractus drill report st/trials/ID.ttrial --case undrilled/",
      [](CLI::App& app) {
        auto options = std::make_shared<DrillOptions>();
        CLI::App* again = app.add_subcommand("replay",
                                             "compute the drilled volume from the trial's samples "
                                             "and compare it with the hash in the trial file");
        add_options(*again, *options);
        again->add_option("--out", options->out, "file for the drilled volume, .tvol");
        CLI::App* held = app.add_subcommand("report",
                                            "compare entry, direction and depth with the plan, and "
                                            "show where the channel leaves the bone");
        add_options(*held, *options);
        app.require_subcommand(1);
        return [options, again] { return again->parsed() ? replay(*options) : report(*options); };
      }};
}

}  // namespace commands
}  // namespace tractus
