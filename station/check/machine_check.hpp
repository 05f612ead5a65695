/// The station's computer put to the question.
#pragma once

#include <filesystem>
#include <functional>

#include "station/check/findings.hpp"
#include "station/loop/realtime.hpp"

namespace tractus::check {

/// A thread of the loop's kind that wakes at `rate_Hz` for `for_s` seconds: the share of wake-ups
/// that came more than a quarter period late, and how late they came.
/// `progress` is called about thirty times a second by the calling thread; false ends it early.
Finding check_wake_ups(double rate_Hz, double for_s,
                       const std::function<bool(double share)>& progress = {});
/// Blocks of 4 KiB written and flushed as the recorder does: the time that 99 of 100 stay within;
/// and the room that is left. Leaves nothing. Errors: io.
core::Result<void> check_disk(const std::filesystem::path& folder, std::vector<Finding>& out);
/// Does the monotonic clock run forwards, and how fine is it?
Finding check_clock();

/// How far the server's clock is from ours, when it was asked.
struct Offset {
  double offset_s = 0.0, error_s = 0.0;
};
/// Is the day's time right: by the server's clock, else by whether the system keeps it by the
/// network?
Finding check_time_of_day(const std::optional<Offset>& server);
/// When the last calibration was, and whether it is over.
/// A simulated device's does not count for a machine.
Finding check_calibration(const std::optional<Calibration>& last, std::int64_t now_utc_us,
                          Tested tested);

}  // namespace tractus::check
