/// `tractus replay`: recorded palpations and probings through a model.
#include "replay/replay.hpp"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <memory>

#include "app/command.hpp"
#include "app/probing_replay.hpp"
#include "core/file.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"
#include "lab/io/unpacked.hpp"
#include "replay/pictures.hpp"
#include "replay/table.hpp"
#include "trial/probing_set.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace commands {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Json;
using core::Result;

using Options = ReplayOptions;

/// All that was read and computed, before anything is written.
struct ReplayWork {
  models::PalpationModel model;
  trial::PalpationSet set;
  fs::path volume;
  std::vector<replay::Replayed> replayed;  ///< by trial
  std::vector<replay::Row> rows;
  double seconds = 0.0;  ///< spent stepping the model
};

/// A bar over several pieces of work, each with its share.
core::Progress part_of(const core::Progress& whole, double from, double width) {
  return [=](double share) { return whole(from + width * share); };
}

/// The model's volume lies beside the model, else the set names it.
Result<fs::path> volume_path(const Options& options, const ReplayWork& work) {
  if (!work.model.volume.empty()) return options.model.parent_path() / work.model.volume;
  if (!work.set.volume.empty()) return work.set.folder / work.set.volume;
  return Error{Errc::bad_input, fmt::format("{}: names no \"volume\", and neither does {}/set.json",
                                            options.model.string(), options.measurements.string())};
}

Result<models::PalpationRuntime> make_runtime(const ReplayWork& work) {
  auto imported =
      TRY(volume_io::read_volume(work.volume, core::terminal_progress("reading the volume")));
  return models::PalpationRuntime::make(work.model, imported.volume,
                                        core::terminal_progress("making the field"));
}

void add_rows(ReplayWork& work) {
  struct Pooled {
    std::vector<math::Wrench> measured, simulated;
  };
  Pooled all;
  std::map<std::string, Pooled> operators;
  std::vector<replay::Row> trials;
  const auto add = [](std::vector<math::Wrench>& to, const std::vector<math::Wrench>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (std::size_t k = 0; k < work.set.trials.size(); ++k) {
    const auto& recording = work.set.trials[k];
    for (Pooled* pooled : {&all, &operators[recording.operator_name]}) {
      add(pooled->measured, recording.wrench_H);
      add(pooled->simulated, work.replayed[k].wrench_H);
    }
    trials.push_back(replay::row("trial", recording.id, "measured", recording.wrench_H));
    trials.push_back(replay::row("trial", recording.id, "simulated", work.replayed[k].wrench_H));
  }
  const auto both = [&](const std::string& scope, const std::string& name, const Pooled& pooled) {
    work.rows.push_back(replay::row(scope, name, "measured", pooled.measured));
    work.rows.push_back(replay::row(scope, name, "simulated", pooled.simulated));
  };
  both("all", "", all);
  for (const auto& [name, pooled] : operators)
    if (!name.empty()) both("operator", name, pooled);
  work.rows.insert(work.rows.end(), trials.begin(), trials.end());
}

Result<ReplayWork> compute(models::PalpationModel model, const fs::path& folder,
                           const Options& options) {
  ReplayWork work;
  auto set = TRY(trial::read_palpation_set(folder));
  work.model = std::move(model);
  work.set = std::move(set);
  const auto down = trial::stated_down(work.set);
  if (!down) return Error{down.error().code, (folder / down.error().what).string()};
  auto volume = TRY(volume_path(options, work));
  work.volume = volume;
  auto runtime = TRY(make_runtime(work));
  const auto bar = core::terminal_progress("replaying");
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t k = 0; k < work.set.trials.size(); ++k) {
    const double width = 1.0 / double(work.set.trials.size());
    auto replayed =
        replay::replay(runtime, work.set.trials[k], *down, part_of(bar, width * double(k), width));
    if (!replayed) return Error{replayed.error().code, (folder / replayed.error().what).string()};
    work.replayed.push_back(std::move(*replayed));
  }
  work.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  bar(1.0);
  add_rows(work);
  return work;
}

