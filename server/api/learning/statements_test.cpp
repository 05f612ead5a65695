/// Statements of trials to a learning record store: of whose trials, when, what they say, and what happens when
/// the store does not take them. The clock is the test's; tests/lti sends to a real store.
#include "db/store/people/consent.hpp"
#include "server/api/operations/notifier.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::PeopleTest;

constexpr std::int64_t kStatementMinute_us = 60'000'000,
                       kStatementDay_us = 24 * 60 * kStatementMinute_us;

class Statements : public PeopleTest {
 protected:
  Statements() {
    backend_.notifier = &notifier_;
    backend_.pseudonym_key.emplace();
    backend_.pseudonym_key->fill(std::byte{7});
    now_ = 0;  // the trials of PeopleTest are received at 1 us
  }
  NotifierSettings settings() {
    NotifierSettings out{.base = "https://tractus.example.org"};
    out.state = [this](const StatementCall& call) -> core::Result<void> {
      calls_.push_back(call);
      if (refusal_) return *refusal_;
      return {};
    };
    return out;
  }
  http::Response set_store(const char* endpoint = "https://lrs.example.org/xAPI/") {
    return post("ann", "/record-store", {{"endpoint", endpoint}, {"key", "k"}, {"secret", "hush"}});
  }
  void consent(const char* who, const char* tier) {
    EXPECT_EQ(post(who, "/session/consent", {{"tier", tier}}).status, 200);
  }
  void assess(const char* trainee, const store::Value& correct) {
    ASSERT_TRUE(store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(
          tx.query("update trials set state = 'assessed', correct = ?, duration_s = 12.345 where "
                   "id = ?",
                   {correct, trial_of(trainee)}));
      return {};
    }));
  }
  void run() {
    ASSERT_TRUE(notifier_.collect());
    ASSERT_TRUE(notifier_.deliver(store::Channel::xapi));
  }
  Json outbox() { return json(get("ann", "/webhooks")); }

  std::vector<StatementCall> calls_;
  std::optional<core::Error> refusal_;
  Notifier notifier_{backend_, settings()};
};

TEST_F(Statements, AreOffUntilAnAdministratorStatesAStore) {
  consent("tom", "full");
  assess("tom", std::int64_t{1});
  run();
  EXPECT_TRUE(calls_.empty());
  EXPECT_TRUE(json(get("ann", "/record-store"))["store"].is_null());
  EXPECT_EQ(post("fay", "/record-store", Json::object()).status, 403);
  EXPECT_EQ(set_store("http://lrs.example.org").status, 400);
  EXPECT_EQ(set_store().status, 200);
  EXPECT_EQ(text(get("ann", "/record-store")).find("hush"), std::string::npos)
      << "the secret is not shown again";
  run(), run();
  ASSERT_EQ(calls_.size(), 1u);
  EXPECT_EQ(calls_[0].to.endpoint, "https://lrs.example.org/xAPI");
  EXPECT_EQ(calls_[0].to.secret, "hush");
}

TEST_F(Statements, SayWhoDidWhatAndHowWellByPseudonym) {
  EXPECT_EQ(set_store().status, 200);
  consent("tom", "metrics");
  assess("tom", std::int64_t{1});
  run();
  ASSERT_EQ(calls_.size(), 1u);
  const Json& said = calls_[0].statement;
  // xAPI 1.0.3, part 2, sections 4.1 to 4.6, and ADL's vocabulary.
  EXPECT_EQ(said["verb"]["id"], "http://adlnet.gov/expapi/verbs/passed");
  EXPECT_EQ(said["actor"]["account"]["homePage"], "https://tractus.example.org/");
  const std::string actor = said["actor"]["account"]["name"];
  EXPECT_EQ(actor.size(), 17u);
  EXPECT_EQ(actor[0], 'P');
  EXPECT_EQ(said.dump().find("\"tom\""), std::string::npos) << said;
  EXPECT_EQ(said["object"]["id"], "https://tractus.example.org/assignments/a-tom");
  EXPECT_EQ(said["result"], (Json{{"completion", true},
                                  {"duration", "PT12.35S"},
                                  {"success", true},
                                  {"score", {{"scaled", 1}, {"raw", 1}, {"min", 0}, {"max", 1}}}}));
  EXPECT_EQ(said["timestamp"], "1970-01-01T00:00:00Z") << "a released trial has no time of day";
  const std::string id = said["id"];
  ASSERT_EQ(id.size(), 36u);
  EXPECT_EQ(id[14], '4') << "a UUID of version 4";
}

