/// What a station says of itself while it works, and what it is told: text frames of
/// GET /api/v1/live/station, and the reports it hands over. Never what a trial's case holds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "trial/trial.hpp"

namespace tractus::wire {

/// The trial that runs, as its loop last left it.
struct LiveTrial {
  std::string trial_id;
  trial::Rig rig = trial::Rig::palpation;
  std::string case_id;  ///< what the station knows the case by: its id, or the slot's when blind
  double t_s = 0.0;
  std::uint64_t samples = 0;
  std::optional<double> force_N;  ///< on the hand; none while blind
  std::optional<double> depth_m;  ///< of the tip; none while blind
  std::uint64_t late_ticks = 0;
};

/// The last self-test in short.
struct SelfTestSummary {
  std::int64_t at_utc_us = 0;
  bool passed = false;
  std::vector<std::string> failed;  ///< names of checks

  core::Json to_json() const;
  static core::Result<SelfTestSummary> from_json(const core::Json& json, const std::string& where);
};

enum class StationState {
  away,  ///< the server's word for a station that is not connected
  idle,
  preparing,
  trial,
  questions,
  stopped,
  fault,
};
constexpr auto words(StationState) {
  using enum StationState;
  return std::to_array<core::Word<StationState>>({{away, "away"},
                                                  {idle, "idle"},
                                                  {preparing, "preparing"},
                                                  {trial, "trial"},
                                                  {questions, "questions"},
                                                  {stopped, "stopped"},
                                                  {fault, "fault"}});
}

/// {"kind":"state",…}: the whole of it, each time.
struct StationStatus {
  StationState state = StationState::idle;  ///< not away
  std::string version, device;
  std::optional<bool> simulated;
  std::optional<LiveTrial> trial;
  std::optional<double> clock_offset_s;  ///< server's clock less the station's
  std::optional<double> clock_error_s;   ///< half the round trip it was measured by: its bound
  std::optional<std::uint64_t> free_disk_bytes;
  std::optional<double> late_share;  ///< of the ticks of this run's trials
  std::optional<std::uint64_t> waiting_trials;
  std::optional<std::int64_t> calibration_due_utc_us;
  std::optional<SelfTestSummary> self_test;

  core::Json to_json() const;
  /// Errors: bad_input naming the field; numbers are finite and within sense, texts short.
  static core::Result<StationStatus> from_json(const core::Json& json, const std::string& where);
};
/// What a station is told: to stop, or to give its hands less.
struct StationCommand {
  enum class Kind { stop, limits };
  Kind kind = Kind::stop;
  std::string reason;    ///< of a stop
  double force_N = 0.0;  ///< of limits: at most so much, if the station's own limit is above it

  core::Json to_json() const;
  static core::Result<StationCommand> from_json(const core::Json& json, const std::string& where);
};

constexpr auto words(StationCommand::Kind) {
  using enum StationCommand::Kind;
  return std::to_array<core::Word<StationCommand::Kind>>({{stop, "stop"}, {limits, "limits"}});
}

/// POST /api/v1/station/report: what a self-test or a calibration at the station came to.
struct StationReport {
  struct Check {
    std::string name;
    bool passed = false;
    std::optional<double> value, limit;
    std::string unit, words;
  };
  struct SelfTest {
    std::int64_t at_utc_us = 0;
    bool passed = false;
    std::vector<Check> checks;

    core::Json to_json() const;
    SelfTestSummary summary() const;
  };
  struct Calibration {
    std::int64_t at_utc_us = 0;
    std::optional<std::int64_t> due_utc_us;
    std::string kind, words;

    core::Json to_json() const;
  };
  std::optional<SelfTest> self_test;
  std::optional<Calibration> calibration;
  std::vector<std::string> refused;  ///< cases that the station would not take, one line each
  std::string version;
  std::optional<std::uint64_t> free_disk_bytes;

  core::Json to_json() const;
  static core::Result<StationReport> from_json(const core::Json& json, const std::string& where);
};

}  // namespace tractus::wire
