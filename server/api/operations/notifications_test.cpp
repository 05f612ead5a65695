/// Being told of events: who, of what, when, and what happens when nobody takes the message. The
/// clock is the test's; tests/notifications/told.py sends to a real mail server.
#include <set>

#include "db/store/operations/audit.hpp"
#include "server/api/operations/notification_text.hpp"
#include "server/api/operations/notifier.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using store::Channel;
using store::NotificationKind;
using testing::kCase;
using testing::PeopleTest;

constexpr std::int64_t kSecond_us = 1'000'000, kHour_us = 3600 * kSecond_us;
constexpr std::int64_t kDay_us = 24 * kHour_us;

class Notifications : public PeopleTest {
 protected:
  Notifications() { backend_.notifier = &notifier_; }

  NotifierSettings settings() {
    NotifierSettings out{.mail = MailSettings{.server = "smtps://mail.example.org",
                                              .from = "tractus@example.org",
                                              .base = "https://tractus.example.org"},
                         .base = "https://tractus.example.org"};
    out.send = [this](const MailSettings&, const Mail& mail) -> core::Result<void> {
      mails_.push_back(mail);
      if (refusal_) return *refusal_;
      return {};
    };
    out.call = [this](const WebhookCall& call) -> core::Result<void> {
      calls_.push_back(call);
      if (refusal_ && call.url.find("good") == std::string::npos) return *refusal_;
      return {};
    };
    return out;
  }
  void choose(const std::string& who, const char* kind, const char* delivery = "immediate") {
    const auto set = post(who, "/session/notifications",
                          {{"address", who + "@example.org"},
                           {"choices", {{{"kind", kind}, {"delivery", delivery}}}}});
    ASSERT_EQ(set.status, 200) << text(set);
  }
  void run() {
    ASSERT_TRUE(notifier_.collect());
    for (const Channel channel : core::values<Channel>()) ASSERT_TRUE(notifier_.deliver(channel));
  }
  /// Assigns a case to tom that is due at this time.
  void set_due(std::int64_t due_utc_us) {
    ASSERT_TRUE(store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(tx.query("update assignments set due_utc_us = ? where study_id = 'a-tom'", {due_utc_us}));
      TRY(
          tx.query("update assignment_entries set due_utc_us = ?, finished = 0 where study_id = "
                   "'a-tom'",
                   {due_utc_us}));
      TRY(tx.query("update assigned_progress set finished = 0 where study_id = 'a-tom'"));
      return {};
    }));
  }
  void note(NotificationKind kind, const std::string& key, const std::string& subject) {
    ASSERT_TRUE(store_.write([&](store::Writing& tx) {
      return store::note_event(
          tx, {.id = {}, .kind = kind, .key = key, .subject = subject, .at_utc_us = now_});
    }));
  }
  std::string webhook(const std::string& url, const char* kind = "backup_failed") {
    const auto made = post("ann", "/webhooks", {{"url", url}, {"kinds", {kind}}});
    EXPECT_EQ(made.status, 201) << text(made);
    return json(made)["webhook"]["id"];
  }
  std::set<std::string> told() const {
    std::set<std::string> out;
    for (const Mail& mail : mails_) out.insert(mail.to);
    return out;
  }
  core::Json outbox() { return json(get("ann", "/webhooks")); }

  std::vector<Mail> mails_;
  std::vector<WebhookCall> calls_;
  std::optional<core::Error> refusal_;
  Notifier notifier_{backend_, settings()};
};

TEST_F(Notifications, AreQuietUntilSomebodyChooses) {
  set_due(now_ + kHour_us);
  note(NotificationKind::backup_failed, "backup/1", "1");
  run();
  EXPECT_TRUE(mails_.empty());
  const core::Json own = json(get("tom", "/session/notifications"));
  ASSERT_GT(own["choices"].size(), 0u);
  for (const auto& one : own["choices"]) EXPECT_EQ(one["delivery"], "off");
}

