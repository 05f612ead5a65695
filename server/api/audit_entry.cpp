#include "server/api/audit_entry.hpp"

#include <algorithm>
#include <array>

#include "server/api/backend.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::size_t kMaxRead_bytes = 16 * 1024;  // bodies with a secret have lower limits
constexpr std::size_t kMaxDetail_bytes = 4096;

/// The fields of bodies that are kept as they came, sorted. None of them may ever hold a secret:
/// what a new route calls otherwise is not kept until it is named here.
constexpr std::array<std::string_view, 105> kKept{"account",
                                                  "accounts",
                                                  "add",
                                                  "adequate",
                                                  "after",
                                                  "against",
                                                  "all",
                                                  "assignment",
                                                  "assignments",
                                                  "at_m",
                                                  "at_s",
                                                  "at_utc_us",
                                                  "authorization_url",
                                                  "badge",
                                                  "basis",
                                                  "blind",
                                                  "bound",
                                                  "breach",
                                                  "calibration",
                                                  "case",
                                                  "case_id",
                                                  "cases",
                                                  "channel",
                                                  "choices",
                                                  "client_id",
                                                  "cohort",
                                                  "complete",
                                                  "criteria",
                                                  "data_seen",
                                                  "delivery",
                                                  "deployments",
                                                  "depth_m",
                                                  "due_utc_us",
                                                  "endpoint",
                                                  "entry_m",
                                                  "experience_years",
                                                  "expires_utc_us",
                                                  "force_N",
                                                  "format",
                                                  "free_disk_bytes",
                                                  "id",
                                                  "inactive_mode",
                                                  "inactive_years",
                                                  "inadequate",
                                                  "issuer",
                                                  "kind",
                                                  "kinds",
                                                  "last",
                                                  "level",
                                                  "looked_at",
                                                  "made_utc_us",
                                                  "match_email",
                                                  "measurements",
                                                  "metric",
                                                  "mode",
                                                  "model",
                                                  "name",
                                                  "note",
                                                  "notice_days",
                                                  "on_invalid",
                                                  "ordering",
                                                  "participant",
                                                  "participants",
                                                  "passed",
                                                  "people",
                                                  "plan",
                                                  "protocol",
                                                  "published",
                                                  "radius_m",
                                                  "raters",
                                                  "reason",
                                                  "reference",
                                                  "refused",
                                                  "release",
                                                  "repeats",
                                                  "requirements",
                                                  "retired",
                                                  "rig",
                                                  "role",
                                                  "rubric",
                                                  "scenarios",
                                                  "scopes",
                                                  "self_test",
                                                  "sha256",
                                                  "share",
                                                  "side",
                                                  "sign_ins_months",
                                                  "simulated",
                                                  "size_bytes",
                                                  "state",
                                                  "stations",
                                                  "step",
                                                  "steps",
                                                  "study",
                                                  "subject",
                                                  "target_m",
                                                  "tier",
                                                  "times",
                                                  "title",
                                                  "trial_id",
                                                  "tuned",
                                                  "version",
                                                  "volume",
                                                  "wall",
                                                  "words"};

bool is_kept(std::string_view field) { return std::ranges::binary_search(kKept, field); }

/// Without the values of fields that are not kept, at any depth.
core::Json kept(const core::Json& json) {
  if (!json.is_structured()) return json;
  core::Json out = json.is_array() ? core::Json::array() : core::Json::object();
  if (json.is_array())
    for (const auto& inner : json) out.push_back(kept(inner));
  else
    for (const auto& [field, value] : json.items())
      out[field] = is_kept(field) ? kept(value) : core::Json("(not kept)");
  return out;
}

core::Json detail_of(const http::Request& request) {
  if (request.body.empty()) return core::Json::object();
  if (request.body.size() <= kMaxRead_bytes) {
    const auto json = core::parse_json(request.body, "body");
    if (json && json->is_object()) {
      core::Json out = kept(*json);
      if (out.dump(-1, ' ', false, core::Json::error_handler_t::replace).size() <= kMaxDetail_bytes)
        return out;
    }
  }
  return {{"size_bytes", request.body.size()},
          {"sha256", core::sha256(core::bytes_of(request.body))}};
}

}  // namespace

std::string object_text(const std::map<std::string, std::string>& segments) {
  std::string out;
  for (const auto& [key, value] : segments)
    out += (out.empty() ? "" : " ") + key + "=" + value.substr(0, 128);
  return out;
}

store::AuditedAction audited_action(const RouteInfo& route, const Call& call,
                                    const std::map<std::string, std::string>& segments) {
  core::Json detail = detail_of(call.request);
  if (call.caller.token) detail["api_token"] = call.caller.token->id;
  return {.who = call.caller.name,
          .role = route.open ? "" : std::string(name(call.caller.role)),
          .peer = call.request.peer,
          .what = route.id,
          .object = object_text(segments),
          .detail = detail.dump(-1, ' ', false, core::Json::error_handler_t::replace),
          .at_utc_us = call.backend.now_utc_us()};
}

}  // namespace api
}  // namespace tractus
