/// Records spans and sends them from a thread of its own.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

#include "tracing/collector.hpp"
#include "tracing/otlp.hpp"

namespace tractus::tracing {

/// Keeps at most kMostWaiting spans; those beyond are dropped and counted, as are those that the
/// collector refuses. While it is away the rest waits, longer and longer. Thread-safe.
class Tracer {
 public:
  static constexpr std::size_t kMostWaiting = 2048, kMostSent = 512;
  static constexpr std::chrono::milliseconds kLongestWait{60'000}, kLastTry{1'000};

  /// Called with one line when spans are not taken, and with "" when they are again.
  using Log = std::function<void(const std::string& why)>;

  Tracer(Settings settings, Post post, Log log);
  /// Sends what waits, within kLastTry.
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  /// Never waits for the collector.
  void record(SpanRecord span);

  struct Counts {
    std::uint64_t sent = 0, dropped = 0;
  };
  Counts counts() const;

 private:
  using Clock = std::chrono::steady_clock;
  void run();
  std::vector<SpanRecord> next_batch();
  /// Whether the batch is dealt with; else it is sent again.
  bool deliver(const std::vector<SpanRecord>& batch, const std::string& body);
  void wait_before_next_try();
  bool is_over() const;  ///< ended, and kLastTry is over too

  const Settings settings_;
  const Post post_;
  const Log log_;
  mutable std::mutex mutex_;  ///< guards waiting_, counts_, ending_
  std::condition_variable changed_;
  std::deque<SpanRecord> waiting_;
  Counts counts_;
  std::optional<Clock::time_point> ending_;  ///< when it must have ended
  int tries_ = 0;                            ///< in vain, one after the other
  std::string told_;                         ///< what the log was told last
  std::thread thread_;
};

/// By the environment of this process; null if it does not ask for traces, or asks for what is not
/// possible, which the log is told.
std::unique_ptr<Tracer> tracer_of_environment(const std::string& service_name,
                                              const std::string& version, Tracer::Log log);

/// A step of a trace, from construction to destruction. Without a tracer, and in a trace that is
/// not sampled, it records nothing.
class Span {
 public:
  Span(Tracer* tracer, std::string name, SpanKind kind, const std::optional<SpanContext>& parent);
  ~Span();
  Span(const Span&) = delete;
  Span& operator=(const Span&) = delete;
  /// A text or an integer; never a name, an address, an id or a text of a person.
  void set(const std::string& key, core::Json value);
  /// `type` is one of a few words, for the attribute error.type; empty: it did not fail after all.
  void set_failed(const std::string& type);
  const std::optional<SpanContext>& context() const { return context_; }
  /// For the header and for a job; empty if nothing is recorded.
  std::string traceparent() const;

 private:
  Tracer* tracer_ = nullptr;
  std::optional<SpanContext> context_;
  SpanRecord record_;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace tractus::tracing
