/// What every route of the catalogue must be; generated from the catalogue.
#include <regex>
#include <set>

#include "assessment/criteria.hpp"
#include "assessment/plan.hpp"
#include "cases/certificate.hpp"
#include "models/probing_model.hpp"
#include "scenarios/scenario.hpp"
#include "server/api/api_test_support.hpp"
#include "server/api/openapi.hpp"
#include "tests/support/schema/described.hpp"
#include "trial/motion_program.hpp"

namespace tractus {
namespace api {
namespace {
using testing::ApiTest;
using testing::kCase;

/// The path with its placeholders filled in.
std::string address(const RouteInfo& route) {
  std::string out = route.path;
  const std::map<std::string, std::string> values{{"{id}", kCase},
                                                  {"{account_id}", "1"},
                                                  {"{trial}", "none"},
                                                  {"{trial_id}", std::string(32, 'a')},
                                                  {"{name}", "volume.tvol"}};
  for (const auto& [key, value] : values)
    if (const auto at = out.find(key); at != std::string::npos) out.replace(at, key.size(), value);
  return out;
}

class Routes : public ApiTest {};

TEST_F(Routes, AllButSigningInRefuseWhoHasNoCredentials) {
  std::vector<std::string> open;
  for (const RouteInfo& route : routes()) {
    const int status = ask(request(route.method, address(route), {{"x-tractus", "1"}})).status;
    if (route.open)
      open.push_back(route.method + " " + route.path);
    else
      EXPECT_EQ(status, 401) << route.method << " " << route.path;
  }
  EXPECT_EQ(open, (std::vector<std::string>{
                      "GET /api/v1/lti/login", "POST /api/v1/lti/login", "POST /api/v1/lti/launch",
                      "GET /api/v1/lti/keys", "GET /api/v1/session/oidc",
                      "GET /api/v1/session/oidc/start", "GET /api/v1/session/oidc/callback",
                      "GET /api/v1/session/oidc/end", "GET /api/v1/health", "POST /api/v1/session",
                      "POST /api/v1/stations/enrol"}));
}

TEST_F(Routes, RefuseBeforeTheBodyIsRead) {
  for (const RouteInfo& route : routes()) {
    if (route.open) continue;
    const auto admitted = admit(backend_, routes(), request(route.method, address(route)));
    ASSERT_TRUE(std::holds_alternative<http::Response>(admitted)) << route.path;
    EXPECT_EQ(std::get<http::Response>(admitted).status, 401) << route.path;
  }
}

TEST_F(Routes, AChangeByCookieNeedsTheHeaderThatNoOtherSiteCanSend) {
  const std::string own = cookie();
  EXPECT_EQ(ask(request("DELETE", "/api/v1/session", {{"cookie", own}})).status, 403);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", {{"cookie", own}})).status, 200);
  EXPECT_EQ(ask(request("DELETE", "/api/v1/session", {{"cookie", own}, {"x-tractus", "1"}})).status,
            204);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", {{"cookie", own}})).status, 401);
}

TEST_F(Routes, OnlyALaunchTakesAFormOfAnotherSite) {
  std::vector<std::string> taking;
  for (const RouteInfo& route : routes())
    if (route.takes_foreign_form) {
      taking.push_back(route.id);
      EXPECT_TRUE(route.open) << route.id;
    }
  EXPECT_EQ(taking, (std::vector<std::string>{"ltiLoginForm", "ltiLaunch"}));
}

TEST_F(Routes, AnUnknownAddressIsToldToNobodyWithoutCredentials) {
  EXPECT_EQ(ask(request("GET", "/api/v1/secrets")).status, 401);
  EXPECT_EQ(ask(request("GET", "/api/v1/secrets", station("token-1"))).status, 404);
  EXPECT_EQ(ask(request("GET", "/api/v1/secrets", station("token-x"))).status, 401);
}

TEST_F(Routes, AnotherMethodIsAnsweredWithThoseThereAre) {
  const auto response = ask(request("POST", "/api/v1/metrics", station("token-1")));
  EXPECT_EQ(response.status, 405);
  EXPECT_EQ(response.header("Allow"), "GET");
}

TEST_F(Routes, ArgumentsAreCheckedAgainstTheirDeclaration) {
  const std::map<std::string, std::string> own{{"cookie", cookie()}};
  for (const char* bad : {"limit=0", "limit=201", "limit=x", "limit=", "limit=1.5", "colour=red",
                          "limit=99999999999999999999", "sort=colour"})
    EXPECT_EQ(ask(request("GET", std::string("/api/v1/trials?") + bad, own)).status, 400) << bad;
  EXPECT_EQ(ask(request("GET", "/api/v1/trials?limit=200", own)).status, 200);
  const auto unknown = json(ask(request("GET", "/api/v1/trials?colour=red", own)));
  EXPECT_EQ(unknown["error"],
            "colour: this parameter is unknown; allowed: search, sort, order, cursor, limit, "
            "answer, state");
  const std::string signals = "/api/v1/trials/" + std::string(32, 'a') + "/signals?";
  for (const char* bad : {"from_s=nan", "from_s=inf", "to_s=-1", "points=0"})
    EXPECT_EQ(ask(request("GET", signals + bad, own)).status, 400) << bad;
}

TEST_F(Routes, HaveNamesOfTheirOwn) {
  std::set<std::string> ids, schemas, addresses;
  for (const RouteInfo& route : routes()) {
    EXPECT_TRUE(ids.insert(route.id).second) << route.id;
    EXPECT_TRUE(addresses.insert(route.method + route.path).second) << route.path;
    EXPECT_TRUE(route.path.starts_with("/api/")) << route.path;
    EXPECT_FALSE(route.summary.empty()) << route.path;
    EXPECT_NE(route.handle, nullptr) << route.path;
    EXPECT_EQ(route.who.empty(), route.open) << route.path;
    for (const NamedSchema& named : route.schemas)
      EXPECT_TRUE(schemas.insert(named.name).second) << named.name;
  }
}

TEST_F(Routes, DeclareEveryPlaceholderOfTheirPath) {
  const std::regex placeholder("\\{([^}]+)\\}");
  for (const RouteInfo& route : routes()) {
    std::set<std::string> in_path, declared;
    for (std::sregex_iterator it(route.path.begin(), route.path.end(), placeholder), end; it != end;
         ++it)
      in_path.insert((*it)[1]);
    for (const Parameter& p : route.parameters)
      if (p.in == Parameter::In::path) declared.insert(p.name);
    EXPECT_EQ(in_path, declared) << route.path;
  }
}

void collect_refs(const core::Json& json, std::set<std::string>& out) {
  if (json.is_object() && json.contains("$ref")) out.insert(json["$ref"].get<std::string>());
  if (json.is_structured())
    for (const auto& inner : json) collect_refs(inner, out);
}

TEST_F(Routes, TheDescriptionRefersToNothingItDoesNotHold) {
  const core::Json description = openapi(routes());
  std::set<std::string> refs;
  collect_refs(description, refs);
  EXPECT_GT(refs.size(), 10u);
  for (const std::string& ref : refs) {
    const std::string prefix = "#/components/schemas/";
    ASSERT_TRUE(ref.starts_with(prefix)) << ref;
    EXPECT_TRUE(description["components"]["schemas"].contains(ref.substr(prefix.size()))) << ref;
  }
}

/// Every schema that is a number says its unit, and a name of a quantity with a dimension ends in
/// it.
void check_units(const core::Json& json, const std::string& where) {
  if (!json.is_object()) return;
  const auto type = json.value("type", core::Json());
  if (type == "number" || type == "integer") {
    EXPECT_NE(json.value("x-unit", ""), "")
        << where << " is a number without a unit; a count has the unit \"1\"";
  }
  if (json.contains("properties"))
    for (const auto& [name, field] : json["properties"].items()) {
      const std::string unit = field.is_object() ? field.value("x-unit", "") : "";
      const std::map<std::string, std::string> endings{
          {"s", "_s"}, {"m", "_m"}, {"N", "_N"}, {"us", "_us"}, {"Hz", "_Hz"}, {"B", "_bytes"}};
      if (const auto ending = endings.find(unit); ending != endings.end()) {
        EXPECT_TRUE(name.ends_with(ending->second)) << where << "/" << name;
      }
      check_units(field, where + "/" + name);
    }
  if (json.contains("items")) check_units(json["items"], where + "[]");
  if (json.contains("anyOf"))
    for (const auto& inner : json["anyOf"]) check_units(inner, where);
}

TEST_F(Routes, EveryNumberSaysItsUnitAndItsNameEndsInIt) {
  const core::Json description = openapi(routes());  // kept, since items() refers to it
  for (const auto& [name, schema] : description["components"]["schemas"].items())
    check_units(schema, name);
}

/// The places of a schema that allow any content: a value without a type, an object without
/// members.
void collect_any_content(const core::Json& schema, const std::string& where,
                         std::set<std::string>& out) {
  const bool is_open = schema.is_boolean() || schema.empty() ||
                       (schema.value("type", core::Json()) == "object" &&
                        !schema.contains("properties") && !schema.contains("additionalProperties"));
  if (is_open) out.insert(where);
  if (!schema.is_object()) return;
  if (schema.contains("properties"))
    for (const auto& [name, field] : schema["properties"].items())
      collect_any_content(field, where + "/" + name, out);
  if (const auto more = schema.find("additionalProperties"); more != schema.end() && *more != false)
    collect_any_content(*more, *more == true ? where : where + "/*", out);
  if (schema.contains("items")) collect_any_content(schema["items"], where + "/*", out);
  if (schema.contains("anyOf"))
    for (const auto& inner : schema["anyOf"]) collect_any_content(inner, where, out);
}

TEST_F(Routes, DescribeAllContentButThatOfOthers) {
  const std::map<std::string, std::string> allowed{
      {"AuditRow/detail", "what a caller sent, to any route, also invalid"},
      {"Description", "described by the OpenAPI Specification 3.1"},
      {"TrialEvent/detail", "of a recorded file, whose events another version may have written"}};
  std::set<std::string> expected, found;
  for (const auto& [place, reason] : allowed) expected.insert(place);
  const core::Json description = openapi(routes());
  for (const auto& [name, schema] : description["components"]["schemas"].items())
    collect_any_content(schema, name, found);
  EXPECT_EQ(found, expected);
}

TEST(AnyContent, IsFoundWhereverItStands) {
  // By hand, after JSON Schema 2020-12, 4.3.2 and 10.3.2.3: true, {} and an object that names no member allow anything.
  const core::Json planted = core::Json::parse(R"({"type": "object", "properties": {
      "open": {"type": "object", "additionalProperties": true}, "bare": {"type": "object"},
      "closed": {"type": "object", "additionalProperties": false}, "text": {"type": "string"},
      "list": {"type": "array", "items": {}}, "map": {"type": "object", "additionalProperties": {"type": "number"}},
      "either": {"anyOf": [{"type": "null"}, {"type": "object", "additionalProperties": true}]}},
      "additionalProperties": false})");
  std::set<std::string> found;
  collect_any_content(planted, "S", found);
  EXPECT_EQ(found, (std::set<std::string>{"S/open", "S/bare", "S/list/*", "S/either"}));
}

/// The files that the program itself writes keep to what the API says of them.
TEST_F(Routes, DescribeTheFilesThatTheProgramWrites) {
  test_support::Described described(openapi(routes()));
  for (int kind = 0; kind < scenarios::kKinds; ++kind) {
    core::Json scenario = scenarios::tuned(scenarios::Kind(kind)).value().to_json();
    EXPECT_EQ(described.deviations("ScenarioFile", scenario), "");
    EXPECT_EQ(described.deviations("ScenarioOrTuned", scenario), "");
    scenario.erase("origin");
    EXPECT_EQ(described.deviations("ScenarioDraft", scenario), "");
    EXPECT_NE(described.deviations("ScenarioFile", scenario), "") << "an origin is missing";
    scenario["bone"]["stiffness_N_per_m"] = "hard";
    EXPECT_NE(described.deviations("ScenarioDraft", scenario), "") << "a text for a number";
  }
  EXPECT_EQ(described.deviations("ModelFile", models::PalpationModel{}.to_json()), "");
  EXPECT_EQ(described.deviations("ModelFile", models::ProbingModel{}.to_json()), "");
  EXPECT_EQ(described.deviations("PlanFile", assessment::example_plan()), "");
  EXPECT_EQ(described.deviations("CriteriaFile", assessment::Criteria::usual().to_json()), "");
  const trial::MotionProgram program{.name = "strokes", .words = "slow", .moves = {{}}};
  EXPECT_EQ(described.deviations("MotionProgram", program.to_json()), "");
  core::Json certificate = cases::Certificate{}.to_json();
  EXPECT_EQ(described.deviations("CaseCertificate", certificate), "");
}

}  // namespace
}  // namespace api
}  // namespace tractus
