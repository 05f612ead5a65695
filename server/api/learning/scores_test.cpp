/// Scores to a learning platform: when, which, and what happens when the platform does not take them.
/// The clock is the test's; tests/lti sends to a real authorisation server.
#include <set>

#include "server/api/learning/lti_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::LtiTest;
using Mood = testing::Provider::Mood;

constexpr std::int64_t kScoreMinute_us = 60'000'000, kScoreDay_us = 24 * 60 * kScoreMinute_us;

class Scores : public LtiTest {
 protected:
  Scores() {
    platform_id_ = register_platform();
    link(platform_id_, "tom", "person-7");
    EXPECT_EQ(post("fay", "/assignments/a-tom/release", {{"release", "held"}}).status, 200);
    assess("assessing", false);
  }
  void assess(const char* state, bool correct) {
    ASSERT_TRUE(store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(tx.query("update trials set state = ?, correct = ? where id = ?",
                   {std::string(state), store::bool_value(correct), trial_of("tom")}));
      return {};
    }));
  }
  void release(const char* how = "released") {
    EXPECT_EQ(post("fay", "/assignments/a-tom/release", {{"release", how}}).status, 200);
  }
  void run() {
    ASSERT_TRUE(notifier_.collect());
    ASSERT_TRUE(notifier_.deliver(store::Channel::lti));
  }
  Json outbox() { return json(get("ann", "/webhooks")); }

  std::string platform_id_;
};

TEST_F(Scores, AreSentWhenResultsAreReleasedAndAgainWhenTheyChange) {
  EXPECT_EQ(where(launch()), "/assignments/a-tom");
  assess("assessed", true);
  run();
  EXPECT_TRUE(scores_.empty()) << "the results are held";
  release();
  run(), run();
  ASSERT_EQ(scores_.size(), 1u);
  EXPECT_EQ(scores_[0].what.item.url, platform_.issuer + "/items/7?type=x");
  EXPECT_EQ(scores_[0].platform.id, platform_id_);
  // LTI AGS 2.0, section 3.4.1: the one planned trial is done, its answer is right.
  EXPECT_EQ(score_json(scores_[0].what, 1'000'000),
            (Json{{"userId", "person-7"},
                  {"scoreGiven", 1},
                  {"scoreMaximum", 1},
                  {"activityProgress", "Completed"},
                  {"gradingProgress", "FullyGraded"},
                  {"timestamp", "1970-01-01T00:00:01.000000Z"}}));
  assess("assessed", false);
  run();
  ASSERT_EQ(scores_.size(), 2u);
  EXPECT_EQ(score_json(scores_[1].what, 0)["scoreGiven"], 0);
}

TEST_F(Scores, OfATrialThatIsNotScoredYetArePending) {
  launch();
  release();
  run();
  ASSERT_EQ(scores_.size(), 1u);
  EXPECT_EQ(score_json(scores_[0].what, 0)["gradingProgress"], "Pending");
}

TEST_F(Scores, GoOnlyWhereALaunchOfTheAssignedPersonStatedALineItem) {
  release();
  assess("assessed", true);
  run();
  EXPECT_TRUE(scores_.empty()) << "nobody launched it";
  const std::string ags = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint";
  launch({{ags, {{"scope", Json::array()}}}});
  launch({{ags, {{"lineitem", "http://10.0.0.1/items/7"}}}});
  launch({{ags, nullptr}});
  launch({{"https://purl.imsglobal.org/spec/lti/claim/custom", {{"assignment", "a-tia"}}}});
  run();
  EXPECT_TRUE(scores_.empty());
  launch();
  run();
  EXPECT_EQ(scores_.size(), 1u) << "the results were released before the launch";
}

