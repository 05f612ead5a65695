/// What a trial needs of the rig it runs on. Behind it: a haptic handle in a case (palpation_rig),
/// or the probing rig in a scenario (probing_rig).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/devices/catalogue.hpp"
#include "station/loop/loop_thread.hpp"
#include "station/loop/periodic_loop.hpp"
#include "station/loop/recorder.hpp"
#include "station/session/remote_supervisor.hpp"
#include "station/session/station_folder.hpp"
#include "station/session/tip_way.hpp"
#include "station/session/trial_report.hpp"

namespace tractus::loop {
class Drilling;
}

namespace tractus::session {

enum class Speed {
  real,  ///< the monotonic clock
  fast,  ///< a manual clock, as fast as it goes: simulated devices alone, and the trial says so
};

/// What every trial is told.
struct TrialTerms {
  Speed speed = Speed::real;
  double duration_s = 30.0;
  double rate_Hz = 4000.0;
  RemoteSupervisor* outside = nullptr;  ///< who may stop it from afar; outlives the trial
  std::optional<std::int64_t> started_utc_us = {};  ///< fast alone: a SIMULATED date; else now
};

/// The clocks of one trial.
struct TrialTime {
  Speed speed = Speed::real;
  core::MonotonicClock real{};
  core::ManualClock manual{};

  bool fast() const noexcept { return speed == Speed::fast; }
  /// What the loop runs by.
  core::Clock& loop() noexcept { return fast() ? static_cast<core::Clock&>(manual) : real; }
  loop::Pace pace() const noexcept {
    return fast() ? loop::Pace::as_fast_as_goes : loop::Pace::real_time;
  }
};

/// What is told while a trial runs. In a blind trial force, depth and progress are 0: a screen has
/// nothing to show.
struct TrialSnapshot {
  const trial::Header& header;
  bool blind = false;
  double t_s = 0.0;
  double progress = 0.0;           ///< 0 … 1
  double force_N = 0.0;            ///< between hand and device
  double depth_m = 0.0;            ///< of the tip
  std::uint64_t late = 0;          ///< ticks; of the probing rig: periods missed, lost or skipped
  std::uint64_t samples_safe = 0;  ///< on the disk for good
  /// What a picture of a palpation is drawn from. All of it lives as the trial.
  struct Picture {
    loop::Live live;
    const TipWay& way;
    loop::Drilling* drilling = nullptr;  ///< of a trial with a burr: for `show`
  };
  std::optional<Picture> picture = std::nullopt;
};
/// Called from the thread that called `run`, about thirty times a second; false ends the trial in
/// good order.
using Watch = std::function<bool(const TrialSnapshot&)>;

/// One rig for one trial. Called in this order: prepare, describe, record, arm, run, settle,
/// complete, closing_events and end_detail, keep.
class Rig {
 public:
  virtual ~Rig() = default;  ///< closes the device
  virtual const devices::DeviceInfo& device() const = 0;
  virtual TrialTerms terms() const = 0;
  virtual std::size_t sample_bytes() const = 0;

  /// Makes and opens the device and what is felt with it. `time` outlives the rig. Errors:
  /// unavailable, bad_input, out_of_range, those of the device.
  virtual core::Result<void> prepare(TrialTime& time) = 0;
  /// Its own part of the header: what is felt, with what, by whom, within which limits.
  virtual void describe(trial::Header& header) const = 0;
  /// Takes the trial's file and makes the loop that records into it.
  virtual void record(trial::TrialWriter writer) = 0;
  virtual loop::TrialRecorder& recorder() = 0;

  /// Last before the first tick: a person's deed.
  virtual void arm() = 0;
  /// In the loop's thread: ticks until the hand is done, the time is up, a fault or `stop`.
  virtual void run() noexcept = 0;
  /// From any thread, as the next three.
  virtual void stop() noexcept = 0;
  virtual void cap_force(double force_N) noexcept = 0;
  /// No force, and nothing is recorded, while it is on.
  virtual void pause(bool on) noexcept = 0;
  virtual TrialSnapshot latest(const trial::Header& header) const = 0;
  virtual const loop::PeriodicLoop& periods() const = 0;

  /// Why a trial ended before its time; each empty when it did not.
  struct Ended {
    std::string behind;   ///< something beside the loop could not follow it
    std::string latched;  ///< the safety's own word
  };
  /// Once the loop has ended.
  virtual Ended settle() = 0;
  /// What the simulated hand says; nothing for a device that a person holds.
  virtual std::optional<trial::Answer> simulated_answer() const = 0;
  /// Adds what it alone knows.
  virtual void complete(TrialReport& report) = 0;
  /// Events that stand in the file before the answer. @param t_s  now
  virtual std::vector<trial::Event> closing_events(const TrialReport& report, double t_s) const = 0;
  /// Of the "end" event.
  virtual core::Json end_detail(const TrialReport& report) const = 0;
  /// After the file is sealed and queued: what is kept beside it.
  virtual core::Result<void> keep(const StationFolder& folder,
                                  const trial::Header& header) const = 0;
};

}  // namespace tractus::session
