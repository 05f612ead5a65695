#include "server/api/learning/platform_keys.hpp"

namespace tractus::api {

PlatformKeys::Kept& PlatformKeys::kept(const std::string& url) {
  const std::lock_guard held(mutex_);
  auto& out = kept_[url];
  if (!out) out = std::make_unique<Kept>(now_s);
  return *out;
}

core::Result<core::Json> PlatformKeys::claims(const store::Platform& platform,
                                              const std::string& id_token, const Expected& expected,
                                              const http::Networks& networks) {
  Kept& of_platform = kept(platform.keys_url);
  const Fetch wanted{.url = platform.keys_url,
                     .patience = patience,
                     .networks = networks,
                     .who = "the learning platform"};
  return claims_by(
      [&](std::int64_t age_s) {
        return of_platform.keys.at_most(age_s, [&] { return fetched_json(wanted); });
      },
      id_token, expected);
}

}  // namespace tractus::api
