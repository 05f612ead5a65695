/// Guessing is slowed down; nobody is shut out by what strangers do.
#include "server/api/people/throttle.hpp"

#include "db/store/people/people.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using store::Attempt;
using store::Secret;
using testing::kPassword;
using testing::PeopleTest;

constexpr std::int64_t kSecond_us = 1'000'000;

class Throttle : public PeopleTest {
 protected:
  http::Response sign_in_from(const std::string& peer, const std::string& name,
                              const std::string& password) {
    auto asked = request("POST", "/api/v1/session", {{"content-type", "application/json"}},
                         core::Json{{"name", name}, {"password", password}}.dump());
    asked.peer = peer;
    return ask(asked);
  }
  http::Response badge_at(const std::string& token, const std::string& badge,
                          const std::string& pin) {
    return ask(request("POST", "/api/v1/work/sign-in", station(token),
                       core::Json{{"badge", badge}, {"pin", pin}}.dump()));
  }
  /// Failures without the time that a hash takes.
  void fail(const Attempt& attempt, int times) {
    for (int i = 0; i < times; ++i) ASSERT_TRUE(note_failure(backend_, attempt));
  }
  /// By strangers: ten times from each of so many addresses.
  void hammer(const std::string& name, int addresses) {
    for (int n = 0; n < addresses; ++n)
      fail({Secret::account_password, name, "203.0.113." + std::to_string(n)}, 10);
  }
  static std::int64_t retry_after_s(const http::Response& response) {
    return std::stoll(std::string(response.header("Retry-After")));
  }
};

TEST_F(Throttle, SignInNamesBadgesAndCodesAreCountedApart) {
  ASSERT_EQ(post("ann", "/accounts/tom/badge", {{"badge", "102"}, {"pin", "1234"}}).status, 200);
  for (const char* name : {"badge 102", "102", "station enrolment", ""})
    for (int n = 0; n < 12; ++n)
      fail({Secret::account_password, name, "203.0.113." + std::to_string(n)}, 10);
  EXPECT_EQ(badge_at("token-1", "102", "1234").status, 200);
  const auto enrol =
      ask(request("POST", "/api/v1/stations/enrol", {{"content-type", "application/json"}},
                  core::Json{{"code", "guess"}, {"token_sha256", std::string(64, 'a')}}.dump()));
  EXPECT_EQ(enrol.status, 401) << "judged, not turned away";
}

TEST_F(Throttle, AnOwnerGetsInFromAKnownAddressWhileStrangersHammerTheName) {
  ASSERT_EQ(sign_in_from("10.0.0.1", "rex", kPassword).status, 200);
  const auto session = as("rex");
  hammer("rex", 40);
  EXPECT_EQ(sign_in_from("10.0.0.1", "rex", kPassword).status, 200);
  EXPECT_EQ(ask(request("GET", "/api/v1/session", session)).status, 200);
}

TEST_F(Throttle, ANewAddressHasOneAttemptAtAHammeredNameAndThenOneIn90Seconds) {
  hammer("rex", 40);
  EXPECT_EQ(sign_in_from("198.51.100.7", "rex", "guess").status, 401);
  const auto slowed = sign_in_from("198.51.100.7", "rex", kPassword);
  EXPECT_EQ(slowed.status, 429);
  EXPECT_EQ(retry_after_s(slowed), 90);
  now_ += 89 * kSecond_us;
  hammer("rex", 40);
  EXPECT_EQ(sign_in_from("198.51.100.7", "rex", kPassword).status, 429);
  now_ += 1 * kSecond_us;
  EXPECT_EQ(sign_in_from("198.51.100.7", "rex", kPassword).status, 200);
}

TEST_F(Throttle, RetryAfterSaysWhenAnAttemptIsTakenAgain) {
  const Attempt attempt{Secret::account_password, "rex", "127.0.0.1"};
  fail(attempt, 10);
  const auto throttled = sign_in_as("rex", kPassword);
  ASSERT_EQ(throttled.status, 429);
  EXPECT_EQ(json(throttled)["code"], "too_many");
  const std::int64_t wait_s = retry_after_s(throttled);
  EXPECT_EQ(wait_s, 90);  // ten at once, then one in 90 s
  now_ += (wait_s - 1) * kSecond_us;
  EXPECT_EQ(sign_in_as("rex", kPassword).status, 429);
  now_ += kSecond_us;
  EXPECT_EQ(sign_in_as("rex", "guess").status, 401);
  EXPECT_EQ(sign_in_as("rex", "guess").status, 429) << "one, not ten";
  now_ += 15 * 60 * kSecond_us;
  for (int i = 0; i < 9; ++i) fail(attempt, 1);
  EXPECT_EQ(sign_in_as("rex", kPassword).status, 200) << "the tenth";
}

TEST_F(Throttle, AnAddressThatTriesManyNamesIsSlowedAndNobodyElse) {
  ASSERT_EQ(sign_in_from("203.0.113.9", "fay", kPassword).status, 200);
  for (int n = 0; n < 50; ++n)
    fail({Secret::account_password, "name " + std::to_string(n), "203.0.113.9"}, 1);
  const auto slowed = sign_in_from("203.0.113.9", "rex", kPassword);
  EXPECT_EQ(slowed.status, 429);
  EXPECT_EQ(retry_after_s(slowed), 20);
  EXPECT_EQ(sign_in_from("203.0.113.9", "fay", kPassword).status, 200) << "she is known there";
  EXPECT_EQ(sign_in_from("203.0.113.8", "rex", kPassword).status, 200);
  now_ += 20 * kSecond_us;
  EXPECT_EQ(sign_in_from("203.0.113.9", "rex", kPassword).status, 200);
}

