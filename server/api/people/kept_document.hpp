/// Cached JSON documents of another server: fetched by one thread at a time, kept for a while, and
/// after a failure not fetched again immediately.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>

#include "core/json.hpp"
#include "server/api/web_fetch.hpp"

namespace tractus::api {

/// Seconds of a monotonic clock.
using SteadyClock_s = std::function<std::int64_t()>;
std::int64_t steady_now_s();

/// The JSON object that a request is answered with. Errors: those of `fetch`; unavailable for another
/// status than 200 and for an answer that is no JSON object.
core::Result<core::Json> fetched_json(const Fetch& what);

/// A circuit breaker: no request for 2 s after a failure, twice as long after each further failure,
/// at most 60 s. Thread-safe.
class Breaker {
 public:
  explicit Breaker(SteadyClock_s now_s) : now_s_(std::move(now_s)) {}
  /// Whether a request is allowed now. Errors: unavailable, with the last failure and the seconds
  /// to wait.
  core::Result<void> check() const;
  void succeeded();
  void failed(const core::Error& error);

 private:
  SteadyClock_s now_s_;
  mutable std::mutex mutex_;  ///< guards what follows
  int failures_ = 0;          ///< in a row
  std::int64_t closed_until_s_ = 0;
  std::string why_;
};

/// One document. `ask` runs without a lock; other threads that need the document meanwhile wait for
/// the same result. Thread-safe.
class KeptDocument {
 public:
  using Ask = std::function<core::Result<core::Json>()>;
  KeptDocument(Breaker& breaker, SteadyClock_s now_s)
      : breaker_(breaker), now_s_(std::move(now_s)) {}
  /// The document, at most `age_s` old. Errors: those of `ask` and of the breaker.
  core::Result<core::Json> at_most(std::int64_t age_s, const Ask& ask);

 private:
  bool is_fresh(std::int64_t age_s) const;
  core::Result<core::Json> asked(const Ask& ask) const;

  Breaker& breaker_;
  SteadyClock_s now_s_;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable answered_;
  bool asking_ = false;
  std::uint64_t answers_ = 0;
  core::Result<core::Json> last_{core::Error{core::Errc::unavailable, "not asked for yet"}};
  std::optional<core::Json> kept_;
  std::int64_t kept_since_s_ = 0;
};

}  // namespace tractus::api
