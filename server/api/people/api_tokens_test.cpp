/// Personal API tokens: the matrix of scopes, and the life of a token.
#include <cstdio>
#include <regex>
#include <set>

#include "core/try.hpp"
#include "server/api/access.hpp"
#include "server/api/people/people_test_support.hpp"
#include "server/api/people/token_scopes.hpp"

namespace tractus {
namespace api {
namespace {
using testing::kCase;
using testing::kPassword;
using testing::PeopleTest;

constexpr std::int64_t kTokenHour_us = 3600ll * 1'000'000, kTokenDay_us = 24 * kTokenHour_us;
constexpr auto kScopes = core::values<TokenScope>();
using Headers = std::map<std::string, std::string>;

class ApiTokens : public PeopleTest {
 protected:
  void set_scopes(const std::string& account, const std::string& scopes) {
    ASSERT_TRUE(store_.write([&](store::Writing& tx) {
      return tx.query("update api_tokens set scopes = ? where id = ?", {scopes, "t-" + account});
    }));
  }
  http::Response with_token(const std::string& account, const std::string& method,
                            const std::string& path, const std::string& body = "") {
    return ask(request(method, "/api/v1" + path, by_token(account), body));
  }
  core::Json wish(const core::Json& scopes = {"lab:read"}) {
    return {{"name", "nightly export"},
            {"scopes", scopes},
            {"expires_utc_us", now_ + 30 * kTokenDay_us},
            {"password", kPassword}};
  }
  /// A token of the account, made by its route.
  std::string made(const std::string& account, const core::Json& wish) {
    const auto response = post(account, "/tokens", wish);
    EXPECT_EQ(response.status, 201) << text(response);
    return json(response).value("token", "");
  }
  int status_with(const std::string& token, const std::string& path = "/session") {
    return ask(request("GET", "/api/v1" + path, {{"authorization", "Bearer " + token}})).status;
  }
};

/// An account whose role may call the route: then only the scope can refuse.
std::string holder(const RouteInfo& route) {
  const std::vector<std::pair<Role, std::string>> people{
      {Role::admin, "ann"},      {Role::director, "dora"},  {Role::faculty, "fay"},
      {Role::researcher, "rex"}, {Role::technician, "ted"}, {Role::trainee, "tom"}};
  for (const auto& [role, account] : people)
    if (std::ranges::count(route.who, role, &Grant::role) > 0) return account;
  return "ann";
}

std::string token_address(const RouteInfo& route) {
  return std::regex_replace(route.path, std::regex("\\{[^}]+\\}"), "none");
}

TEST_F(ApiTokens, EveryCellOfScopesTimesRoutesIsAsTheTableSays) {
  int cells = 0, allowed = 0;
  for (const TokenScope scope : kScopes) {
    for (const char* account : {"ann", "dora", "fay", "rex", "ted", "tom"})
      set_scopes(account, std::string(name(scope)));
    for (const RouteInfo& route : routes()) {
      if (route.open) continue;
      ++cells;
      const std::string account = holder(route),
                        cell = route.id + " by " + std::string(name(scope));
      const auto answer = ask(request(route.method, token_address(route), by_token(account)));
      const auto stated = scopes_of(route);
      const bool only_stations = !granted(route, Role::admin) && account == "ann";
      if (only_stations || std::ranges::count(stated, scope) == 0) {
        EXPECT_EQ(answer.status, 403) << cell << ": " << text(answer);
        continue;
      }
      ++allowed;
      EXPECT_NE(answer.status, 401) << cell;
      const std::string refused = answer.status == 403 ? text(answer) : "";
      EXPECT_EQ(refused.find("API token"), std::string::npos) << cell << ": " << refused;
      EXPECT_EQ(refused.find("not allowed for the role"), std::string::npos) << cell;
    }
  }
  std::printf("cells of routes x scopes: %d, of which allowed: %d\n", cells, allowed);
  EXPECT_GT(cells, 2000);
}

TEST_F(ApiTokens, ARouteWithoutAScopeAndARouteThatIsNewAreRefused) {
  std::vector<RouteInfo> table{
      {.method = "GET",
       .path = "/api/v1/new",
       .id = "newRoute",
       .summary = "",
       .who = {Role::admin},
       .parameters = {},
       .body = "",
       .answer = "",
       .schemas = {},
       .handle = [](const Call&) -> core::Result<http::Response> { return http::Response{}; }}};
  const auto refused = answer(backend_, table, request("GET", "/api/v1/new", by_token("ann")));
  EXPECT_EQ(refused.status, 403);
  EXPECT_NE(text(refused).find("cannot be called with an API token"), std::string::npos);
  EXPECT_EQ(answer(backend_, table, request("GET", "/api/v1/new", as("ann"))).status, 200);
}

TEST_F(ApiTokens, TheTableNamesRoutesThatExist) {
  std::set<std::string_view> known;
  for (const RouteInfo& route : routes()) known.insert(route.id);
  for (const std::string_view id : routes_of_scopes()) EXPECT_TRUE(known.contains(id)) << id;
}

/// By hand: what a token may never do, whatever the table says.
TEST_F(ApiTokens, SigningInAccountsTokensConsentAndTheAuditTrailAreInNoScope) {
  const std::regex never(
      "/api/v1/(session/.*|accounts.*|tokens.*|audit.*|consent.*|export/key.csv|live|station/.*|"
      "uploads.*|work/.*|stations/enrol|notifications.*)");
  for (const RouteInfo& route : routes())
    if (std::regex_match(route.path, never) || route.open ||
        (route.path == "/api/v1/session" && route.method != "GET")) {
      EXPECT_TRUE(scopes_of(route).empty()) << route.id;
    }
}

TEST_F(ApiTokens, AScopeThatReadsHasOnlyRoutesThatRead) {
  for (const RouteInfo& route : routes())
    for (const TokenScope scope : scopes_of(route))
      if (name(scope).ends_with(":read")) {
        EXPECT_EQ(route.method, "GET") << route.id;
      }
}

TEST_F(ApiTokens, AreShownOnceAndStoredAsAHash) {
  const std::string token = made("rex", wish());
  EXPECT_TRUE(token.starts_with("tractus_"));
  EXPECT_EQ(token.size(), 8u + 64u);  // 32 random bytes as hexadecimal digits
  EXPECT_EQ(status_with(token), 200);
  EXPECT_EQ(text(get("rex", "/tokens")).find(token.substr(8)), std::string::npos);
  const auto rows =
      store_.read([](store::Reading& tx) { return tx.query("select token_hash from api_tokens"); });
  ASSERT_TRUE(rows);
  for (const auto& row : *rows) EXPECT_NE(row.text(0), token);
  // A hash that somebody reads in the database is no token.
  for (const auto& row : *rows) EXPECT_EQ(status_with(row.text(0)), 401);
}

TEST_F(ApiTokens, AreMadeOnlyWithThePasswordAndSensibleFields) {
  const auto status = [&](const char* field, const core::Json& value) {
    core::Json body = wish();
    body[field] = value;
    return post("rex", "/tokens", body).status;
  };
  EXPECT_EQ(status("password", "a wrong password"), 403);
  EXPECT_EQ(status("expires_utc_us", now_ + 367 * kTokenDay_us), 400);
  EXPECT_EQ(status("expires_utc_us", now_), 400);
  EXPECT_EQ(status("scopes", core::Json::array()), 400);
  EXPECT_EQ(status("scopes", {"everything"}), 400);
  EXPECT_EQ(status("scopes", {"lab:read", "lab:read"}), 400);
  EXPECT_EQ(status("scopes", "lab:read"), 400);
  EXPECT_EQ(status("name", "  "), 400);
  EXPECT_EQ(status("name", "a\nb"), 400);
  EXPECT_EQ(status("name", std::string(65, 'x')), 400);
  EXPECT_EQ(status("extra", 1), 400);
  EXPECT_EQ(post("tom", "/tokens", wish({"lab:run"})).status, 400) << "no trainee runs the lab";
  EXPECT_EQ(json(get("rex", "/tokens"))["tokens"].size(), 1u) << "nothing was made";
  EXPECT_EQ(status("name", "good"), 201);
}

TEST_F(ApiTokens, AreLimitedInNumber) {
  for (std::int64_t i = 1; i < store::kMaxApiTokens; ++i) made("rex", wish());
  EXPECT_EQ(post("rex", "/tokens", wish()).status, 409);
  now_ += 31 * kTokenDay_us;  // all but the first have expired
  made("rex", wish());
}

TEST_F(ApiTokens, NeedTheOneTimeCodeOfAnAccountThatHasThem) {
  ASSERT_TRUE(store_.write([&](store::Writing& tx) {
    return tx.query("update accounts set totp_secret = ?, totp_confirmed = 1 where id = 'rex'",
                    {backend_.secrets.sealed("12345678901234567890")});
  }));
  const auto without = post("rex", "/tokens", wish());
  EXPECT_EQ(without.status, 403);
  EXPECT_EQ(json(without)["code"], "code_needed");
  now_ = 59'000'000;  // RFC 6238, appendix B: the last six digits of 94287082
  core::Json body = wish();
  body["code"] = "000000";
  EXPECT_EQ(post("rex", "/tokens", body).status, 403);
  body["code"] = "287082";
  EXPECT_EQ(post("rex", "/tokens", body).status, 201);
  EXPECT_EQ(post("rex", "/tokens", body).status, 403) << "the same code twice";
}

TEST_F(ApiTokens, EndAtTheirDate) {
  const std::string token = made("rex", wish());
  now_ += 30 * kTokenDay_us - 1;
  EXPECT_EQ(status_with(token), 200);
  now_ += 1;
  EXPECT_EQ(status_with(token), 401);
}

TEST_F(ApiTokens, AreRevokedByTheirOwnerAndByAdministratorsAlone) {
  const auto revoke = [&](const char* who, const char* id) {
    return ask(request("DELETE", std::string("/api/v1/tokens/") + id, as(who))).status;
  };
  EXPECT_EQ(revoke("tia", "t-tom"), 404);
  EXPECT_EQ(revoke("dora", "t-tom"), 404);
  EXPECT_EQ(with_token("tom", "DELETE", "/tokens/t-tom").status, 403) << "not by a token";
  EXPECT_EQ(status_with("tractus_tom"), 200);
  EXPECT_EQ(revoke("tom", "t-tom"), 204);
  EXPECT_EQ(status_with("tractus_tom"), 401);
  EXPECT_EQ(revoke("ann", "t-tia"), 204);
  EXPECT_EQ(status_with("tractus_tia"), 401);
  EXPECT_EQ(json(get("tia", "/tokens"))["tokens"][0]["revoked_by"], "ann");
  EXPECT_EQ(revoke("ann", "t-none"), 404);
}

TEST_F(ApiTokens, EndWithTheAccountAndWithAResetPassword) {
  EXPECT_EQ(post("ann", "/accounts/tom/state", {{"state", "disabled"}}).status, 200);
  EXPECT_EQ(status_with("tractus_tom"), 401);
  EXPECT_EQ(post("ann", "/accounts/tom/state", {{"state", "active"}}).status, 200);
  EXPECT_EQ(status_with("tractus_tom"), 401) << "an account that returns needs a new token";
  EXPECT_EQ(post("ann", "/accounts/tia/password").status, 200);
  EXPECT_EQ(status_with("tractus_tia"), 401);
  EXPECT_EQ(json(get("ann", "/accounts/tokens"))["tokens"].size(), 6u);  // of eight
}

TEST_F(ApiTokens, LoseWithTheRoleWhatTheNewRoleDoesNotAllow) {
  EXPECT_EQ(with_token("rex", "GET", "/lab/models").status, 200);
  EXPECT_EQ(post("ann", "/accounts/rex/role", {{"role", "trainee"}}).status, 200);
  EXPECT_EQ(with_token("rex", "GET", "/lab/models").status, 403);
  EXPECT_EQ(with_token("rex", "GET", "/trials").status, 200);
  EXPECT_EQ(post("ann", "/accounts/rex/role", {{"role", "researcher"}}).status, 200);
  EXPECT_EQ(with_token("rex", "GET", "/lab/models").status, 403) << "the scope has ended";
  set_scopes("fay", "cases:write");
  EXPECT_EQ(
      post("ann", "/accounts/change", {{"accounts", {{{"id", "fay"}}}}, {"role", "technician"}})
          .status,
      200);
  EXPECT_EQ(status_with("tractus_fay", "/session"), 401) << "no scope remains";
}

TEST_F(ApiTokens, SeeNoMoreThanTheirOwner) {
  EXPECT_EQ(with_token("tom", "GET", "/trials/" + trial_of("tom") + "/comments").status, 200);
  EXPECT_EQ(with_token("tom", "GET", "/trials/" + trial_of("tia") + "/comments").status, 404);
  EXPECT_EQ(json(with_token("tom", "GET", "/trials"))["trials"].size(), 1u);
  EXPECT_EQ(with_token("tom", "GET", "/export/trials.csv").status, 403);
  ASSERT_TRUE(store_.write([](store::Writing& tx) {
    return tx.query("update accounts set must_change = 1 where id = 'tom'");
  }));
  EXPECT_EQ(with_token("tom", "GET", "/trials").status, 403) << "a password is to be chosen first";
}

TEST_F(ApiTokens, NeedNoHeaderAgainstForgeryAndNoCookieBesideThem) {
  const std::string comment = core::Json{{"text", "seen by a script"}}.dump();
  const std::string path = "/trials/" + trial_of("tom") + "/comments";
  EXPECT_EQ(with_token("fay", "POST", path, comment).status, 201);
  Headers both = as("fay");
  both.merge(by_token("fay"));
  EXPECT_EQ(ask(request("GET", "/api/v1/trials", both)).status, 400);
}

TEST_F(ApiTokens, UnknownOnesAreThrottledAndValidOnesServed) {
  for (int i = 0; i < 50; ++i) EXPECT_EQ(status_with("tractus_" + std::to_string(i)), 401) << i;
  const auto slowed =
      ask(request("GET", "/api/v1/trials", {{"authorization", "Bearer tractus_x"}}));
  EXPECT_EQ(slowed.status, 429);
  EXPECT_EQ(slowed.header("Retry-After"), "20");
  EXPECT_EQ(status_with("tractus_rex"), 200);
  auto elsewhere = request("GET", "/api/v1/trials", {{"authorization", "Bearer tractus_x"}});
  elsewhere.peer = "192.0.2.7";
  EXPECT_EQ(ask(elsewhere).status, 401);
  now_ += 21'000'000;
  EXPECT_EQ(status_with("tractus_x"), 401) << "one more after 20 s";
}

TEST_F(ApiTokens, ShowTheirLastUse) {
  const auto used = [&] { return json(get("rex", "/tokens"))["tokens"][0]["used_utc_us"]; };
  EXPECT_TRUE(used().is_null());
  EXPECT_EQ(status_with("tractus_rex"), 200);
  EXPECT_EQ(used(), now_);
}

TEST_F(ApiTokens, AreInTheTrailByTheirIdAndNowhereByThemselves) {
  std::string logged;
  backend_.logs_requests = true;
  backend_.log = [&](const core::Json& fields) { logged += fields.dump(); };
  const std::string token = made("fay", wish({"trials:write", "trials:read"}));
  const Headers headers{{"authorization", "Bearer " + token}};
  const std::string path = "/api/v1/trials/" + trial_of("tom") + "/comments";
  EXPECT_EQ(ask(request("POST", path, headers, R"({"text":"by a script"})")).status, 201);
  EXPECT_EQ(ask(request("GET", "/api/v1/export/key.csv", headers)).status, 403);
  const auto rows =
      store_.read([](store::Reading& tx) { return store::audit_before(tx, 1'000'000, 100); });
  ASSERT_TRUE(rows);
  std::set<std::string> acts;
  const std::string id = json(get("fay", "/tokens"))["tokens"][0]["id"];
  for (const auto& row : *rows) {
    EXPECT_EQ(row.act.detail.find(token.substr(8)), std::string::npos);
    EXPECT_EQ(row.act.detail.find(kPassword), std::string::npos);
    if (row.act.what == "makeApiToken") {
      EXPECT_NE(row.act.detail.find("trials:write"), std::string::npos) << row.act.detail;
    }
    if (row.act.detail.find(id) != std::string::npos) acts.insert(row.act.what);
  }
  EXPECT_EQ(acts, (std::set<std::string>{"addComment", "refused: exportKey"}));
  EXPECT_NE(logged.find("addComment"), std::string::npos);
  EXPECT_EQ(logged.find(token.substr(8)), std::string::npos);
}

}  // namespace
}  // namespace api
}  // namespace tractus
