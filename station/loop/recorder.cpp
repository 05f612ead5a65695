#include "station/loop/recorder.hpp"

namespace tractus::loop {
namespace {
constexpr std::size_t kBlockRows = 1024;
}

TrialRecorder::TrialRecorder(trial::TrialWriter writer, core::Clock& clock)
    : writer_(std::move(writer)), clock_(clock), last_flush_(clock.now()) {}

void TrialRecorder::start() {
  core::require(!thread_.joinable(), "a recorder is started once");
  thread_ = std::thread([this] { loop(); });
}

void TrialRecorder::loop() {
  core::Instant_ns next = clock_.now();
  while (!stop_.load(std::memory_order_relaxed)) {
    drain();
    next = std::max(next + kPoll_ns, clock_.now());
    clock_.sleep_until(next);
  }
}

void TrialRecorder::drain() {
  take_all();
  const core::Instant_ns now = clock_.now();
  if (now - last_flush_ >= kFlush_ns) flush(now);
}

void TrialRecorder::flush(core::Instant_ns now) {
  last_flush_ = now;
  const std::uint64_t written = writer_.samples_written();
  if (failed() || written == samples_safe()) return;
  keep(writer_.flush());
  if (!failed()) safe_.store(written, std::memory_order_relaxed);
}

void TrialRecorder::keep(const core::Result<void>& outcome) {
  if (outcome || failed()) return;
  first_error_ = outcome;
  failed_.store(true, std::memory_order_relaxed);
}

core::Result<void> TrialRecorder::stop() {
  if (thread_.joinable()) {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  drain();
  flush(clock_.now());
  return first_error_;
}

core::Result<void> TrialRecorder::append(const trial::Event& event) {
  keep(writer_.append(event));
  return first_error_;
}

core::Result<void> TrialRecorder::finish() {
  if (!failed()) keep(writer_.finish());
  return first_error_;
}

template <class S>
RecorderOf<S>::RecorderOf(Ring<S>& ring, trial::TrialWriter writer, core::Clock& clock)
    : TrialRecorder(std::move(writer), clock), ring_(ring), block_(kBlockRows) {}

template <class S>
RecorderOf<S>::~RecorderOf() {
  static_cast<void>(stop());
}  // the error, if any, was kept for whoever asked

template <class S>
void RecorderOf<S>::take_all() {
  for (;;) {
    const std::size_t taken = ring_.pop(block_);
    if (taken == 0) break;
    const auto samples = std::span<const S>(block_).first(taken);
    if (!failed()) keep(writer_.append(samples));
    if (told_ && !failed()) told_(samples);
  }
}

template class RecorderOf<trial::Sample>;
template class RecorderOf<trial::ProbingSample>;

}  // namespace tractus::loop
