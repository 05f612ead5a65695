/// Launches by a learning platform: a good one, and every way in which one may be bad.
#include "server/api/learning/launch.hpp"

#include <functional>

#include "server/api/learning/lti_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::encoded;
using testing::kUtc_s;
using testing::LtiTest;
using Mood = testing::Provider::Mood;

class Launches : public LtiTest {
 protected:
  /// The name of the account in which a launch ended; empty: in none.
  std::string signed_in(const http::Response& sent) {
    const std::string set(sent.header("Set-Cookie"));
    if (set.empty()) return "";
    return json(ask(request("GET", "/api/v1/session", {{"cookie", set.substr(0, set.find(';'))}})))
        .value("name", "");
  }
  /// Another launch than a good one opens nothing, and the good one still works.
  void expect_refused(const Json& patch, const std::string& where_to = "/?sign_in=launch_failed") {
    const auto sent = launch(patch);
    EXPECT_EQ(where(sent), where_to) << patch.dump();
    EXPECT_EQ(signed_in(sent), "") << patch.dump();
  }
};

TEST_F(Launches, OpenTheAssignmentInAnOrdinarySessionOfTheLinkedAccount) {
  link(register_platform(), "tom", "person-7");
  const auto sent = launch();
  EXPECT_EQ(where(sent), "/assignments/a-tom");
  const std::string set(sent.header("Set-Cookie"));
  EXPECT_TRUE(set.starts_with("tractus_session=")) << set;
  EXPECT_NE(set.find("; HttpOnly; SameSite=Strict;"), std::string::npos) << set;
  const auto who =
      json(ask(request("GET", "/api/v1/session", {{"cookie", set.substr(0, set.find(';'))}})));
  EXPECT_EQ(who["name"], "tom");
  EXPECT_EQ(who["role"], "trainee") << "the platform calls the person an administrator";
  const auto row = json(get("ann", "/audit?limit=1"))["rows"][0];
  EXPECT_EQ(row["what"], "ltiLaunch");
  EXPECT_EQ(row["who"], "tom");
  EXPECT_EQ(where(launch({{"https://purl.imsglobal.org/spec/lti/claim/custom", nullptr}})), "/");
}

TEST_F(Launches, KeepAnAttemptInACookieThatAnotherSitesFormSends) {
  register_platform();
  const auto sent = ask(request("POST", "/api/v1/lti/login", {},
                                "iss=" + percent_encoded(platform_.issuer) + "&login_hint=a%20b"));
  EXPECT_EQ(sent.status, 303);
  const std::string to(sent.header("Location")), set(sent.header("Set-Cookie"));
  for (const char* part :
       {"response_mode=form_post", "prompt=none", "login_hint=a%20b",
        "redirect_uri=https%3A%2F%2Ftractus.example.org%2Fapi%2Fv1%2Flti%2Flaunch"})
    EXPECT_NE(to.find(part), std::string::npos) << part << " in " << to;
  EXPECT_NE(set.find("; Path=/api/v1/lti; HttpOnly; SameSite=None; Secure;"), std::string::npos);
  const auto unknown = ask(request("GET", "/api/v1/lti/login?iss=https%3A%2F%2Felsewhere"));
  EXPECT_EQ(where(unknown), "/?sign_in=launch_failed");
}

TEST_F(Launches, AreUsedOnce) {
  link(register_platform(), "tom", "person-7");
  const Begun begun = begin();
  const std::string token = platform_.token(claims(begun));
  EXPECT_EQ(signed_in(post_launch(begun, token)), "tom");
  const auto again = post_launch(begun, token);
  EXPECT_EQ(where(again), "/?sign_in=launch_failed");
  EXPECT_EQ(signed_in(again), "");
  now_ += 11ll * 60 * 1'000'000;  // the nonce is forgotten; now the state is too old
  EXPECT_EQ(where(post_launch(begun, token)), "/?sign_in=launch_failed");
}

TEST_F(Launches, OfAnotherIssuerClientDeploymentTimeOrKindAreRefused) {
  link(register_platform(), "tom", "person-7");
  const std::string lti = "https://purl.imsglobal.org/spec/lti/claim/";
  for (const Json& patch : std::vector<Json>{{{"iss", "https://elsewhere"}},
                                             {{"aud", "another"}},
                                             {{"aud", {"tractus", "another"}}},  // without azp
                                             {{"azp", "another"}},
                                             {{lti + "deployment_id", "d-2"}},
                                             {{lti + "deployment_id", nullptr}},
                                             {{"exp", kUtc_s - 61}},
                                             {{"iat", kUtc_s - 601}},
                                             {{"iat", kUtc_s + 61}},
                                             {{"nonce", "another"}},
                                             {{"sub", nullptr}},
                                             {{lti + "message_type", "LtiDeepLinkingRequest"}},
                                             {{lti + "version", "1.1.0"}}})
    expect_refused(patch);
  expect_refused({{lti + "custom", {{"assignment", "none"}}}}, "/?sign_in=launch_assignment");
  EXPECT_EQ(signed_in(launch()), "tom");
}