TEST_F(Throttle, WrongPinsAtOneStationSlowTheBadgeThereAndNotWhereItIsKnown) {
  ASSERT_EQ(post("ann", "/accounts/tom/badge", {{"badge", "102"}, {"pin", "1234"}}).status, 200);
  ASSERT_EQ(badge_at("token-2", "102", "1234").status, 200);
  fail({Secret::badge_pin, "102", "s1"}, 4);
  EXPECT_EQ(badge_at("token-1", "102", "0000").status, 401);
  const auto slowed = badge_at("token-1", "102", "1234");
  EXPECT_EQ(slowed.status, 429);
  EXPECT_EQ(retry_after_s(slowed), 180);
  EXPECT_EQ(badge_at("token-2", "102", "1234").status, 200);
  now_ += 180 * kSecond_us;
  EXPECT_EQ(badge_at("token-1", "102", "1234").status, 200);
}

TEST_F(Throttle, GuessingInAStolenSessionSlowsThatSessionAlone) {
  const auto stolen = as("rex"), own = as("rex");
  const auto change = [&](const std::map<std::string, std::string>& session,
                          const std::string& before) {
    return ask(request("POST", "/api/v1/session/password", session,
                       core::Json{{"old", before}, {"new", "a longer password"}}.dump()))
        .status;
  };
  const std::string cookie = stolen.at("cookie");
  const std::string token = cookie.substr(cookie.find('=') + 1);
  fail({Secret::own_password, "rex", token_hash(token)}, 10);
  EXPECT_EQ(change(stolen, kPassword), 429);
  EXPECT_EQ(sign_in_as("rex", kPassword).status, 200);
  EXPECT_EQ(change(own, kPassword), 204);
}

TEST_F(Throttle, AResetLetsTheNameStartAfreshFromEverywhere) {
  ASSERT_EQ(sign_in_from("10.0.0.1", "rex", kPassword).status, 200);
  hammer("rex", 40);
  const auto reset = post("ann", "/accounts/rex/password");
  ASSERT_EQ(reset.status, 200);
  EXPECT_EQ(sign_in_from("203.0.113.3", "rex", "guess").status, 401);
  EXPECT_EQ(sign_in_from("203.0.113.3", "rex", json(reset)["password"]).status, 200);
  const bool known =
      store_
          .read([](store::Reading& tx) {
            return store::is_known_origin(tx, {Secret::account_password, "rex", "10.0.0.1"});
          })
          .value();
  EXPECT_FALSE(known) << "whoever knew the old password may have been there";
}

TEST_F(Throttle, OnlyWhoIsKnownHasTheWholeQueueOfTheHashingLane) {
  const auto judged = [&](const std::string& peer) {
    auto asked = request("POST", "/api/v1/session", {{"content-type", "application/json"}});
    asked.peer = peer;
    return standing(backend_, routes(), asked);
  };
  EXPECT_EQ(std::get<http::Standing>(judged("10.0.0.1")), http::Standing::stranger);
  ASSERT_EQ(sign_in_from("10.0.0.1", "rex", kPassword).status, 200);
  EXPECT_EQ(std::get<http::Standing>(judged("10.0.0.1")), http::Standing::familiar);
  for (int n = 0; n < 50; ++n)
    fail({Secret::account_password, "name " + std::to_string(n), "10.0.0.2"}, 1);
  EXPECT_EQ(std::get<http::Response>(judged("10.0.0.2")).status, 429)
      << "before anything is hashed";
  const auto own = request("POST", "/api/v1/session/password", as("rex"));
  EXPECT_EQ(std::get<http::Standing>(standing(backend_, routes(), own)), http::Standing::familiar);
  const auto nobody = request("POST", "/api/v1/session/password", {{"x-tractus", "1"}});
  EXPECT_EQ(std::get<http::Response>(standing(backend_, routes(), nobody)).status, 401);
}

TEST_F(Throttle, RoutesThatHashAreInTheHashingLane) {
  std::set<std::string> hashing;
  for (const RouteInfo& route : routes())
    if (route.lane == http::Lane::hashing) hashing.insert(route.id);
  const std::set<std::string> expected{"addAccount",     "beginCodes",     "changeAccounts",
                                       "changePassword", "endCodes",       "importAccounts",
                                       "makeApiToken",   "resetPassword",  "setBadge",
                                       "signIn",         "signInAtStation"};
  EXPECT_EQ(hashing, expected);
}

TEST(NetworkOf, CountsAnIpv6NetworkAsOneAndAnIpv4AddressAsItself) {
  EXPECT_EQ(network_of("192.0.2.7"), "192.0.2.7");
  EXPECT_EQ(network_of("::ffff:192.0.2.7"), "192.0.2.7");
  // RFC 3849's documentation prefix; RFC 4291 section 2.5.4: 64 bits of network.
  EXPECT_EQ(network_of("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::/64");
  EXPECT_EQ(network_of("2001:db8:1:2:ffff::1"), network_of("2001:db8:1:2::9"));
  EXPECT_EQ(network_of("fe80::1%eth0"), "fe80::1%eth0");
  EXPECT_EQ(network_of(std::string(200, 'x')).size(), 64u);
}

}  // namespace
}  // namespace api
}  // namespace tractus
