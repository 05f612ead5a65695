/// `tractus assemble`: recordings of a measuring room become a measurement set.
#include "capture/assemble.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <numbers>

#include "app/command.hpp"
#include "app/taps_picture.hpp"
#include "core/file.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"

namespace tractus {
namespace commands {
namespace {
using core::Errc;
using core::Error;
using core::Json;

struct AssembleOptions {
  std::string recipe, out, picture;
  bool json = false;
};

Json json_of(const capture::Assembled& one) {
  Json taps = Json::array();
  for (const auto& run : one.clock.runs)
    taps.push_back({{"taps_s", run.taps_s},
                    {"offset_s", run.offset_s},
                    {"sd_s", run.sd_s},
                    {"together", run.together}});
  return {
      {"id", one.trial.id},
      {"samples", one.trial.t_s.size()},
      {"rate_Hz", one.rate_Hz},
      {"duration_s", one.trial.t_s.back()},
      {"clock_offset_s", one.clock.offset_s},
      {"clock_offset_sd_s", one.clock.sd_s},
      {"clock_offset_at_s", one.clock.at_s},
      {"clock_drift", one.clock.drift},
      {"tap_runs", taps},
      {"zero_force_N", {one.zero_S.force_N.x(), one.zero_S.force_N.y(), one.zero_S.force_N.z()}},
      {"unseen", one.unseen},
      {"tap_force_off_way_rad", one.push_off_rad ? Json(*one.push_off_rad) : Json()}};
}

/// Nothing where no taps tell it.
std::string warning_of(const capture::Assembled& one) {
  constexpr double kRight_rad = 1.0;
  if (!one.push_off_rad || *one.push_off_rad < kRight_rad) return "";
  return fmt::format(
      "warning: {}: in the taps the direction of the force differs by {:.0f}° from the direction "
      "out of the surface: {}\n",
      one.trial.id, *one.push_off_rad * 180.0 / std::numbers::pi,
      *one.push_off_rad > std::numbers::pi - kRight_rad
          ? "does the sensor report the opposite force (\"says\")?"
          : "is the pose of the sensor (X_HS) correct?");
}

std::string line_of(const capture::Assembled& one) {
  std::string out =
      fmt::format("{}: {} samples at {:.4g} Hz, {:.1f} s; clocks {:+.4f} s apart", one.trial.id,
                  one.trial.t_s.size(), one.rate_Hz, one.trial.t_s.back(), one.clock.offset_s);
  if (one.clock.runs.empty())
    out += " (stated)";
  else
    out += fmt::format(" (± {:.2g} ms, from {} run{} of taps)", 1e3 * one.clock.sd_s,
                       one.clock.runs.size(), one.clock.runs.size() == 1 ? "" : "s");
  if (one.clock.drift != 0.0) out += fmt::format(", drift {:+.0f} ppm", 1e6 * one.clock.drift);
  if (one.unseen > 0.001)
    out += fmt::format("; a body was not tracked for {:.1f} % of the time", 100.0 * one.unseen);
  return out;
}

/// The set with the volume that its recipe names, whole or not at all.
core::Result<void> write_whole(const std::filesystem::path& target, trial::PalpationSet& set,
                               const capture::Recipe& recipe) {
  namespace fs = std::filesystem;
  if (recipe.volume.empty()) return trial::write_palpation_set(target, set);
  const fs::path from = (recipe.folder / recipe.volume).lexically_normal();
  set.volume = from.has_filename() ? from.filename().string() : "volume";
  auto scratch = TRY(core::ScratchFolder::make(target));
  const fs::path inner = scratch.path() / "set";
  TRY(trial::write_palpation_set(inner, set));
  std::error_code failure;
  fs::copy(from, inner / set.volume, fs::copy_options::recursive, failure);
  if (failure)
    return Error{Errc::io, fmt::format("{}: cannot be copied into the set: {}", from.string(),
                                       failure.message())};
  fs::rename(inner, target, failure);
  if (failure) return Error{Errc::io, fmt::format("{}: {}", target.string(), failure.message())};
  return core::sync_folder(target.has_parent_path() ? target.parent_path() : fs::path("."));
}

/// Refuses what could not be written at the end, before the work.
core::Result<void> check(const AssembleOptions& options, const std::filesystem::path& target) {
  if (std::filesystem::exists(target))
    return Error{Errc::conflict, fmt::format("{}: exists already", options.out)};
  if (!options.picture.empty()) return core::may_be_written(options.picture);
  return {};
}

Outcome run_assemble(const AssembleOptions& options) {
  std::filesystem::path target = options.out;
  if (!target.has_filename()) target = target.parent_path();  // a folder's name may end in a slash
  TRY(check(options, target));
  const auto recipe = TRY(capture::Recipe::read(options.recipe));
  if (!std::filesystem::exists(recipe.folder / recipe.volume))
    return Error{Errc::not_found, fmt::format("{}: /volume: the file '{}' does not exist",
                                              options.recipe, recipe.volume)};
  trial::PalpationSet set;
  set.stated = recipe.stated;

  const auto shown = core::terminal_progress("Assembling");
  Json trials = Json::array();
  std::string lines, warnings;
  std::vector<app::ShownTaps> shown_taps;
  for (std::size_t k = 0; k < recipe.recordings.size(); ++k) {
    if (!shown(double(k) / double(recipe.recordings.size())))
      return Error{Errc::cancelled, "stopped; nothing was written"};
    auto one = TRY(capture::assemble(recipe, recipe.recordings[k]));
    trials.push_back(json_of(one));
    lines += line_of(one) + "\n";
    warnings += warning_of(one);
    shown_taps.push_back({one.trial.id, one.clock, std::move(one.taps)});
    set.trials.push_back(std::move(one.trial));
  }
  TRY(write_whole(target, set, recipe));
  if (!options.picture.empty()) {
    const std::string drawn = plot::svg(app::taps_figure(shown_taps));
    TRY(core::write_file(options.picture, core::bytes_of(drawn)));
  }
  std::fputs(warnings.c_str(), stderr);
  if (options.json)
    fmt::print("{}\n", Json{{"set", options.out}, {"trials", trials}}.dump(2));
  else
    fmt::print("{}", lines);
  return 0;
}
}  // namespace

Command assemble_command() {
  return {
      .name = "assemble",
      .summary = "Make a measurement set from motion capture and force recordings",
      .example =
          "tractus assemble --recipe room/assembly.json --out recordings/ --picture taps.svg",
      .make = [](CLI::App& app) -> std::function<Outcome()> {
        auto options = std::make_shared<AssembleOptions>();
        app.add_option(
               "--recipe", options->recipe,
               "recipe in the format tractus-assembly/1: the role of each file, body and sensor")
            ->required();
        app.add_option("--out", options->out, "folder of the measurement set; it must not exist")
            ->required();
        app.add_option(
            "--picture", options->picture,
            "SVG file with the taps in force and motion on a common clock, for visual inspection");
        app.add_flag("--json", options->json, "print one JSON document on standard output");
        return [options] { return run_assemble(*options); };
      }};
}

}  // namespace commands
}  // namespace tractus
