#include "app/probing_replay.hpp"

#include <fmt/format.h>

#include "core/file.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"
#include "effects/probing_effect.hpp"
#include "replay/probing_replay.hpp"

namespace tractus {
namespace commands {
namespace {

namespace fs = std::filesystem;
using core::Json;
using core::Result;

struct Work {
  trial::ProbingSet set;
  std::vector<replay::ProbingReplayed> replayed;  ///< by trial
  std::vector<replay::ProbingRow> rows;
  bool simulated = false;  ///< the set says that its measurements are simulated themselves
};

Result<Work> compute(const models::ProbingModel& model, const fs::path& folder) {
  auto set = TRY(trial::read_probing_set(folder));
  Work work;
  work.set = std::move(set);
  const auto stated = work.set.stated.find("simulated");
  work.simulated = stated != work.set.stated.end() && stated->is_boolean() && stated->get<bool>();
  const auto bar = core::terminal_progress("replaying");
  for (const auto& recording : work.set.trials) {
    auto replayed =
        TRY(replay::replay(model, recording, work.set.noise, (folder / recording.file).string()));
    work.replayed.push_back(std::move(replayed));
    if (bar && !bar(double(work.replayed.size()) / double(work.set.trials.size())))
      return core::Error{core::Errc::cancelled, "stopped"};
  }
  work.rows = replay::rows(work.set.trials, work.replayed);
  return work;
}

/// What a reader of the figures must know of how they came about.
std::vector<std::string> notes(const Work& work, const models::ProbingModel& model) {
  std::vector<std::string> out;
  const auto lacks = [&](auto member) {
    return std::ranges::any_of(work.set.trials, [&](const auto& t) { return (t.*member).empty(); });
  };
  using Trial = trial::ProbingMeasurement;
  if (lacks(&Trial::x_m))
    out.emplace_back(
        "depth and push were not recorded in every trial: the torque is replayed there");
  else if (lacks(&Trial::theta_rad))
    out.emplace_back(
        "theta_rad was not recorded in every trial: driven by the recorded push, the stage turns "
        "all the time there");
  for (const auto& use : model.effects)
    if (const auto facts = effects::probing_facts(use); facts && facts->free_per_trial)
      out.push_back(fmt::format("{} is free in each trial and is left out of a replay", use.id));
  if (work.simulated) out.emplace_back(kSimulatedNote);
  return out;
}

Json summary_of(const Work& work, const models::ProbingModel& model) {
  Json json{{"format", "tractus-replay/1"}, {"rig", "probing"},
            {"model", model.name},          {"measurements_are_simulated", work.simulated},
            {"notes", notes(work, model)},  {"trials", Json::array()},
            {"table", Json::array()}};
  for (const auto& t : work.set.trials)
    json["trials"].push_back({{"id", t.id},
                              {"operator", t.operator_name},
                              {"samples", t.t_s.size()},
                              {"duration_s", t.t_s.back() - t.t_s.front()}});
  for (const auto& row : work.rows) json["table"].push_back(replay::to_json(row));
  return json;
}

Result<void> write(const Work& work, const models::ProbingModel& model, const fs::path& to) {
  auto scratch = TRY(core::ScratchFolder::make(to));
  const fs::path trials = scratch.path() / "trials", motion = scratch.path() / "motion";
  std::error_code failure;
  for (const fs::path& folder : {trials, motion})
    if (fs::create_directory(folder, failure); failure)
      return core::Error{core::Errc::io,
                         fmt::format("{}: cannot create: {}", folder.string(), failure.message())};
  for (std::size_t k = 0; k < work.set.trials.size(); ++k) {
    const auto& recording = work.set.trials[k];
    auto figure = replay::trial_figure(recording, work.replayed[k]);
    if (work.simulated) figure.note = kSimulatedNote;
    for (const auto& [suffix, text] : {std::pair{".csv", replay::csv(recording, work.replayed[k])},
                                       std::pair{".svg", plot::svg(figure)}})
      TRY(core::write_file(trials / (recording.id + suffix), core::bytes_of(text)));
    TRY(core::write_file(motion / (recording.id + ".csv"),
                         core::bytes_of(replay::motion_csv(work.replayed[k].motion))));
  }
  if (auto done =
          core::write_file(scratch.path() / "table.csv", core::bytes_of(replay::csv(work.rows)));
      !done)
    return done;
  TRY(core::write_json(scratch.path() / "summary.json", summary_of(work, model)));
  return scratch.keep_as(to);
}

}  // namespace

Outcome replay_probing(const models::ProbingModel& model, const fs::path& folder,
                       const ReplayOptions& options) {
  auto work = TRY(compute(model, folder));
  TRY(write(work, model, options.out));
  if (options.json) {
    fmt::print("{}\n", summary_of(work, model).dump(2));
    return 0;
  }
  fmt::print("{}", replay::printed(work.rows));
  for (const auto& row : work.rows)
    if (row.scope == "all" && row.channel == "x_m")
      fmt::print("Driven by the recorded push, the model is off in depth by {:.3g} mm (rms).\n",
                 1e3 * row.rmse);
  for (const std::string& note : notes(work, model)) fmt::print("- {}\n", note);
  fmt::print("Written to {}\n", options.out.string());
  return 0;
}

}  // namespace commands
}  // namespace tractus
