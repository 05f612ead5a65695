/// The rule from the identity provider's groups to roles and cohorts, in versions.
#include "core/try.hpp"
#include "db/store/people/group_rules.hpp"
#include "db/store/people/people.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/group_rule.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;

constexpr std::uint64_t kMaxGroupRule_bytes = 1u << 16;

Result<http::Response> list_group_rules(const Call& call) {
  const auto versions =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::group_rules(tx); }));
  Json list = Json::array();
  for (const store::GroupRuleVersion& one : versions)
    list.push_back({{"version", one.version},
                    {"rule", core::stored_json(one.definition)},
                    {"reason", one.reason},
                    {"made_utc_us", one.made_utc_us},
                    {"made_by", one.made_by}});
  return json_response({{"versions", list}});
}

Result<http::Response> set_group_rule(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const Json* rule = fields.member("rule");
  const std::string reason = fields.text("reason", 500);
  TRY(fields.done());
  const auto read = TRY(GroupRule::from_json(*rule, "body: /rule"));
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    for (const std::string& id : read.cohorts()) {
      const auto cohort = TRY(store::cohort_of(tx, id));
      if (!cohort) return core::Error{core::Errc::not_found, "no cohort " + id.substr(0, 32)};
    }
    return store::add_group_rule(tx, {.definition = read.to_json().dump(),
                                      .reason = reason,
                                      .made_utc_us = call.backend.now_utc_us(),
                                      .made_by = call.caller.name});
  }));
  return list_group_rules(call);
}

std::vector<NamedSchema> group_rule_schemas() {
  using namespace schema;
  return {
      {"GroupLine",
       object({{"group", text("Name of the group, as the provider's claim groups gives it")},
               {"role", text("Role of who is in the group: director, faculty, researcher, "
                             "technician or trainee; the first line that fits decides")},
               {"cohorts", optional(array(text("Id of a cohort"),
                                          "Cohorts that a trainee or faculty of the group joins"))},
               {"level", optional(text("Level of training; empty: left as it is"))}})},
      {"GroupRule",
       object({{"format", text("tractus-groups/1")},
               {"lines", array(ref("GroupLine"), "Lines of the rule, in their order")},
               {"absent_days",
                optional(integer("d",
                                 "Days after which a person whom the provider has not vouched "
                                 "for counts as having left, 1 to 3650"))}})},
      {"GroupRuleVersion",
       object({{"version", integer("1", "Number of the version, from 1")},
               {"rule", ref("GroupRule")},
               {"reason", text("Why it was written")},
               {"made_utc_us", integer("us", "Time, in microseconds since 1970-01-01 UTC")},
               {"made_by", text("Name of the administrator")}})},
      {"GroupRules", object({{"versions", array(ref("GroupRuleVersion"),
                                                "Newest first; the first is in force")}})},
      {"GroupRuleAsked", object({{"rule", ref("GroupRule")}, {"reason", text("Why it changes")}})}};
}

}  // namespace

std::vector<RouteInfo> group_rules_routes() {
  RouteInfo list{.method = "GET",
                 .path = "/api/v1/group-rules",
                 .id = "groupRules",
                 .summary =
                     "List the versions of the rule from the identity provider's groups to "
                     "roles and cohorts",
                 .who = {Role::admin},
                 .parameters = {},
                 .body = "",
                 .answer = "GroupRules",
                 .schemas = group_rule_schemas(),
                 .handle = list_group_rules};
  RouteInfo set{.method = "POST",
                .path = "/api/v1/group-rules",
                .id = "setGroupRule",
                .summary = "Store a new version of the rule; it holds from the next sign-in on",
                .who = {Role::admin},
                .parameters = {},
                .body = "GroupRuleAsked",
                .body_limit_bytes = kMaxGroupRule_bytes,
                .answer = "GroupRules",
                .schemas = {},
                .handle = set_group_rule};
  set.ends = {{"/rule/lines/*/cohorts/*", Object::cohort, {Role::admin}}};
  return {list, set};
}

}  // namespace api
}  // namespace tractus
