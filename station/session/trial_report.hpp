/// What a trial came to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "station/loop/realtime.hpp"
#include "trial/trial.hpp"

namespace tractus::session {

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

}  // namespace tractus::session