TEST_F(Notifications, TellATraineeOnceThatAnAssignmentIsDueAndOnceThatItIsOverdue) {
  choose("tom", "due");
  choose("fay", "overdue");
  set_due(now_ + 25 * kHour_us);
  run();
  EXPECT_TRUE(mails_.empty()) << "more than a day is left";
  now_ += 2 * kHour_us;
  run(), run();
  ASSERT_EQ(mails_.size(), 1u);
  EXPECT_EQ(mails_[0].to, "tom@example.org");
  EXPECT_EQ(mails_[0].subject, "Tractus: an assignment is due");
  EXPECT_NE(mails_[0].text.find("https://tractus.example.org/assignments/a-tom"),
            std::string::npos);
  now_ += 24 * kHour_us;
  run(), run();
  ASSERT_EQ(mails_.size(), 2u) << "tom did not choose to be told of what is overdue";
  EXPECT_EQ(mails_[1].to, "fay@example.org");
}

TEST_F(Notifications, TellOnlyThoseWhomTheEventConcernsByRelationAndRole) {
  for (const char* who : {"tom", "tia"}) choose(who, "released");
  for (const char* who : {"ted", "ann"}) choose(who, "self_test_failed");
  for (const char* who : {"fay", "flo"}) choose(who, "relapse");
  EXPECT_EQ(post("tom", "/session/notifications",
                 {{"choices", {{{"kind", "backup_failed"}, {"delivery", "daily"}}}}})
                .status,
            400)
      << "no trainee is told of backups";
  note(NotificationKind::released, "released/a-tom", "a-tom");
  run();
  EXPECT_EQ(told(), std::set<std::string>{"tom@example.org"});
  note(NotificationKind::relapse, "relapse/tia/9", "tia");
  note(NotificationKind::self_test_failed, "self_test/s1/1", "s1");
  run();
  EXPECT_EQ(told(), (std::set<std::string>{"tom@example.org", "flo@example.org", "ted@example.org",
                                           "ann@example.org"}));
  for (const Mail& mail : mails_)
    for (const char* name : {"tom", "tia"}) {
      if (mail.text.find("/assignments/a-tom") != std::string::npos) continue;
      EXPECT_EQ(mail.text.find(name), std::string::npos) << mail.text;
    }
}

TEST_F(Notifications, ComeOfWhatStationsAndFacultyDo) {
  choose("ted", "self_test_failed");
  choose("tom", "released");
  const core::Json report{
      {"self_test", {{"at_utc_us", 5}, {"passed", false}, {"checks", core::Json::array()}}}};
  for (int again = 0; again < 2; ++again)
    EXPECT_EQ(
        ask(request("POST", "/api/v1/station/report", station("token-1"), report.dump())).status,
        204);
  for (int again = 0; again < 2; ++again)
    EXPECT_EQ(post("fay", "/assignments/a-tom/release", {{"release", "released"}}).status, 200);
  run();
  EXPECT_EQ(told(), (std::set<std::string>{"ted@example.org", "tom@example.org"}));
  EXPECT_EQ(mails_.size(), 2u);
}

TEST_F(Notifications, OfADayComeInOneMessageWhereSomebodyWantsThat) {
  choose("ted", "backup_failed", "daily");
  now_ = 1'000'000 * kSecond_us;  // 1970-01-12 13:46:40 UTC
  note(NotificationKind::backup_failed, "backup/1", "1");
  run();
  now_ += kHour_us;
  note(NotificationKind::backup_failed, "backup/2", "2");
  run();
  EXPECT_TRUE(mails_.empty());
  now_ = (12ll * 86400 + 6 * 3600) * kSecond_us;  // 1970-01-13 06:00 UTC
  run();
  ASSERT_EQ(mails_.size(), 1u);
  EXPECT_EQ(mails_[0].subject, "Tractus: 2 messages");
  note(NotificationKind::backup_failed, "backup/3", "3");
  run();
  EXPECT_EQ(mails_.size(), 1u) << "the next one comes the next day";
  now_ += kDay_us;
  run();
  EXPECT_EQ(mails_.size(), 2u);
}

