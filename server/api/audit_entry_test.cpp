/// What of a call is kept in the audit trail, over the whole catalogue.
#include "server/api/audit_entry.hpp"

#include <regex>

#include "server/api/api_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using testing::ApiTest;

class Acts : public ApiTest {
 protected:
  /// The detail of a call of the route with this body.
  std::string detail(const RouteInfo& route, const core::Json& body) {
    const auto asked = request(route.method, "/api/v1/anything", {}, body.dump());
    const Caller caller{Role::admin, "1", "ada", ""};
    return audited_action(route, Call{backend_, asked, caller, {}}, {}).detail;
  }
  static const RouteInfo& route_of(const std::string& id) {
    return *std::ranges::find(routes(), id, &RouteInfo::id);
  }
  /// The properties of the body's schema, each with a text that is nowhere else.
  static core::Json planted_body(const RouteInfo& route) {
    core::Json out = core::Json::object();
    for (const RouteInfo& other : routes())
      for (const NamedSchema& named : other.schemas)
        if (named.name == route.body && named.schema.contains("properties"))
          for (const auto& [field, _] : named.schema["properties"].items())
            out[field] = "planted " + field + ".";
    return out;
  }
};

// By hand, of every route whose body has a password, a PIN, a code, a ticket or a key.
const std::map<std::string, std::vector<std::string>> kSecrets{
    {"signIn", {"password", "code"}},
    {"addAccount", {"password", "pin"}},
    {"setBadge", {"pin"}},
    {"changePassword", {"old", "new", "code"}},
    {"beginCodes", {"password"}},
    {"confirmCodes", {"code"}},
    {"endCodes", {"password", "code"}},
    {"enrolStation", {"code", "token_sha256"}},
    {"signInAtStation", {"pin"}},
    {"nextTrial", {"ticket"}},
    {"trialResultAtStation", {"ticket"}},
    {"signOutAtStation", {"ticket"}},
    {"setRecordStore", {"secret"}},
    {"makeStudy", {"seed"}},
    {"addAssignment", {"seed"}}};

TEST_F(Acts, NoSecretOfAnyRouteIsKept) {
  for (const auto& [id, fields] : kSecrets) {
    const core::Json body = planted_body(route_of(id));
    const std::string kept = detail(route_of(id), body);
    for (const std::string& field : fields) {
      ASSERT_TRUE(body.contains(field)) << id << " has no field " << field;
      EXPECT_EQ(kept.find("planted " + field + "."), std::string::npos) << id << ": " << kept;
    }
  }
}

TEST_F(Acts, NoFieldOfTheCatalogueThatIsNamedLikeASecretIsKept) {
  const std::regex secret("pass|pin|code|ticket|token|secret|key|seed");
  for (const RouteInfo& route : routes()) {
    const core::Json body = planted_body(route);
    for (const auto& [field, value] : body.items()) {
      if (!std::regex_search(field, secret)) continue;
      EXPECT_EQ(detail(route, {{field, value}}).find("planted"), std::string::npos)
          << route.id << " " << field;
    }
  }
}

TEST_F(Acts, WhatNobodyHasNamedIsNotKeptAtAnyDepth) {
  const core::Json body{{"name", "room 3"},
                        {"otp", "planted"},
                        {"people", {{{"name", "tom"}, {"recovery", "planted"}}}},
                        {"deeper", {{"name", "planted"}}}};
  EXPECT_EQ(core::Json::parse(detail(route_of("addCohort"), body)),
            (core::Json{{"name", "room 3"},
                        {"otp", "(not kept)"},
                        {"people", {{{"name", "tom"}, {"recovery", "(not kept)"}}}},
                        {"deeper", "(not kept)"}}));
}

TEST_F(Acts, WhoDidWhatStaysReadable) {
  const std::map<std::string, std::vector<std::string>> readable{
      {"signIn", {"name"}},
      {"addAccount", {"name", "role", "badge"}},
      {"setAccountRole", {"role"}},
      {"setAccountState", {"state"}},
      {"setBadge", {"badge"}},
      {"linkSubject", {"subject"}},
      {"makeEnrolmentCode", {"name"}},
      {"addCohort", {"name"}},
      {"putIntoCohort", {"name"}},
      {"addAssignment", {"title", "cohort", "people", "release"}},
      {"markTrialInvalid", {"reason"}},
      {"stopStation", {"reason"}},
      {"limitStation", {"force_N"}},
      {"sayConsent", {"study", "tier"}},
      {"noteConsent", {"account", "study", "participant", "tier", "basis"}},
      {"startFit", {"model", "measurements", "add"}}};
  for (const auto& [id, fields] : readable) {
    const core::Json body = planted_body(route_of(id));
    const std::string kept = detail(route_of(id), body);
    for (const std::string& field : fields)
      EXPECT_NE(kept.find("planted " + field + "."), std::string::npos) << id << ": " << kept;
  }
}

}  // namespace
}  // namespace api
}  // namespace tractus