std::string csv_of(const trial::PalpationMeasurement& recording, const replay::Replayed& replayed) {
  std::string out = fmt::format("{},deflection_x_m,deflection_y_m,converged\n",
                                fmt::join(trial::kPalpationColumns, ","));
  for (std::size_t k = 0; k < recording.t_s.size(); ++k)
    out += fmt::format(
        "{},{},{},{}\n",
        trial::palpation_row(recording.t_s[k], recording.X_VH[k], replayed.wrench_H[k]),
        replayed.deflection_m[k].x(), replayed.deflection_m[k].y(), int(replayed.converged[k]));
  return out;
}

/// Does the set say that what it calls measured was itself simulated?
bool is_simulated(const trial::PalpationSet& set) {
  const auto it = set.stated.find("simulated");
  return it != set.stated.end() && it->is_boolean() && it->get<bool>();
}

Json summary_of(const ReplayWork& work) {
  Json json{{"format", "tractus-replay/1"},
            {"model", work.model.name},
            {"volume", work.volume.filename().string()}};
  json["measurements_are_simulated"] = is_simulated(work.set);
  std::uint64_t steps = 0, not_converged = 0;
  for (std::size_t k = 0; k < work.set.trials.size(); ++k) {
    const auto& replayed = work.replayed[k];
    steps += replayed.steps;
    not_converged += replayed.not_converged;
    json["trials"].push_back(
        {{"id", work.set.trials[k].id},
         {"operator", work.set.trials[k].operator_name},
         {"samples", replayed.wrench_H.size()},
         {"samples_in_volume", replayed.samples_in_volume},
         {"duration_s", work.set.trials[k].t_s.back() - work.set.trials[k].t_s.front()},
         {"steps", replayed.steps},
         {"steps_not_converged", replayed.not_converged}});
  }
  json["rate_Hz"] = models::kPalpationRate_Hz;
  json["steps"] = steps;
  json["steps_not_converged"] = not_converged;
  for (const auto& row : work.rows) json["table"].push_back(replay::to_json(row));
  return json;
}

Result<void> create_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directory(folder, failure);
  if (!failure) return {};
  return Error{Errc::io, fmt::format("{}: cannot create: {}", folder.string(), failure.message())};
}

Result<void> write_motion(const ReplayWork& work, const fs::path& folder) {
  TRY(create_folder(folder));
  const auto down = TRY(trial::stated_down(work.set));
  for (const auto& recording : work.set.trials) {
    const auto motion = TRY(models::PalpationMotion::through(recording.t_s, recording.X_VH, down));
    TRY(core::write_file(folder / (recording.id + ".csv"),
                         core::bytes_of(replay::motion_csv(motion))));
  }
  return {};
}

Result<void> write_trials(const ReplayWork& work, const fs::path& folder) {
  TRY(create_folder(folder));
  const replay::ProbePlace probe{work.model.base.length_m, work.model.base.pose_offset_m};
  for (std::size_t k = 0; k < work.set.trials.size(); ++k) {
    const auto& recording = work.set.trials[k];
    auto figure = replay::trial_figure(recording, work.replayed[k], work.set.tract, probe);
    if (is_simulated(work.set)) figure.note += std::string(" ") + kSimulatedNote;
    for (const auto& [suffix, text] : {std::pair{".csv", csv_of(recording, work.replayed[k])},
                                       std::pair{".svg", plot::svg(figure)}})
      TRY(core::write_file(folder / (recording.id + suffix), core::bytes_of(text)));
  }
  return {};
}

