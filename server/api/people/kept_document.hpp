/// JSON documents of another server: asked for by one thread at a time, kept for a while, and not
/// asked for again at once when the server fails.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>

#include "core/json.hpp"

namespace tractus::api {

/// Seconds of a clock that never goes back.
using SteadyClock_s = std::function<std::int64_t()>;
std::int64_t steady_now_s();

/// A circuit breaker: after a failure the server is left alone for 2 s, after each further one for
/// twice as long, at most for 60 s. Safe from several threads.
class Breaker {
 public:
  explicit Breaker(SteadyClock_s now_s) : now_s_(std::move(now_s)) {}
  /// May the server be asked? Errors: unavailable, with what failed and the seconds to wait.
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

/// One document. `ask` runs outside any lock; who wants the document meanwhile waits for its
/// outcome instead of asking too. Safe from several threads.
class KeptDocument {
 public:
  using Ask = std::function<core::Result<core::Json>()>;
  KeptDocument(Breaker& breaker, SteadyClock_s now_s)
      : breaker_(breaker), now_s_(std::move(now_s)) {}
  /// The document, at most so old. Errors: those of `ask` and of the breaker.
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