TEST_F(Launches, WithoutTheSignatureOfThePlatformAreRefused) {
  link(register_platform(), "tom", "person-7");
  const Begun begun = begin();
  const testing::Signer stranger;
  const std::string none = encoded(R"({"alg":"none"})") + "." + encoded(claims(begun).dump()) + ".";
  std::string cut = platform_.token(claims(begun));
  cut.resize(cut.rfind('.') + 1);
  for (const std::string& token : {none, cut, stranger.token(claims(begun)), std::string("x"),
                                   std::string(), std::string(20'000, 'a')})
    EXPECT_EQ(where(post_launch(begun, token)), "/?sign_in=launch_failed") << token;
  EXPECT_EQ(signed_in(post_launch(begun, platform_.token(claims(begun)))), "tom")
      << "what was refused did not use the launch up";
}

TEST_F(Launches, OfAnotherBrowserOrStateAreRefused) {
  link(register_platform(), "tom", "person-7");
  const Begun mine = begin(), others = begin();
  ASSERT_NE(mine.cookie, others.cookie);
  const std::string token = platform_.token(claims(mine));
  EXPECT_EQ(where(post_launch({mine.state, "", others.cookie}, token)), "/?sign_in=launch_failed");
  EXPECT_EQ(where(post_launch({mine.state, "", ""}, token)), "/?sign_in=launch_window");
  EXPECT_EQ(where(post_launch({others.state, "", others.cookie}, token)),
            "/?sign_in=launch_failed");
  for (const std::string& state :
       {std::string("x"), std::string(), backend_.secrets.sealed("{\"state\":\"of OIDC\"}")})
    EXPECT_EQ(where(post_launch({state, "", mine.cookie}, token)), "/?sign_in=launch_failed");
  now_ += 601ll * 1'000'000;
  EXPECT_EQ(where(post_launch(mine, token)), "/?sign_in=launch_failed");
}

TEST_F(Launches, FetchAKeySetAnewOnceForAKeyThatItLacks) {
  link(register_platform(), "tom", "person-7");
  EXPECT_EQ(signed_in(launch()), "tom");
  EXPECT_EQ(signed_in(launch()), "tom");
  EXPECT_EQ(platform_.asked("/keys"), 1);
  clock_s_ += 11;
  platform_.uses("k2");  // the platform changed its key
  EXPECT_EQ(signed_in(launch()), "tom");
  EXPECT_EQ(platform_.asked("/keys"), 2);
  clock_s_ += 11;
  const testing::Signer stranger;
  for (int i = 0; i < 20; ++i) {
    const Begun begun = begin();
    const std::string token =
        stranger.token(claims(begun), {{"alg", "RS256"}, {"kid", "key" + std::to_string(i)}});
    EXPECT_EQ(where(post_launch(begun, token)), "/?sign_in=launch_failed");
  }
  EXPECT_EQ(platform_.asked("/keys"), 3) << "unknown keys do not make the server ask in a loop";
}

TEST_F(Launches, OfAPlatformThatHangsEndSoonAndKeepNoOtherPlatformOut) {
  testing::Provider other;
  link(register_platform(), "tom", "person-7");
  register_platform({{"issuer", "https://other.example.org"},
                     {"authorization_url", platform_.issuer + "/authorize"},
                     {"keys_url", other.issuer + "/keys"}});
  other.is(Mood::hangs);
  const auto id = json(get("ann", "/lti/platforms"))["platforms"][1];
  ASSERT_EQ(id["issuer"], "https://other.example.org");
  const auto begun_at = std::chrono::steady_clock::now();
  for (int i = 0; i < 3; ++i) {
    const auto sent = ask(request("GET", "/api/v1/lti/login?iss=https%3A%2F%2Fother.example.org"));
    http::RequestHead to;
    ASSERT_TRUE(http::read_target(
        std::string(sent.header("Location")).substr(platform_.issuer.size()), to));
    const std::string set(sent.header("Set-Cookie"));
    const Begun begun{to.query["state"], to.query["nonce"], set.substr(0, set.find(';'))};
    Json said = claims(begun);
    said["iss"] = "https://other.example.org";
    EXPECT_EQ(where(post_launch(begun, other.token(said))), "/?sign_in=launch_failed");
    EXPECT_EQ(signed_in(launch()), "tom") << "the first platform works";
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun_at, std::chrono::seconds(3));
  EXPECT_EQ(other.asked("/keys"), 1) << "it is left alone after a failure";
  other.is(Mood::works);
}

TEST_F(Launches, OfAPersonWhomNobodyLinkedAreRefusedAndNotedForTheAdministrator) {
  const std::string platform = register_platform();
  expect_refused(Json::object(), "/?sign_in=launch_unknown");
  const auto row = json(get("ann", "/audit?limit=1"))["rows"][0];
  EXPECT_EQ(row["what"], "refused: ltiLaunch");
  EXPECT_EQ(row["detail"]["subject"], "person-7");
  link(platform, "tom", "person-7");
  EXPECT_EQ(signed_in(launch()), "tom");
  EXPECT_EQ(post("ann", "/lti/platforms/" + platform + "/people",
                 {{"account", "tia"}, {"subject", "person-7"}})
                .status,
            409);
  link(platform, "tom", "");
  expect_refused(Json::object(), "/?sign_in=launch_unknown");
}

TEST_F(Launches, FindATraineeByAVerifiedAddressWhereTheRegistrationAllowsThat) {
  const auto has_address = [&](const char* who, const char* address) {
    EXPECT_EQ(
        post(who, "/session/notifications", {{"address", address}, {"choices", Json::array()}})
            .status,
        200);
  };
  has_address("tom", "Tom@example.org");
  has_address("fay", "fay@example.org");
  const Json verified{{"email", "tom@example.org"}, {"email_verified", true}};
  const std::string strict = register_platform();
  expect_refused(verified, "/?sign_in=launch_unknown");
  EXPECT_EQ(ask(request("DELETE", "/api/v1/lti/platforms/" + strict, as("ann"))).status, 204);
  register_platform({{"match_email", true}});
  expect_refused({{"email", "tom@example.org"}}, "/?sign_in=launch_unknown");
  expect_refused({{"email", "tom@example.org"}, {"email_verified", "true"}},
                 "/?sign_in=launch_unknown");
  expect_refused({{"email", "fay@example.org"}, {"email_verified", true}},
                 "/?sign_in=launch_unknown");
  has_address("tia", "tom@example.org");
  expect_refused(verified, "/?sign_in=launch_unknown");  // two have it
  has_address("tia", "tia@example.org");
  EXPECT_EQ(signed_in(launch(verified)), "tom");
  EXPECT_EQ(signed_in(launch()), "tom") << "linked from now on";
  Json another = verified;
  another["sub"] = "person-8";
  expect_refused(another, "/?sign_in=launch_unknown");
}

TEST_F(Launches, OpenNoAccountOfAnAdministratorWithOneTimeCodesOrDisabled) {
  const std::string platform = register_platform();
  link(platform, "ann", "person-7");
  expect_refused(Json::object(), "/?sign_in=launch_here");
  link(platform, "ann", "");
  link(platform, "tom", "person-7");
  const auto set = [&](const std::function<void(store::Account&)>& change) {
    ASSERT_TRUE(store_.write([&](store::Writing& tx) -> core::Result<void> {
      auto account = TRY(store::account_of(tx, "tom"));
      change(*account);
      return store::set_account(tx, *account);
    }));
  };
  set([](store::Account& tom) { tom.totp_confirmed = true; });
  expect_refused(Json::object(), "/?sign_in=launch_here");
  set([](store::Account& tom) {
    tom.totp_confirmed = false;
    tom.state = store::AccountState::disabled;
  });
  expect_refused(Json::object(), "/?sign_in=launch_unknown");
}

TEST_F(Launches, ComeOfPlatformsThatAnAdministratorRegisteredAlone) {
  EXPECT_EQ(post("fay", "/lti/platforms", registration()).status, 403);
  for (const auto& [field, value] : std::vector<std::pair<const char*, Json>>{
           {"token_url", "http://lms.example.org/token"},
           {"keys_url", "ftp://lms.example.org"},
           {"keys_url", "https://user@lms.example.org/keys"},
           {"authorization_url", "https://lms.example.org/a b"},
           {"deployments", Json::array()},
           {"deployments", {1}},
           {"match_email", "yes"},
           {"issuer", ""}}) {
    Json wish = registration();
    wish[field] = value;
    EXPECT_EQ(post("ann", "/lti/platforms", wish).status, 400) << field << value;
  }
  const std::string id = register_platform();
  EXPECT_EQ(post("ann", "/lti/platforms", registration()).status, 409);
  const auto list = json(get("ann", "/lti/platforms"));
  EXPECT_EQ(list["launch_url"], "https://tractus.example.org/api/v1/lti/launch");
  EXPECT_EQ(list["platforms"][0]["id"], id);
  link(id, "tom", "person-7");
  EXPECT_EQ(ask(request("DELETE", "/api/v1/lti/platforms/" + id, as("ann"))).status, 204);
  EXPECT_EQ(ask(request("DELETE", "/api/v1/lti/platforms/" + id, as("ann"))).status, 404);
  register_platform();
  expect_refused(Json::object(), "/?sign_in=launch_unknown");  // its people went with it
}

TEST_F(Launches, ShowAPublicKeyAlone) {
  const auto keys = json(ask(request("GET", "/api/v1/lti/keys")))["keys"];
  ASSERT_EQ(keys.size(), 1u);
  EXPECT_EQ(keys[0]["kty"], "RSA");
  EXPECT_FALSE(keys[0].contains("d")) << "the private exponent";
  EXPECT_EQ(json(ask(request("GET", "/api/v1/lti/keys")))["keys"], keys) << "made once";
}

}  // namespace
}  // namespace api
}  // namespace tractus