Result<void> write(const ReplayWork& work, const Options& options) {
  auto scratch = TRY(core::ScratchFolder::make(options.out));
  TRY(write_trials(work, scratch.path() / "trials"));
  TRY(write_motion(work, scratch.path() / "motion"));
  std::vector<math::Wrench> measured, simulated;
  for (std::size_t k = 0; k < work.set.trials.size(); ++k) {
    const auto& m = work.set.trials[k].wrench_H;
    const auto& s = work.replayed[k].wrench_H;
    measured.insert(measured.end(), m.begin(), m.end());
    simulated.insert(simulated.end(), s.begin(), s.end());
  }
  auto figure = replay::distribution_figure(measured, simulated);
  if (is_simulated(work.set)) figure.note = kSimulatedNote;
  const auto distributions = plot::svg(figure);
  for (const auto& [name, text] : {std::pair{"distributions.svg", distributions},
                                   std::pair{"table.csv", replay::csv(work.rows)}})
    TRY(core::write_file(scratch.path() / name, core::bytes_of(text)));
  TRY(core::write_json(scratch.path() / "summary.json", summary_of(work)));
  return scratch.keep_as(options.out);
}

void say(const ReplayWork& work, const Options& options) {
  Json summary = summary_of(work);
  const double steps = summary["steps"].get<double>(),
               missed = summary["steps_not_converged"].get<double>();
  if (options.json) {
    summary["microseconds_per_step"] = 1e6 * work.seconds / steps;
    fmt::print("{}\n", summary.dump(2));
    return;
  }
  fmt::print("{}", replay::printed(work.rows));
  fmt::print(
      "{:.0f} steps at {:.0f} Hz, {:.2f} µs each; {:.0f} ({:.2g} %) did not reach the "
      "equilibrium.\n",
      steps, models::kPalpationRate_Hz, 1e6 * work.seconds / steps, missed, 100.0 * missed / steps);
  for (std::size_t k = 0; k < work.replayed.size(); ++k)
    if (work.replayed[k].samples_in_volume == 0)
      fmt::print(
          "Trial {}: the tip never enters the volume; are both in the same frame, in metres?\n",
          work.set.trials[k].id);
  if (is_simulated(work.set)) fmt::print("{}\n", kSimulatedNote);
  fmt::print("Written to {}\n", options.out.string());
}

Outcome run_replay(const Options& options) {
  std::error_code ignored;
  if (fs::exists(options.out, ignored))
    return Error{Errc::conflict, fmt::format("{}: exists already; remove it or choose another name",
                                             options.out.string())};
  auto model = TRY(models::read_model(options.model));
  const auto unpacked = TRY(lab_io::Unpacked::open(options.measurements));
  const auto rig = TRY(trial::rig_of_set(unpacked.folder()));
  const auto* probing = std::get_if<models::ProbingModel>(&model);
  if ((rig == "probing") != (probing != nullptr))
    return Error{
        Errc::bad_input,
        fmt::format("{}: a model of the {} rig, but {} contains measurements of the {} rig",
                    options.model.string(), probing ? "probing" : "palpation",
                    options.measurements.string(), rig)};
  if (probing) return replay_probing(*probing, unpacked.folder(), options);
  auto work =
      TRY(compute(std::get<models::PalpationModel>(std::move(model)), unpacked.folder(), options));
  TRY(write(work, options));
  say(work, options);
  return 0;
}

}  // namespace

Command replay_command() {
  return {
      .name = "replay",
      .summary =
          "Replay recorded palpation or probing trials through a model: simulated forces, pictures "
          "and a table",
      .example = "tractus replay --model l3.model.json --measurements recordings/ --out replayed/",
      .make = [](CLI::App& app) -> std::function<Outcome()> {
        auto options = std::make_shared<Options>();
        app.add_option("--model", options->model, "model file in the format tractus-model/1")
            ->required();
        app.add_option("--measurements", options->measurements,
                       "measurement set in the format tractus-measurements/1: a folder with "
                       "set.json, or a zip of such a folder")
            ->required();
        app.add_option("--out", options->out, "folder for the results; it must not exist")
            ->required();
        app.add_flag("--json", options->json, "print the summary as JSON");
        return [options] { return run_replay(*options); };
      }};
}

}  // namespace commands
}  // namespace tractus