TEST_F(Statements, OfAWrongAnswerAndOfNoneHaveVerbsOfTheirOwn) {
  EXPECT_EQ(set_store().status, 200);
  consent("tom", "metrics");
  consent("tia", "metrics");
  assess("tom", std::int64_t{0});
  assess("tia", store::Value());
  run();
  ASSERT_EQ(calls_.size(), 2u);
  std::map<std::string, Json> by_verb;
  for (const StatementCall& call : calls_)
    by_verb[call.statement["verb"]["display"]["en"]] = call.statement;
  EXPECT_EQ(by_verb["failed"]["result"]["score"]["scaled"], 0);
  EXPECT_FALSE(by_verb["completed"]["result"].contains("success"));
}

TEST_F(Statements, AreOfPeopleWhoConsentAndOfReleasedResultsAlone) {
  EXPECT_EQ(set_store().status, 200);
  assess("tom", std::int64_t{1});
  run();
  EXPECT_TRUE(calls_.empty()) << "tom did not consent";
  consent("tom", "summary");
  run();
  EXPECT_TRUE(calls_.empty()) << "counts of trials together are not one trial";
  consent("tom", "metrics");
  EXPECT_EQ(post("fay", "/assignments/a-tom/release", {{"release", "held"}}).status, 200);
  run();
  EXPECT_TRUE(calls_.empty()) << "the results are held";
  EXPECT_EQ(post("fay", "/assignments/a-tom/release", {{"release", "released"}}).status, 200);
  refusal_ = core::Error{core::Errc::unavailable, "away"};
  run();
  EXPECT_EQ(calls_.size(), 1u);
  consent("tom", "none");
  now_ += kStatementMinute_us;
  run();
  EXPECT_EQ(calls_.size(), 1u) << "the consent was withdrawn before the statement was taken";
  EXPECT_EQ(outbox()["deliveries"][0]["state"], "withdrawn");
}

TEST_F(Statements, OfTrialsBeforeTheStoreWasStatedAreNotSent) {
  now_ = 2;
  EXPECT_EQ(set_store().status, 200);
  consent("tom", "full");
  assess("tom", std::int64_t{1});
  run();
  EXPECT_TRUE(calls_.empty());
}

TEST_F(Statements, AreKeptForThreeDaysWhileTheStoreAnswers500ThenGivenUpAloud) {
  EXPECT_EQ(set_store().status, 200);
  consent("tom", "metrics");
  assess("tom", std::int64_t{1});
  refusal_ = core::Error{core::Errc::unavailable, "the learning record store answered 500"};
  const std::int64_t begun = now_;
  for (; now_ < begun + kStatementDay_us; now_ += kStatementMinute_us) run();
  // By hand, as for webhooks: after 0, 1, 4, 13, 40 min, then every 80 min: 40 + 80 k <= 1440.
  EXPECT_EQ(calls_.size(), 5u + 17u);
  for (const StatementCall& call : calls_)
    EXPECT_EQ(call.statement, calls_[0].statement) << "the store recognises it";
  EXPECT_EQ(outbox()["waiting"], 1);
  for (; now_ < begun + 4 * kStatementDay_us; now_ += 10 * kStatementMinute_us) run();
  EXPECT_EQ(outbox()["given_up_within_week"], 1);
  const auto row = json(get("ann", "/audit?limit=1"))["rows"][0];
  EXPECT_EQ(row["what"], "giveUpDelivery");
  EXPECT_EQ(row["detail"]["channel"], "xapi");
  const std::size_t attempts = calls_.size();
  refusal_.reset();
  run();
  EXPECT_EQ(calls_.size(), attempts) << "it stays given up";
}

TEST_F(Statements, RefusedForGoodAreGivenUpAndThoseForARemovedStoreWithdrawn) {
  EXPECT_EQ(set_store().status, 200);
  consent("tom", "metrics");
  consent("tia", "metrics");
  assess("tom", std::int64_t{1});
  refusal_ = core::Error{core::Errc::bad_input, "the learning record store answered 400"};
  run();
  EXPECT_EQ(outbox()["given_up_within_week"], 1);
  assess("tia", std::int64_t{1});
  refusal_ = core::Error{core::Errc::unavailable, "away"};
  run();
  EXPECT_EQ(outbox()["waiting"], 1);
  EXPECT_EQ(ask(request("DELETE", "/api/v1/record-store", as("ann"))).status, 204);
  EXPECT_EQ(outbox()["waiting"], 0);
  EXPECT_EQ(ask(request("DELETE", "/api/v1/record-store", as("ann"))).status, 404);
}

}  // namespace
}  // namespace api
}  // namespace tractus