TEST_F(Notifications, AreKeptForThreeDaysWhileAReceiverAnswers500ThenGivenUpAloud) {
  const std::string bad = webhook("https://bad.example.org/"),
                    good = webhook("https://good.example.org/");
  refusal_ = core::Error{core::Errc::unavailable, "the receiver answered with the status 500"};
  note(NotificationKind::backup_failed, "backup/1", "1");
  const std::int64_t begun = now_;
  std::set<std::string> ids;
  run();
  EXPECT_EQ(calls_.size(), 2u) << "the other receiver is served at once";
  const auto to_bad = [&] {
    std::int64_t count = 0;
    for (const WebhookCall& call : calls_)
      if (call.url.find("bad") != std::string::npos) ++count, ids.insert(call.id);
    return count;
  };
  for (; now_ < begun + kDay_us; now_ += 60 * kSecond_us) run();
  // By hand: after 0, 1, 4, 13, 40 min, then every 80 min: at most 40 + 80 k <= 1440, k <= 17.
  EXPECT_EQ(to_bad(), 5 + 17);
  EXPECT_EQ(outbox()["waiting"], 1);
  note(NotificationKind::backup_failed, "backup/2", "2");
  run();
  EXPECT_EQ(outbox()["waiting"], 2);
  for (; now_ < begun + 5 * kDay_us; now_ += 10 * 60 * kSecond_us) run();
  EXPECT_EQ(outbox()["waiting"], 0);
  EXPECT_EQ(outbox()["given_up_within_week"], 2);
  EXPECT_GT(to_bad(), 5 + 17);
  EXPECT_EQ(ids.size(), 2u) << "each delivery has one id, however often it is sent";
  const auto rows =
      store_.read([](store::Reading& tx) { return store::audit_before(tx, 1'000'000, 100); });
  std::int64_t given_up = 0;
  for (const auto& row : *rows) given_up += row.act.what == "giveUpDelivery" ? 1 : 0;
  EXPECT_EQ(given_up, 2);
  EXPECT_NE(text(get("ann", "/server/metrics")).find("tractus_deliveries_given_up 2"),
            std::string::npos);
}

TEST_F(Notifications, ArriveAfterAReceiverIsBack) {
  webhook("https://bad.example.org/");
  refusal_ = core::Error{core::Errc::unavailable, "no answer"};
  note(NotificationKind::backup_failed, "backup/1", "1");
  run();
  refusal_.reset();
  now_ += 61 * kSecond_us;
  run();
  ASSERT_EQ(calls_.size(), 2u);
  EXPECT_EQ(calls_[0].id, calls_[1].id);
  EXPECT_EQ(calls_[0].body, calls_[1].body);
  run();
  EXPECT_EQ(calls_.size(), 2u);
}

TEST_F(Notifications, AreSentAgainWithTheSameIdAfterAProcessDiedWhileSending) {
  choose("ted", "backup_failed");
  note(NotificationKind::backup_failed, "backup/1", "1");
  ASSERT_TRUE(notifier_.collect());
  const auto claimed = store_.write(
      [&](store::Writing& tx) { return store::claim_delivery(tx, Channel::mail, now_); });
  ASSERT_TRUE(claimed.value());  // and the process is gone
  run();
  EXPECT_TRUE(mails_.empty()) << "another process may be sending it";
  now_ += store::kClaim_us;
  run();
  ASSERT_EQ(mails_.size(), 1u);
  EXPECT_EQ(mails_[0].id, claimed.value()->id);
}

TEST_F(Notifications, ThatTheMailServerRefusesForGoodAreGivenUpAtOnce) {
  choose("ted", "backup_failed");
  refusal_ = core::Error{core::Errc::forbidden, "the mail server refuses the message (status 550)"};
  note(NotificationKind::backup_failed, "backup/1", "1");
  run();
  EXPECT_EQ(mails_.size(), 1u);
  EXPECT_EQ(outbox()["given_up_within_week"], 1);
}

TEST_F(Notifications, GoToNobodyWhoLeftOrChangedTheMind) {
  choose("ted", "backup_failed");
  note(NotificationKind::backup_failed, "backup/1", "1");
  ASSERT_TRUE(notifier_.collect());
  EXPECT_EQ(post("ann", "/accounts/ted/state", {{"state", "disabled"}}).status, 200);
  run();
  EXPECT_TRUE(mails_.empty());
  const std::string id = webhook("https://good.example.org/");
  note(NotificationKind::backup_failed, "backup/2", "2");
  ASSERT_TRUE(notifier_.collect());
  EXPECT_EQ(ask(request("DELETE", "/api/v1/webhooks/" + id, as("ann"))).status, 204);
  run();
  EXPECT_TRUE(calls_.empty());
}

