#include "server/api/refusals.hpp"

#include <algorithm>

#include "core/words.hpp"
#include "db/store/operations/audit.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

bool RefusalLimit::draw(Bucket& bucket, double per_minute, double most, std::int64_t now_utc_us) {
  const double minutes = std::max(0.0, double(now_utc_us - bucket.at_utc_us) / 60e6);
  bucket.left = std::min(most, bucket.left + minutes * per_minute);
  bucket.at_utc_us = now_utc_us;
  if (bucket.left < 1.0) return false;
  bucket.left -= 1.0;
  return true;
}

std::optional<std::uint64_t> RefusalLimit::turn(const std::string& caller,
                                                std::int64_t now_utc_us) {
  const std::lock_guard held(mutex_);
  if (!callers_.contains(caller) && callers_.size() >= kCallers)
    callers_.erase(std::ranges::min_element(
        callers_, {}, [](const auto& entry) { return entry.second.at_utc_us; }));
  Bucket& own = callers_.try_emplace(caller, Bucket{kBurst, now_utc_us}).first->second;
  if (!draw(own, kPerMinute, kBurst, now_utc_us) ||
      !draw(all_, kAllPerMinute, kAllPerMinute, now_utc_us)) {
    ++unnoted_;
    return std::nullopt;
  }
  return std::exchange(unnoted_, 0);
}

bool is_refusal_of_station(const std::string& route, int status) {
  if (status == 409) return route != "appendUpload" && route != "commitUpload";
  return status >= 400 && status < 500 && status != 401 && status != 408 && status != 426;
}

std::string words_of(const http::Response& response) {
  const auto* text = std::get_if<std::string>(&response.body);
  const core::Json json = text ? core::stored_json(*text) : core::Json();
  return json.is_object() ? core::one_line(json.value("error", ""), 300) : std::string();
}

namespace {

std::string text_of(const core::Json& detail) {
  return detail.dump(-1, ' ', false, core::Json::error_handler_t::replace);
}

void add_refusal(Backend& backend, const store::AuditedAction& act) {
  const auto noted = backend.store.write(
      [&](store::Writing& tx) { return store::add_act(tx, backend.store.audit_key(), act); });
  if (!noted && backend.log) backend.log({{"what", "refusal not noted"}});
}

}  // namespace

void note_refusal(Backend& backend, const Caller& caller, const std::string& peer,
                  const std::string& route, const std::string& object, const std::string& why,
                  int status) {
  const std::int64_t now = backend.now_utc_us();
  const auto unnoted = backend.refusals.turn(caller.id, now);
  if (!unnoted) return;
  core::Json detail{{"why", why}};
  if (status > 0) detail["status"] = status;
  if (caller.token) detail["api_token"] = caller.token->id;
  if (*unnoted > 0) detail["refusals_not_noted"] = *unnoted;
  add_refusal(backend, {.who = caller.name,
                        .role = std::string(name(caller.role)),
                        .peer = peer,
                        .what = "refused: " + route,
                        .object = object,
                        .detail = text_of(detail),
                        .at_utc_us = now});
}

void note_stranger(Backend& backend, const std::string& peer, const std::string& route,
                   const core::Json& detail) {
  const std::int64_t now = backend.now_utc_us();
  if (!backend.refusals.turn("stranger", now)) return;
  add_refusal(
      backend,
      {.peer = peer, .what = "refused: " + route, .detail = text_of(detail), .at_utc_us = now});
}

}  // namespace tractus::api