TEST_F(Scores, AreKeptForThreeDaysWhileThePlatformAnswers500ThenGivenUpAloud) {
  launch();
  release();
  assess("assessed", true);
  refusal_ = core::Error{core::Errc::unavailable, "the learning platform answered 500"};
  const std::int64_t begun = now_;
  for (; now_ < begun + kScoreDay_us; now_ += kScoreMinute_us) run();
  // By hand, as for webhooks: after 0, 1, 4, 13, 40 min, then every 80 min: 40 + 80 k <= 1440.
  EXPECT_EQ(scores_.size(), 5u + 17u);
  EXPECT_EQ(outbox()["waiting"], 1);
  for (; now_ < begun + 4 * kScoreDay_us; now_ += 10 * kScoreMinute_us) run();
  EXPECT_EQ(outbox()["waiting"], 0);
  EXPECT_EQ(outbox()["given_up_within_week"], 1);
  const auto row = json(get("ann", "/audit?limit=1"))["rows"][0];
  EXPECT_EQ(row["what"], "giveUpDelivery");
  EXPECT_EQ(row["detail"]["channel"], "lti");
  const std::size_t given_up = scores_.size();
  refusal_.reset();
  run();
  EXPECT_EQ(scores_.size(), given_up) << "it stays given up";
  assess("assessed", false);
  run();
  EXPECT_EQ(scores_.size(), given_up + 1) << "another score is another delivery";
}

TEST_F(Scores, ThatWaitAreTheNewestAndAreWithdrawnWhenTheResultsAreHeldAgain) {
  launch();
  release();
  assess("assessed", false);
  refusal_ = core::Error{core::Errc::unavailable, "away"};
  run();
  assess("assessed", true);
  now_ += kScoreMinute_us;
  run();
  ASSERT_EQ(scores_.size(), 2u);
  EXPECT_EQ(scores_[1].what.score.right, 1u);
  EXPECT_EQ(outbox()["waiting"], 1) << "one delivery, whatever changed meanwhile";
  release("held");
  now_ += 3 * kScoreMinute_us;
  run();
  EXPECT_EQ(scores_.size(), 2u);
  EXPECT_EQ(outbox()["deliveries"][0]["state"], "withdrawn");
}

TEST_F(Scores, RefusedForGoodAreGivenUpAtOnceAndThoseOfARemovedPlatformWithdrawn) {
  launch();
  release();
  assess("assessed", true);
  refusal_ = core::Error{core::Errc::bad_input, "the learning platform answered 404"};
  run();
  EXPECT_EQ(outbox()["given_up_within_week"], 1);
  refusal_ = core::Error{core::Errc::unavailable, "away"};
  assess("assessed", false);
  run();
  EXPECT_EQ(outbox()["waiting"], 1);
  EXPECT_EQ(ask(request("DELETE", "/api/v1/lti/platforms/" + platform_id_, as("ann"))).status, 204);
  EXPECT_EQ(outbox()["waiting"], 0);
}

TEST_F(Scores, WaitForAPlatformThatHangsAsLongAsTheirTimeLimitAndNoLonger) {
  platform_.is(Mood::hangs);
  const auto begun = std::chrono::steady_clock::now();
  ScoreCall call{.key = new_tool_key(),
                 .networks = http::Networks::loopback(),
                 .patience = std::chrono::milliseconds(300)};
  call.platform.token_url = platform_.issuer + "/token";
  call.what.item.url = platform_.issuer + "/items/7";
  const auto sent = post_score(call);
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().code, core::Errc::unavailable) << "it is tried again";
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(3));
  platform_.is(Mood::works);
}

TEST_F(Scores, GoToTheAddressBelowTheLineItem) {
  // LTI AGS 2.0, section 3.4: the path of the line item with /scores, its query kept.
  EXPECT_EQ(scores_address("https://lms/items/7"), "https://lms/items/7/scores");
  EXPECT_EQ(scores_address("https://lms/items/7?type=x"), "https://lms/items/7/scores?type=x");
}

}  // namespace
}  // namespace api
}  // namespace tractus