TEST_F(Notifications, TakeNoAddressThatIsNone) {
  for (const char* bad :
       {"tom", "tom@", "@example.org", "a b@example.org", "a@example.org\r\nBcc: x@example.org",
        "a@example.org>", "\"a\"@example.org", "a@exa mple.org", "a@b@c", "t\xC3\xB6m@example.org",
        "a..b@example.org", "a,b@example.org"})
    EXPECT_EQ(
        post("tom", "/session/notifications", {{"address", bad}, {"choices", core::Json::array()}})
            .status,
        400)
        << bad;
  EXPECT_TRUE(json(get("tom", "/session/notifications"))["address"].is_null());
}

TEST_F(Notifications, HaveNoWordsOfPeopleInTheirHeaders) {
  choose("tom", "released");
  ASSERT_TRUE(store_.write([](store::Writing& tx) {
    return tx.query("update studies set title = ? where id = 'a-tom'",
                    {"week 1\r\nBcc: everybody@example.org\r\n.\r\nSubject: hello"});
  }));
  note(NotificationKind::released, "released/a-tom", "a-tom");
  run();
  ASSERT_EQ(mails_.size(), 1u);
  EXPECT_EQ(mails_[0].subject, "Tractus: results are released");
  const std::string message = message_of(*settings().mail, mails_[0]);
  const std::string head = message.substr(0, message.find("\r\n\r\n"));
  EXPECT_EQ(head.find("everybody"), std::string::npos);
  EXPECT_EQ(mails_[0].text.find("\r\nBcc"), std::string::npos) << mails_[0].text;
  EXPECT_EQ(message.find("\r\n.\r\n"), std::string::npos);
}

TEST_F(Notifications, AreInTheLanguageOfTheAccount) {
  for (const char* who : {"tom", "tia", "fay"}) choose(who, "overdue");
  choose("ted", "backup_failed", "daily");
  const auto speak = [&](const std::string& who, const std::string& language) {
    ASSERT_TRUE(
        store_.write([&](store::Writing& tx) { return store::set_language(tx, who, language); }));
  };
  EXPECT_EQ(post("tom", "/session/language", {{"language", "de"}}).status, 204);
  speak("fay", "rm");  // of a newer server, say
  speak("ted", "fr");
  set_due(now_ - kHour_us);
  run();
  ASSERT_EQ(told(), (std::set<std::string>{"tom@example.org", "fay@example.org"}));
  for (const Mail& mail : mails_) {
    const bool german = mail.to == "tom@example.org";
    EXPECT_EQ(mail.subject, german ? "Tractus: Eine Aufgabe ist überfällig"
                                   : "Tractus: an assignment is overdue");
    EXPECT_TRUE(mail.text.starts_with(german ? "Eine Aufgabe ist überfällig: ohne Titel.\r\n"
                                             : "An assignment is overdue: without a title.\r\n"))
        << mail.text;
  }
  mails_.clear();
  for (const char* id : {"1", "2"})
    note(NotificationKind::backup_failed, std::string("backup/") + id, id);
  run();
  now_ += kDay_us;
  run();
  ASSERT_EQ(mails_.size(), 1u);
  EXPECT_EQ(mails_[0].subject, "Tractus\u202f: 2 messages");
  EXPECT_NE(mails_[0].text.find("Une sauvegarde a échoué."), std::string::npos);
  EXPECT_NE(mails_[0].text.find("Vous avez choisi ces messages"), std::string::npos);
}

