#include "station/loop/recorder.hpp"

namespace loop {
namespace {
constexpr std::size_t kBlock = 1024;
}

Recorder::Recorder(SampleRing& ring, trial::TrialWriter writer, core::Clock& clock)
    : ring_(ring),
      writer_(std::move(writer)),
      clock_(clock),
      last_flush_(clock.now()),
      block_(kBlock) {}

Recorder::~Recorder() {
  static_cast<void>(stop());
}  // the error, if any, was kept for whoever asked

void Recorder::start() {
  core::require(!thread_.joinable(), "a recorder is started once");
  thread_ = std::thread([this] { loop(); });
}

void Recorder::loop() {
  core::Instant_ns next = clock_.now();
  while (!stop_.load(std::memory_order_relaxed)) {
    drain();
    next = std::max(next + kPoll_ns, clock_.now());
    clock_.sleep_until(next);
  }
}

void Recorder::drain() {
  for (;;) {
    const std::size_t taken = ring_.pop(block_);
    if (taken == 0) break;
    if (!failed()) keep(writer_.append(std::span(block_).first(taken)));
  }
  const core::Instant_ns now = clock_.now();
  if (now - last_flush_ >= kFlush_ns) flush(now);
}

void Recorder::flush(core::Instant_ns now) {
  last_flush_ = now;
  const std::uint64_t written = writer_.samples_written();
  if (failed() || written == samples_safe()) return;
  keep(writer_.flush());
  if (!failed()) safe_.store(written, std::memory_order_relaxed);
}

void Recorder::keep(const core::Result<void>& outcome) {
  if (outcome || failed()) return;
  first_error_ = outcome;
  failed_.store(true, std::memory_order_relaxed);
}

core::Result<void> Recorder::stop() {
  if (thread_.joinable()) {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  drain();
  flush(clock_.now());
  return first_error_;
}

core::Result<void> Recorder::append(const trial::Event& event) {
  keep(writer_.append(event));
  return first_error_;
}

core::Result<void> Recorder::finish() {
  if (!failed()) keep(writer_.finish());
  return first_error_;
}

}  // namespace loop
