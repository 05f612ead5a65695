/// How long people's data are kept: a director's rules, and on whom they act, before they act.
#include "core/try.hpp"
#include "db/store/people/retention.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;

constexpr std::uint64_t kMaxRetention_bytes = 4096;
constexpr std::size_t kMaxRetentionReason = 500;
constexpr std::int64_t kNoticeDay_us = 86'400'000'000;

Json version_json(const store::RetentionVersion& of) {
  Json out = core::stored_json(of.rules.text());
  out.erase("format");
  out["version"] = of.version;
  out["reason"] = of.reason;
  out["made_utc_us"] = of.made_utc_us;
  out["made_by"] = of.made_by;
  return out;
}

/// Whom these rules mean now. Without a notice so far, they act when a notice of now would be over.
Result<Json> effect_json(store::Reading& tx, const store::RetentionRules& rules,
                         std::int64_t now_utc_us) {
  Json people = Json::array();
  if (rules.inactive_years) {
    const auto inactive =
        TRY(store::inactive_people(tx, store::inactive_before(rules, now_utc_us)));
    for (const store::InactivePerson& one : inactive)
      people.push_back({{"id", one.account_id},
                        {"name", one.name},
                        {"last_utc_us", one.last_utc_us},
                        {"noticed", one.acts_utc_us.has_value()},
                        {"acts_utc_us", one.acts_utc_us.value_or(now_utc_us + rules.notice_days *
                                                                                  kNoticeDay_us)}});
  }
  std::uint64_t sign_ins = 0;
  if (rules.sign_ins_months)
    sign_ins = TRY(store::old_sign_ins(tx, store::sign_ins_before(rules, now_utc_us)));
  return Json{{"people", people}, {"sign_ins", sign_ins}};
}

Result<http::Response> retention_response(const Call& call, int status) {
  auto json = TRY(call.backend.store.read([&](store::Reading& tx) -> Result<Json> {
    const auto versions = TRY(store::retention_versions(tx));
    Json list = Json::array();
    for (const auto& one : versions) list.push_back(version_json(one));
    const store::RetentionRules now =
        versions.empty() ? store::RetentionRules() : versions.front().rules;
    auto effect = TRY(effect_json(tx, now, call.backend.now_utc_us()));
    return Json{{"versions", list}, {"effect", effect}};
  }));
  return json_response(json, status);
}

Result<http::Response> show_retention(const Call& call) { return retention_response(call, 200); }

Result<http::Response> preview_retention(const Call& call) {
  const auto rules = TRY(store::RetentionRules::from_text(call.request.body, "body"));
  const auto effect = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return effect_json(tx, rules, call.backend.now_utc_us()); }));
  return json_response(effect);
}

Result<http::Response> set_retention(const Call& call) {
  const auto rules = TRY(store::RetentionRules::from_text(call.request.body, "body"));
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string reason = fields.text("reason", kMaxRetentionReason);
  for (const char* known :
       {"format", "inactive_years", "inactive_mode", "sign_ins_months", "notice_days"})
    fields.skip(known);
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::add_retention_rules(tx, {.rules = rules,
                                           .reason = reason,
                                           .made_utc_us = call.backend.now_utc_us(),
                                           .made_by = call.caller.name});
  }));
  call.backend.work_waits();
  return retention_response(call, 201);
}

std::vector<schema::Field> rule_fields() {
  using namespace schema;
  return {{"inactive_years",
           nullable(integer("1",
                            "Trainees without sign-in or trial for so many years, 1 to 50, leave; "
                            "null: the rule is off"))},
          {"inactive_mode", one_of<store::ErasureMode>("Whether their trials are erased or stay")},
          {"sign_ins_months",
           nullable(integer("1",
                            "Records of sign-ins older than so many months, 1 to 240, are "
                            "removed; null: the rule is off"))},
          {"notice_days", integer("d", "Days between the notice and the act, 7 to 365")}};
}

std::vector<NamedSchema> retention_schemas() {
  using namespace schema;
  auto version = rule_fields();
  version.emplace_back("version", integer("1", "Version of the rules, from 1"));
  version.emplace_back("reason", text("Reason of the change"));
  version.emplace_back("made_utc_us",
                       integer("us", "Time of the change, in microseconds since 1970-01-01 UTC"));
  version.emplace_back("made_by", text("Name of the account that made the change"));
  return {
      {"RetentionVersion", object(version)},
      {"RetentionPerson",
       object(
           {{"id", text("Id of the account")},
            {"name", text("Name of the account")},
            {"last_utc_us", integer("us", "Last activity, in microseconds since 1970-01-01 UTC")},
            {"noticed", truth("True if the notice period runs")},
            {"acts_utc_us", integer("us",
                                    "When the rule acts on this person at the earliest, in "
                                    "microseconds since 1970-01-01 UTC")}})},
      {"RetentionEffect",
       object({{"people", array(ref("RetentionPerson"), "Trainees on whom the rules act, by name")},
               {"sign_ins", integer("1", "Number of records of sign-ins that the rules remove")}})},
      {"Retention", object({{"versions", array(ref("RetentionVersion"),
                                               "Versions of the rules, newest first; "
                                               "empty: no rule acts")},
                            {"effect", ref("RetentionEffect")}})}};
}

RouteInfo retention_route(std::string method, std::string tail, std::string id, std::string summary,
                          std::string answer, Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/retention" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::director},
          .parameters = {},
          .body = "",
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> retention_routes() {
  RouteInfo show = retention_route("GET", "", "retention",
                                   "Read the retention rules, all versions, and on whom they act",
                                   "Retention", show_retention);
  show.who.push_back(Role::admin);
  show.schemas = retention_schemas();
  RouteInfo look = retention_route("POST", "/preview", "previewRetention",
                                   "Show on whom retention rules would act; changes nothing",
                                   "RetentionEffect", preview_retention);
  look.body = "RetentionRules";
  look.body_limit_bytes = kMaxRetention_bytes;
  look.schemas = {{"RetentionRules", schema::object(rule_fields())}};
  RouteInfo set =
      retention_route("POST", "", "setRetention",
                      "Set retention rules; they act on each person after a notice period",
                      "Retention", set_retention);
  set.body = "NewRetention";
  set.body_limit_bytes = kMaxRetention_bytes;
  auto fields = rule_fields();
  fields.emplace_back("reason", schema::text("Reason of the change, at most 500 bytes"));
  set.schemas = {{"NewRetention", schema::object(fields)}};
  return {show, look, set};
}

}  // namespace api
}  // namespace tractus