TEST_F(Notifications, HaveASubjectThatIsASCIIOnTheWire) {
  Mail mail{.id = "1", .to = "tom@example.org", .subject = "Überfällig", .text = "x"};
  // Python: email.header.Header("Überfällig", "utf-8").encode()
  EXPECT_NE(message_of(*settings().mail, mail).find("Subject: =?utf-8?B?w5xiZXJmw6RsbGln?=\r\n"),
            std::string::npos);
  for (int i = 0; i < 90; ++i) mail.subject += "ä";
  const std::string head = message_of(*settings().mail, mail);
  EXPECT_TRUE(std::ranges::all_of(head, [](char c) { return c >= 0; }));
  const std::string begin = "=?utf-8?B?";
  for (auto at = head.find(begin); at != std::string::npos; at = head.find(begin, at + 1)) {
    const std::string word = head.substr(at, head.find("?=", at + begin.size()) + 2 - at);
    EXPECT_LE(word.size(), 75u) << "RFC 2047, section 2";
    const auto bytes =
        core::base64_decoded(word.substr(begin.size(), word.size() - begin.size() - 2));
    ASSERT_TRUE(bytes);
    EXPECT_NE(std::to_integer<int>(bytes->front()) & 0xC0, 0x80) << "begins within a character";
  }
}

TEST_F(Notifications, AreSignedAsStandardWebhooksStates) {
  // The example of the specification's reference libraries (standardwebhooks.com).
  EXPECT_EQ(webhook_signature("whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw",
                              "msg_p5jXN8AQM9LWM0D4loKWxJek", 1614265330, "{\"test\": 2432232314}")
                .value(),
            "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=");
  EXPECT_FALSE(webhook_signature("no secret", "1", 1, ""));
}

TEST_F(Notifications, CallNoAddressOfThisMachineOrItsNetwork) {
  for (const char* bad :
       {"http://example.org/", "https://user@example.org/", "ftp://example.org/",
        "http://127.0.0.1/", "http://[::1]/", "file:///etc/passwd", "https://a b/"})
    EXPECT_EQ(post("ann", "/webhooks", {{"url", bad}, {"kinds", {"due"}}}).status, 400) << bad;
  for (const char* own : {"https://127.0.0.1:9/", "https://10.0.0.1:9/", "https://169.254.169.254/",
                          "https://[::1]:9/", "https://[::ffff:127.0.0.1]:9/",
                          "https://localhost:9/", "https://0.0.0.0:9/"}) {
    WebhookCall call;
    call.url = own;
    call.secret = new_webhook_secret();
    call.body = "{}";
    call.patience = std::chrono::milliseconds(2000);
    const auto called = call_webhook(call);
    ASSERT_FALSE(called) << own;
    EXPECT_EQ(called.error().code, core::Errc::unavailable) << own;
  }
}

TEST_F(Notifications, WebhooksAreForAdministratorsAndTheirSecretIsShownOnce) {
  for (const char* who : {"dora", "fay", "rex", "ted", "tom"})
    EXPECT_EQ(get(who, "/webhooks").status, 403) << who;
  const auto made =
      post("ann", "/webhooks", {{"url", "https://good.example.org/"}, {"kinds", {"due"}}});
  const std::string secret = json(made)["secret"];
  EXPECT_TRUE(secret.starts_with("whsec_"));
  EXPECT_EQ(text(get("ann", "/webhooks")).find(secret), std::string::npos);
  const auto rows =
      store_.read([](store::Reading& tx) { return tx.query("select secret from webhooks"); });
  EXPECT_EQ(rows->front().text(0).find(secret.substr(6)), std::string::npos);
}

TEST_F(Notifications, ATestGoesToItsOwnAddressAtMostOnceAMinute) {
  const auto bare = [&](const char* who, const std::string& path) {
    return ask(request("POST", "/api/v1" + path, as(who))).status;
  };
  EXPECT_EQ(bare("tom", "/session/notifications/test"), 409) << "no address yet";
  choose("tom", "due");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(bare("tom", "/session/notifications/test"), 204);
  run();
  ASSERT_EQ(mails_.size(), 1u);
  EXPECT_EQ(mails_[0].to, "tom@example.org");
  const std::string id = webhook("https://good.example.org/");
  EXPECT_EQ(bare("ann", "/webhooks/" + id + "/test"), 204);
  run();
  EXPECT_EQ(calls_.size(), 1u);
}

}  // namespace
}  // namespace api
}  // namespace tractus
