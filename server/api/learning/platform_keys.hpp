/// The keys of learning platforms, fetched when needed.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "db/store/learning/platforms.hpp"
#include "server/api/people/id_token.hpp"
#include "server/api/people/kept_document.hpp"

namespace tractus::api {

/// The key set of each platform is kept for an hour; for an unknown key it is fetched again, at most
/// every ten seconds; after a failure not for a while (Breaker). A platform that hangs delays only
/// launches from itself. Thread-safe.
class PlatformKeys {
 public:
  /// The claims of an id_token of this platform, checked (claims_of). Errors: unauthorised;
  /// unavailable if the platform does not show its keys.
  core::Result<core::Json> claims(const store::Platform& platform, const std::string& id_token,
                                  const Expected& expected, const http::Networks& networks);

  SteadyClock_s now_s = steady_now_s;        ///< before the first call
  std::chrono::milliseconds patience{5000};  ///< time limit for one complete answer

 private:
  struct Kept {
    explicit Kept(const SteadyClock_s& clock_s) : breaker(clock_s), keys(breaker, clock_s) {}
    Breaker breaker;
    KeptDocument keys;
  };
  Kept& kept(const std::string& url);

  std::mutex mutex_;  ///< guards kept_, not what its elements point to
  std::map<std::string, std::unique_ptr<Kept>> kept_;
};

}  // namespace tractus::api
