/// One attempt at one case.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "drilling/burr.hpp"
#include "station/devices/catalogue.hpp"
#include "station/loop/haptic_loop.hpp"
#include "station/loop/loop_thread.hpp"
#include "station/session/prepared_case.hpp"
#include "station/session/remote_supervisor.hpp"
#include "station/session/tip_way.hpp"

namespace tractus::loop {
class Drilling;
}

namespace tractus::session {

enum class Speed {
  real,  ///< the monotonic clock
  fast,  ///< a manual clock, as fast as it goes: simulated devices alone, and the trial says so
};

struct TrialSetup {
  std::string device = "sim-lambda6";
  std::filesystem::path sdk = {};  ///< of a device that needs its vendor's library
  std::uint64_t seed = 1;
  double duration_s = 30.0;
  Speed speed = Speed::real;
  double rate_Hz = 4000.0;
  loop::Passivity passivity = loop::Passivity::observed;
  std::optional<drilling::Burr> burr = {};  ///< the tool; none: a probe
  /// Of an assigned trial: what its file calls the case and the trainee instead.
  std::string case_known_as = {};
  std::string operator_name = {};
  RemoteSupervisor* outside = nullptr;  ///< who may stop it from afar; outlives the trial
  std::optional<std::int64_t> started_utc_us = {};  ///< fast alone: a SIMULATED date; else now
};

/// What a trial came to.
struct TrialReport {
  std::string trial_id;
  std::filesystem::path file;
  bool complete = false;
  std::string fault;  ///< one line; empty when there was none
  double duration_s = 0.0;
  trial::TickCounts counts;
  std::uint64_t lost = 0;  ///< samples that were not recorded
  double wake_p50_us = 0.0, wake_p99_us = 0.0, work_p50_us = 0.0, work_p99_us = 0.0;
  double injected_J = 0.0;  ///< energy that the hand was given beyond what it gave (safety/energy)
  loop::RealtimeGrant grant;
  std::optional<trial::Answer> answer;
  bool simulated = false;
  core::Json headset = {};  ///< figures of a headset's view; null without one
  /// Of a probing trial.
  struct Bus {
    int restarts = 0;                   ///< after stops by the machine's own watchdog
    double p50_us = 0.0, p99_us = 0.0;  ///< round trip
  };
  std::optional<Bus> bus = std::nullopt;
  /// Of a trial with a burr.
  struct Drilled {
    core::Json detail;                        ///< of the trial's "drilled" event
    double lag_p50_s = 0.0, lag_p99_s = 0.0;  ///< from a pose to the tick that felt its work
  };
  std::optional<Drilled> drilled = std::nullopt;

  core::Json to_json() const;
};

/// What is told while a trial runs.
struct TrialSnapshot {
  const std::string& trial_id;
  loop::Live live;
  double progress = 0.0;               ///< 0 … 1
  std::uint64_t samples_safe = 0;      ///< on the disk for good
  const TipWay& way;                   ///< lives as the trial
  loop::Drilling* drilling = nullptr;  ///< of a trial with a burr: for `show`; lives as the trial
};
/// Called from the thread that called `run`, about thirty times a second; false stops the trial.
using Watch = std::function<bool(const TrialSnapshot&)>;

class TrialRun {
 public:
  /// Makes and opens the device, checks the disk, makes the trial file. `prepared` and `folder`
  /// must outlive this. Errors: not_found (no such device), bad_input, io, the device's, and the
  /// drilling's.
  static core::Result<std::unique_ptr<TrialRun>> make(const StationFolder& folder,
                                                      const PreparedCase& prepared,
                                                      const TrialSetup& setup);
  ~TrialRun();

  /// The loop in a thread of its own until the hand is done, the time is up, a fault, or `watch`
  /// says so. Errors: io of the recorder. A fault of the loop is no Error: `faulted`.
  core::Result<void> run(const Watch& watch = {});
  bool faulted() const;
  /// What the simulated trainee answers; nothing for a device that a person holds.
  std::optional<trial::Answer> simulated_answer() const;
  /// After `run`: an event of the trial's file that no other call writes.
  core::Result<void> note(const std::string& kind, const core::Json& detail);
  /// Writes the answer (if any) and the end, seals the file and queues it for upload.
  core::Result<TrialReport> finish(const std::optional<trial::Answer>& answer);
  /// Readable from any thread at any time, without a lock.
  const loop::LiveState& live() const;

 private:
  struct Parts;
  explicit TrialRun(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace tractus::session
