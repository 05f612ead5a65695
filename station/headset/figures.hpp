/// What a trial's report says of the headset.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/json.hpp"

namespace tractus::headset {

/// Frames as they were made, and the times they took.
class FrameTimes {
 public:
  void add(double work_s) { work_s_.push_back(static_cast<float>(work_s)); }
  std::size_t size() const { return work_s_.size(); }
  /// Smallest time that at least `share` of the frames did not exceed, ms; 0 without frames.
  double quantile_ms(double share) const;

 private:
  std::vector<float> work_s_;  // an hour at 90 Hz is 1.3 MB
};

/// Frames that were due and not made, from the moments at which frames were to be seen.
class DueFrames {
 public:
  /// @param shown_at_ns, period_ns  of a frame, as the runtime predicts them
  void add(std::int64_t shown_at_ns, std::int64_t period_ns);
  /// The next frame follows a pause (the session was not running): nothing is missed in it.
  void pause() { last_ns_ = 0; }
  std::uint64_t missed() const { return missed_; }

 private:
  std::int64_t last_ns_ = 0;
  std::uint64_t missed_ = 0;
};

struct Figures {
  std::string runtime, device;        ///< as they call themselves
  bool simulated = false;             ///< no headset behind the runtime
  bool aligned = false;               ///< the scene stood where the hand is (alignment.json)
  std::uint64_t frames = 0;           ///< drawn for both eyes and handed over
  std::uint64_t dropped = 0;          ///< due and not made
  std::uint64_t untracked = 0;        ///< of `frames`: without tracking, words alone
  double rate_Hz = 0.0;               ///< the runtime's pace
  double p50_ms = 0.0, p99_ms = 0.0;  ///< from the runtime's go to the hand-over
  double gpu_p50_ms = 0.0, gpu_p99_ms = 0.0;  ///< of the GPU alone; 0: not measured
  std::string ended;  ///< why the view ended before the trial; empty: it did not

  core::Json to_json() const;
};

}  // namespace tractus::headset
