/// Live tuning by an expert: feel a scenario on the rig, nudge its eight parameters by keys, save a
/// new version.
#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/app/probing.hpp"
#include "station/app/terminal_keys.hpp"
#include "station/app/trial_epilogue.hpp"
#include "station/session/tuning.hpp"

namespace tractus {
namespace app {
namespace {
using session::Tuning;

constexpr const char* kKeys =
    "keys: 1-8 choose a parameter, + and - nudge it by 5 %, u takes back, s saves a new version, "
    "q ends the trial\n";

/// Keys into nudges, nudges into the running trial.
class Expert {
 public:
  Expert(const Options& options, scenarios::Scenario scenario)
      : options_(options), tuning_(std::move(scenario)) {}

  /// False: the trial is to end.
  bool press(char c, session::ProbingRig& rig) {
    if (c == 'q') return false;
    if (c >= '1' && c <= '8') chosen_ = std::size_t(c - '1');
    if (c == '+' || c == '-') take(tuning_.nudge(chosen_, c == '+' ? 1 : -1));
    if (c == 'u') tuning_.undo();
    if (c == 's') take(save());
    if (c == '+' || c == '-' || c == 'u')
      if (auto law = tuning_.now().expanded(); law) take(rig.retune(*law, tuning_.now().to_json()));
    if (c != '\n') show();
    return true;
  }
  void show() const {
    std::string line;
    for (std::size_t k = 0; k < Tuning::kParameters; ++k) {
      const char* symbol = Tuning::parameters()[k].symbol;
      const std::string shown = fmt::format("{} {:g}", symbol, tuning_.value(k));
      line += k == chosen_ ? "[" + shown + "] " : " " + shown + "  ";
    }
    std::fprintf(stderr, "%s%s\n", line.c_str(), tuning_.changed() ? "(changed)" : "");
  }
  const Tuning& tuning() const { return tuning_; }
  const core::Json& saved() const { return saved_; }

 private:
  void take(const core::Result<void>& outcome) const {
    if (!outcome) std::fprintf(stderr, "refused: %s\n", outcome.error().what.c_str());
  }
  core::Result<void> save() {
    auto made = TRY(tuning_.save(options_.who, core::utc_us()));
    const auto path = options_.tuned_folder / (made.id().substr(0, 12) + ".json");
    std::error_code ignored;
    std::filesystem::create_directories(options_.tuned_folder, ignored);
    TRY(core::write_json(path, made.to_json()));
    saved_.push_back(path.string());
    std::fprintf(stderr, "saved %s\n", path.c_str());
    return {};
  }
  const Options& options_;
  Tuning tuning_;
  std::size_t chosen_ = 0;
  core::Json saved_ = core::Json::array();
};

core::Result<session::TrialReport> one_trial(const Options& options,
                                             const session::StationFolder& folder, Expert& expert) {
  auto task = TRY(session::task_of(expert.tuning().now()));
  task.operator_name = options.who;
  auto trial = TRY(session::probing_trial(folder, task, options.rig));
  say_calibration_due(folder, options.rig.device);
  TRY(trial.runner->run([&](const session::TrialSnapshot&) {
    for (auto c = typed_key(); c; c = typed_key())
      if (!expert.press(*c, *trial.rig)) return false;
    return !asked_to_stop();
  }));
  return trial.runner->finish(std::nullopt);
}
}  // namespace

core::Result<int> tune_scenario(const Options& options) {
  auto scenario = TRY(scenario_named(options.scenario));
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = TRY(folder.lock());
  auto recovered = TRY(folder.recover());
  say_recovered(recovered);
  const RawTerminal terminal;
  Expert expert(options, std::move(scenario));
  std::fputs(kKeys, stderr);
  expert.show();
  bool faulted = false;
  core::Json trials = core::Json::array();
  for (int i = 0; i < options.trials && !asked_to_stop(); ++i) {
    auto report = TRY(one_trial(options, folder, expert));
    faulted = faulted || !report.complete;
    trials.push_back(report.to_json());
    if (!options.json) print_probing_report(report, options.rig.speed == session::Speed::fast);
  }
  if (options.json)
    fmt::print("{}\n", core::Json{{"trials", trials},
                                  {"saved", expert.saved()},
                                  {"scenario", expert.tuning().now().to_json()}}
                           .dump(2));
  return faulted ? 1 : 0;
}

}  // namespace app
}  // namespace tractus
