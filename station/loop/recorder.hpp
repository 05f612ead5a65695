/// From the ring to the trial file.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <thread>
#include <vector>

#include "core/clock.hpp"
#include "station/loop/haptic_loop.hpp"
#include "trial/trial_file.hpp"

namespace tractus::loop {

/// Takes samples out of a ring and appends them to the trial file, as the ring's one consumer.
/// With `start`, a thread of its own does so every 5 ms and has the file on the disk every 10 ms: a
/// loss of power costs 20 ms at most if the disk answers within 10. Without, whoever calls `drain`
/// is the consumer (a loop under a manual clock). The first error stops recording for good and is
/// kept; `failed` tells so at once.
class TrialRecorder {
 public:
  static constexpr core::Instant_ns kPoll_ns = 5'000'000;
  static constexpr core::Instant_ns kFlush_ns = 10'000'000;

  virtual ~TrialRecorder() = default;
  TrialRecorder(const TrialRecorder&) = delete;
  TrialRecorder& operator=(const TrialRecorder&) = delete;

  void start();
  /// Ends the thread if there is one, takes out the rest and flushes. Errors: the first of
  /// recording.
  core::Result<void> stop();
  /// All that is in the ring; flushes when kFlush_ns have passed. Not beside a running thread.
  void drain();
  /// Not beside a running thread.
  core::Result<void> append(const trial::Event& event);
  /// Seals the file. Not beside a running thread.
  core::Result<void> finish();
  /// From any thread.
  bool failed() const noexcept { return failed_.load(std::memory_order_relaxed); }
  /// Samples that are on the disk for good; from any thread.
  std::uint64_t samples_safe() const noexcept { return safe_.load(std::memory_order_relaxed); }

 protected:
  /// `clock` paces polling and flushing and must outlive this.
  TrialRecorder(trial::TrialWriter writer, core::Clock& clock);
  /// Moves what is in the ring into the file.
  virtual void take_all() = 0;
  void keep(const core::Result<void>& outcome);
  trial::TrialWriter writer_;

 private:
  void flush(core::Instant_ns now);
  void loop();

  core::Clock& clock_;
  core::Instant_ns last_flush_;
  core::Result<void> first_error_;
  std::atomic<bool> failed_ = false, stop_ = false;
  std::atomic<std::uint64_t> safe_ = 0;
  std::thread thread_;
};

/// Of one kind of samples.
template <class S>
class RecorderOf final : public TrialRecorder {
 public:
  /// `ring` must outlive this.
  RecorderOf(Ring<S>& ring, trial::TrialWriter writer, core::Clock& clock);
  ~RecorderOf() override;
  /// Before `start`: `take` has every sample that was recorded, in order, from the thread that
  /// records; it must be quick.
  void tell(std::function<void(std::span<const S>)> take) { told_ = std::move(take); }

 private:
  void take_all() override;
  Ring<S>& ring_;
  std::vector<S> block_;
  std::function<void(std::span<const S>)> told_;
};

using Recorder = RecorderOf<trial::Sample>;
using ProbingRecorder = RecorderOf<trial::ProbingSample>;

}  // namespace tractus::loop
