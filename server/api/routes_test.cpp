/// What every route of the catalogue must be; generated from the catalogue.
#include <regex>
#include <set>

#include "server/api/api_test_support.hpp"
#include "server/api/openapi.hpp"

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
  EXPECT_EQ(open,
            (std::vector<std::string>{"GET /api/v1/session/oidc", "GET /api/v1/session/oidc/start",
                                      "GET /api/v1/session/oidc/callback",
                                      "GET /api/v1/session/oidc/end", "GET /api/v1/health",
                                      "POST /api/v1/session", "POST /api/v1/stations/enrol"}));
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
  for (const auto& [name, schema] : openapi(routes())["components"]["schemas"].items())
    check_units(schema, name);
}

}  // namespace
}  // namespace api
}  // namespace tractus
