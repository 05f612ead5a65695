/// One attempt at one probing scenario on the rig.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "effects/effect.hpp"
#include "laws/probing_law.hpp"
#include "models/probing_runtime.hpp"
#include "scenarios/scenario.hpp"
#include "station/session/station_folder.hpp"
#include "station/session/trial_run.hpp"

namespace tractus::session {

/// Where the rig is, and who is on it.
struct RigSetup {
  std::string device = "sim-rig";          ///< of the catalogue, a rig
  std::string address = "127.0.0.1:1502";  ///< of a machine: HOST:PORT, or "/dev/…[@BAUD]"
  std::filesystem::path program;           ///< of a simulated one; empty: beside this program
  std::uint64_t seed = 1;                  ///< of the simulated surgeon, the sensor and the answer
  double skill = 0.5;                      ///< of the simulated surgeon, 0 … 1
  bool surgeon = true;                     ///< a SIMULATED surgeon pushes; else nobody does
  Speed speed = Speed::real;  ///< fast: simulated alone, in this process, without the bus
  std::optional<std::int64_t> started_utc_us = {};  ///< fast alone: a SIMULATED date; else now
  double rate_Hz = 1000.0;                          ///< 100 … 1000
  double duration_s = 120.0;                        ///< at most so long
  RemoteSupervisor* outside = nullptr;  ///< who may stop it from afar; outlives the trial
};

/// What is probed. A value; holds no name of a scenario when the trial is blind.
struct ProbingTask {
  std::string case_id;          ///< the scenario's id, or the slot's of a blind study
  laws::ProbingParameters law;  ///< what a station needs of a scenario
  std::vector<effects::EffectInstance>
      effects;                ///< of a model that is felt instead of the scenario's bone
  std::string operator_name;  ///< a pseudonym; empty: the simulated surgeon's own name
  core::Json extra = core::Json::object();  ///< goes into the header's extra as it is
  /// Nothing that tells one scenario from another is written into the header or handed to `watch`.
  bool blind = false;
};

/// From a scenario; with a model, its bone and effects instead, behind the scenario's walls.
/// Errors: those of the scenario; out_of_range when the model does not fit the travel.
core::Result<ProbingTask> task_of(const scenarios::Scenario& scenario,
                                  const std::optional<models::ProbingModel>& model = {});
/// A model alone, without walls, over `travel_m`. `case_id` is the SHA-256 of its JSON.
core::Result<ProbingTask> task_of(const models::ProbingModel& model, double travel_m);

/// What is told while a trial runs. In a blind trial `mode` is always holding and `x_m`,
/// `speed_m_s` and `push_N` are 0: a screen has nothing to show.
struct ProbingTrialSnapshot {
  const std::string& trial_id;
  double t_s = 0.0;
  double x_m = 0.0, speed_m_s = 0.0, push_N = 0.0;
  trial::ProbingMode mode = trial::ProbingMode::holding;
  std::uint64_t missed = 0;        ///< periods so far
  std::uint64_t samples_safe = 0;  ///< on the disk for good
};
/// Called from the thread that called `run`, about thirty times a second; false ends the trial in
/// good order.
using ProbingWatch = std::function<bool(const ProbingTrialSnapshot&)>;

/// make → run → finish. Whatever happens in `run`, `finish` seals the file and queues it for the
/// upload, marked with the fault if there was one.
class ProbingTrialRun {
 public:
  /// Starts or finds the rig, checks the disk, brings the stage back to the entry if it is not
  /// there, makes the trial file. `folder` must outlive this. Errors: bad_input, out_of_range,
  /// unavailable (no rig there, e-stop, fault that does not clear, somebody pushes), io.
  static core::Result<std::unique_ptr<ProbingTrialRun>> make(const StationFolder& folder,
                                                             const ProbingTask& task,
                                                             const RigSetup& setup);
  ~ProbingTrialRun();

  /// The loop in a thread of its own until the probe has stood at its stop for half a second, the
  /// time is up, a fault, or `watch` says so. Errors: io of the recorder. A fault of the rig is no
  /// Error: `fault`.
  core::Result<void> run(const ProbingWatch& watch = {});
  /// One line; empty when there was none.
  const std::string& fault() const;
  /// What the simulated surgeon says it felt; nothing when a person was on the rig.
  std::optional<trial::Answer> simulated_answer() const;
  core::Result<TrialReport> finish(const std::optional<trial::Answer>& answer);

  /// Feels another law from the next tick on: an expert tunes. Same travel; effects stay. From the
  /// thread that calls `run`'s watch. Errors: those of making the law.
  /// @param what  what a reader of the trial is to know of it: the detail of a "retuned" event
  core::Result<void> retune(const laws::ProbingParameters& law, core::Json what);

 private:
  struct Parts;
  explicit ProbingTrialRun(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// make, run and finish in one: the answer is asked for by `ask` once the trial has ended without a
/// fault (the simulated surgeon's when `ask` is empty).
core::Result<TrialReport> run_probing_trial(
    const StationFolder& folder, const ProbingTask& task, const RigSetup& setup,
    const ProbingWatch& watch = {},
    const std::function<core::Result<std::optional<trial::Answer>>(const ProbingTrialRun&)>& ask =
        {});

}  // namespace tractus::session
