#include "server/api/people/authentication.hpp"

#include "server/api/api_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using testing::ApiTest;
using testing::kPassword;

class SigningIn : public ApiTest {
 protected:
  int who_am_i(const std::string& cookie) {
    return ask(request("GET", "/api/v1/session", {{"cookie", cookie}})).status;
  }
};

constexpr std::int64_t kMinute_us = 60'000'000;

TEST_F(SigningIn, SetsACookieThatScriptsAndOtherSitesDoNotGet) {
  const auto in = sign_in_as("ada", kPassword);
  ASSERT_EQ(in.status, 200) << text(in);
  EXPECT_EQ(json(in), (core::Json{{"name", "ada"},
                                  {"role", "admin"},
                                  {"id", "1"},
                                  {"must_change", false},
                                  {"language", nullptr}}));
  const std::string_view set = in.header("Set-Cookie");
  EXPECT_NE(set.find("; HttpOnly"), std::string::npos);
  EXPECT_NE(set.find("; SameSite=Strict"), std::string::npos);
}

TEST_F(SigningIn, AWrongPasswordAndAnUnknownNameAreAnsweredAlike) {
  const auto wrong = sign_in_as("ada", "incorrect horse"), unknown = sign_in_as("eve", kPassword);
  EXPECT_EQ(wrong.status, 401);
  EXPECT_EQ(unknown.status, 401);
  EXPECT_EQ(text(wrong), text(unknown));
}

TEST_F(SigningIn, TheTokenIsNotInTheDatabase) {
  const std::string token = cookie().substr(std::string(kSessionCookie).size() + 1);
  ASSERT_EQ(token.size(), 64u);
  auto rows =
      store_.read([](store::Reading& tx) { return tx.query("select token_hash from sessions"); });
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 1u);
  EXPECT_NE(rows->front().text(0), token);
  EXPECT_EQ(rows->front().text(0), core::sha256(core::bytes_of(token)));
}

TEST_F(SigningIn, ASessionEndsWhenItIsIdleAndWhenItIsOld) {
  const std::string idle = cookie();
  now_ += kSessionIdle_us + 1;
  EXPECT_EQ(who_am_i(idle), 401);
  const std::string busy = cookie();
  for (std::int64_t age = 0; age + kSessionIdle_us / 2 <= kSessionAge_us;
       age += kSessionIdle_us / 2) {
    EXPECT_EQ(who_am_i(busy), 200) << age;
    now_ += kSessionIdle_us / 2;
  }
  now_ += kMinute_us;
  EXPECT_EQ(who_am_i(busy), 401);
}

TEST_F(SigningIn, IsThrottledAfterTenFailuresFromOneAddress) {
  for (int i = 0; i < 10; ++i) EXPECT_EQ(sign_in_as("ada", "guess").status, 401) << i;
  const auto throttled = sign_in_as("ada", kPassword);
  EXPECT_EQ(throttled.status, 429);
  EXPECT_EQ(json(throttled)["code"], "too_many");
  EXPECT_EQ(sign_in_as("eve", "guess").status, 401) << "others are not";
}

TEST_F(SigningIn, RubbishIsRefusedByField) {
  const auto post = [&](const std::string& body) {
    return ask(request("POST", "/api/v1/session", {{"content-type", "application/json"}}, body));
  };
  for (const char* bad : {"", "{", "[]", "{\"name\":\"ada\"}", "{\"name\":1,\"password\":\"x\"}",
                          "{\"name\":\"a\",\"password\":\"b\",\"more\":1}"})
    EXPECT_EQ(post(bad).status, 400) << bad;
  EXPECT_EQ(post(core::Json{{"name", "ada"}, {"password", std::string(1025, 'x')}}.dump()).status,
            400);
  EXPECT_EQ(post(std::string(8193, ' ')).status, 413);
}

TEST_F(SigningIn, AFormOfAnotherSiteCannotSignIn) {
  const std::string body = core::Json{{"name", "ada"}, {"password", kPassword}}.dump();
  EXPECT_EQ(ask(request("POST", "/api/v1/session", {{"content-type", "text/plain"}}, body)).status,
            403);
}

}  // namespace
}  // namespace api
}  // namespace tractus
