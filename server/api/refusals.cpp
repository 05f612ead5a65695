#include "server/api/refusals.hpp"

#include <algorithm>

#include "db/store/audit.hpp"
#include "server/api/backend.hpp"

namespace api {

bool Refusals::is_one(const std::string& route, int status) {
  if (status == 409) return route != "appendUpload" && route != "commitUpload";
  return status >= 400 && status < 500 && status != 401 && status != 408 && status != 426;
}

std::string Refusals::words_of(const http::Response& response) {
  const auto* text = std::get_if<std::string>(&response.body);
  const core::Json json = text ? core::Json::parse(*text, nullptr, false) : core::Json();
  return json.is_object() ? json.value("error", "").substr(0, 300) : std::string();
}

void Refusals::note(Backend& backend, const Refusal& refusal) {
  const std::int64_t now = backend.now_utc_us();
  std::uint64_t left_out = 0;
  {
    const std::lock_guard held(mutex_);
    Account& account = accounts_[refusal.station];
    account.full_utc_us = std::max(account.full_utc_us, now) + kEvery_us;
    if (account.full_utc_us > now + kBurst * kEvery_us) {
      account.full_utc_us -= kEvery_us;
      ++account.left_out;
      return;
    }
    left_out = std::exchange(account.left_out, 0);
  }
  core::Json detail{{"refused", refusal.why}, {"status", refusal.status}};
  if (left_out > 0) detail["more_not_noted"] = left_out;
  const store::Act act{.who = refusal.station,
                       .role = "station",
                       .peer = refusal.peer,
                       .what = refusal.route,
                       .object = "",
                       .detail = detail.dump(-1, ' ', false, core::Json::error_handler_t::replace),
                       .at_utc_us = now};
  const auto noted = backend.store.write(
      [&](store::Writing& tx) { return store::add_act(tx, backend.store.audit_key(), act); });
  if (!noted && backend.log)
    backend.log({{"what", "audit of a refusal"}, {"error", noted.error().what}});
}

}  // namespace api
