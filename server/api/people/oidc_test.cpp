/// A provider of identities that hangs, drips, fails, changes its keys and comes back.
#include "server/api/people/oidc.hpp"

#include <atomic>

#include "server/api/people/provider_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using testing::kUtc_s;
using testing::Provider;
using namespace std::chrono_literals;

constexpr const char* kDescription = "/.well-known/openid-configuration";
using Mood = Provider::Mood;

class OidcProvider : public ::testing::Test {
 protected:
  bool starts() { return bool(oidc_.sign_in_address({"s", "n-1", "v"})); }
  core::Result<Identity> redeems(const std::string& code = "good") {
    return oidc_.redeemed(code, {"s", "n-1", "v"}, kUtc_s);
  }

  Provider provider_;
  std::atomic<std::int64_t> now_s_ = 1000;
  Oidc oidc_{{.issuer = provider_.issuer,
              .client_id = "tractus",
              .client_secret = "secret",
              .base = "http://127.0.0.1:1",
              .label = "",
              .authority = {},
              .patience = 300ms},
             [this] { return now_s_.load(); }};
};

TEST_F(OidcProvider, ManyWhoComeWhileItHangsWaitForOneAnswerAndNotLongerThanItsPatience) {
  provider_.is(Mood::hangs);
  const auto begun = std::chrono::steady_clock::now();
  std::atomic<int> failed = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 16; ++i) threads.emplace_back([&] { failed += !starts(); });
  for (auto& thread : threads) thread.join();
  const auto took = std::chrono::steady_clock::now() - begun;
  EXPECT_EQ(failed, 16);
  EXPECT_EQ(provider_.asked(kDescription), 1);
  EXPECT_GE(took, 250ms) << "it was asked and waited for";
  EXPECT_LT(took, 3s) << "sixteen times the patience would be 4.8 s";
}

TEST_F(OidcProvider, AnAnswerThatDripsIsCutOffAsAWhole) {
  provider_.is(Mood::drips);
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_FALSE(starts());
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 3s) << "100 000 bytes take 1000 s";
}

TEST_F(OidcProvider, OneThatFailsIsAskedAgainAfterTwiceTheTimeEachTimeAndAtMostAMinute) {
  provider_.is(Mood::fails);
  std::vector<std::int64_t> asked_s;
  for (const std::int64_t begun_s = now_s_; now_s_ < begun_s + 190; ++now_s_) {
    const int before = provider_.asked(kDescription);
    EXPECT_FALSE(starts());
    if (provider_.asked(kDescription) > before) asked_s.push_back(now_s_ - begun_s);
  }
  EXPECT_EQ(asked_s, (std::vector<std::int64_t>{0, 2, 6, 14, 30, 62, 122, 182}));
}

TEST_F(OidcProvider, OneThatComesBackIsAskedOnceAndThenKept) {
  provider_.is(Mood::fails);
  EXPECT_FALSE(starts());
  provider_.is(Mood::works);
  EXPECT_FALSE(starts()) << "it is left alone for two seconds";
  now_s_ += 2;
  EXPECT_TRUE(starts());
  EXPECT_TRUE(redeems());
  const int asked = provider_.asked(kDescription);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(starts());
  EXPECT_EQ(provider_.asked(kDescription), asked);
  provider_.is(Mood::hangs);
  EXPECT_TRUE(starts()) << "what is kept needs no answer";
}

TEST_F(OidcProvider, ANewKeyIsFetchedWhenATokenNamesItAndTheOldOneIsTenSecondsOld) {
  const auto first = redeems();
  ASSERT_TRUE(first) << first.error().what;
  EXPECT_EQ(first->subject, "person-7");
  provider_.uses("k2");
  now_s_ += 5;
  const auto early = redeems();
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().code, core::Errc::unauthorised);
  EXPECT_EQ(provider_.asked("/keys"), 1);
  now_s_ += 5;
  EXPECT_TRUE(redeems());
  EXPECT_EQ(provider_.asked("/keys"), 2);
}

TEST_F(OidcProvider, KeysThatCannotBeFetchedAgainLeaveTheKnownOnesInForce) {
  ASSERT_TRUE(redeems());
  provider_.uses("k2");
  provider_.is(Mood::fails, "/keys");
  now_s_ += 11;
  EXPECT_FALSE(redeems());
  provider_.uses("k1");
  now_s_ += 2;
  EXPECT_TRUE(redeems());
}

TEST_F(OidcProvider, WrongCodesKeepNobodyOut) {
  for (int i = 0; i < 5; ++i) {
    const auto refused = redeems("guess");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Errc::unauthorised);
  }
  EXPECT_TRUE(redeems());
}

TEST_F(OidcProvider, ATokenEndpointThatHangsIsLeftAloneForAWhile) {
  ASSERT_TRUE(redeems());
  provider_.is(Mood::hangs, "/token");
  EXPECT_FALSE(redeems());
  EXPECT_FALSE(redeems());
  EXPECT_EQ(provider_.asked("/token"), 2) << "one that worked, one that hung";
  provider_.is(Mood::works);
  now_s_ += 2;
  EXPECT_TRUE(redeems());
}

}  // namespace
}  // namespace api
}  // namespace tractus
