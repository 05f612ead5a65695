#include "db/store/people/erasure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/json.hpp"
#include "core/try.hpp"
#include "db/store/operations/coverage.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/people/erasure_steps.hpp"
#include "db/store/people/invitations.hpp"
#include "db/store/people/retention.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace store {
namespace {

class Erasing : public test_support::BothDatabases {
 protected:
  Erasing() { EXPECT_TRUE(begin_coverage(store_)); }
  void TearDown() override {
    std::vector<std::string> findings;
    const auto read = store_.read([&](Reading& tx) -> core::Result<void> {
      TrailDigests digests;
      TRY(verify_chain(tx, store_.audit_key(), [&](const AuditRow& row) { digests.add(row); }));
      return digests.compare(tx, store_.audit_key(), findings);
    });
    EXPECT_TRUE(read) << read.error().what;
    for (const std::string& line : findings) ADD_FAILURE() << line;
  }
  void add(const std::string& id, const std::string& name, Role role, std::int64_t made_utc_us) {
    ASSERT_TRUE(store_.write([&](Writing& tx) {
      return add_account(tx, {.id = id, .name = name, .role = role, .password_hash = "h"},
                         made_utc_us);
    }));
  }
  void act(const AuditedAction& action) {
    const AuditScope scope(action);
    ASSERT_TRUE(store_.write([](Writing& tx) {
      return tx.query("update accounts set level = level || 'x' where id = 'other'");
    }));
  }
  std::vector<AuditRow> trail() {
    return store_.read([](Reading& tx) { return audit_before(tx, 1'000'000, 1'000'000); }).value();
  }

  test_support::TestDatabase database_{GetParam()};
  Store store_ = database_.open();
};
TRACTUS_ON_BOTH_DATABASES(Erasing);

/// A table that is new is decided in erasure_tables.cpp: what becomes of a person's rows in it, and why.
TEST_P(Erasing, EveryTableOfTheSchemaIsDecided) {
  const auto tables = store_.read([](Reading& tx) { return tx.tables(); }).value();
  for (const Table& table : tables)
    EXPECT_EQ(std::ranges::count(table_decisions(), table.name, &TableDecision::table), 1)
        << "table " << table.name
        << " is not decided in db/store/people/erasure_tables.cpp: removed, changed or kept when a "
           "person leaves?";
  for (const TableDecision& one : table_decisions())
    EXPECT_TRUE(one.table == "schema_versions" ||
                std::ranges::count(tables, one.table, &Table::name) == 1)
        << one.table << " is decided and not in the schema";
}

/// What is said to be removed or changed has a statement, and what is said to be kept has none.
TEST_P(Erasing, TheStatementsDoWhatIsDecided) {
  for (const TableDecision& one : table_decisions())
    for (const ErasureMode mode : {ErasureMode::erase, ErasureMode::anonymise}) {
      const Fate fate = mode == ErasureMode::erase ? one.erase : one.anonymise;
      const bool acts = std::ranges::any_of(erasure_steps(), [&](const ErasureStep& step) {
        return step.table == one.table && (!step.only || *step.only == mode) &&
               !step.sql.starts_with("insert into erased_");
      });
      const bool elsewhere = one.table == "audit";  // finish_erasure
      EXPECT_EQ(acts || elsewhere, fate == Fate::removed || fate == Fate::changed)
          << one.table << " in the mode " << name(mode);
      if (fate == Fate::changed || fate == Fate::kept) {
        EXPECT_FALSE(one.reason.empty()) << one.table;
      }
    }
}

TEST_P(Erasing, TheTrailLosesTheNameAndHolds) {
  add("other", "bea", Role::admin, 0);
  add("zoe-id", "zoe", Role::trainee, 0);
  act({.who = "zoe", .role = "trainee", .peer = "10.0.0.9", .what = "signIn"});
  act({.who = "zoe at station-1", .role = "trainee", .what = "nextTrial"});
  act({.who = "zoe", .role = "station", .what = "reportStation"});  // a station may be called so
  act({.who = "bea",
       .role = "admin",
       .what = "addAccount",
       .detail =
           core::Json{{"name", "zoe"}, {"role", "zoe"}, {"reason", "zoe leaves; zoetrope stays"}}
               .dump()});
  {
    const AuditScope scope(
        {.who = "bea", .role = "admin", .what = "invite", .object = "id=c name=zoe"});
    ASSERT_TRUE(store_.write([](Writing& tx) -> core::Result<void> {
      TRY(tx.query(
          "insert into cohorts (id, name, made_utc_us, made_by) values ('c', 'y', 1, 'bea')"));
      return invite(tx, {"c", "zoe"});
    }));
  }
  const std::size_t before = trail().size();
  const auto begun = store_.write([](Writing& tx) {
    return begin_erasure(tx,
                         {.account_id = "zoe-id", .mode = ErasureMode::erase, .begun_utc_us = 7});
  });
  ASSERT_TRUE(begun) << begun.error().what;
  EXPECT_EQ(begun->erasure.alias(), "erased person 1");
  ASSERT_TRUE(redact_person(store_, {"zoe", "", begun->erasure.alias()}));
  ASSERT_TRUE(redact_person(store_, {"zoe", "", begun->erasure.alias()}));  // again changes nothing
  const auto rows = trail();
  EXPECT_EQ(rows.size(), before + 2);  // the erasure and one redaction
  const auto of = [&](const std::string& what) {
    return std::ranges::find(rows, what, [](const AuditRow& row) { return row.act.what; })->act;
  };
  for (const AuditRow& row : rows)
    EXPECT_EQ(row.changes.find("zoe\\\""), std::string::npos)
        << row.changes;  // no invitation's key
  EXPECT_EQ(of("signIn").who, "erased person 1");
  EXPECT_EQ(of("nextTrial").who, "erased person 1 at station-1");
  EXPECT_EQ(of("reportStation").who, "zoe");
  EXPECT_EQ(of("invite").object, "id=c name=erased person 1");
  EXPECT_EQ(core::Json::parse(of("addAccount").detail),
            (core::Json{{"name", "erased person 1"},
                        {"role", "zoe"},
                        {"reason", "erased person 1 leaves; zoetrope stays"}}));
}

TEST_P(Erasing, AnEditOfARedactedRowIsSeen) {
  add("other", "bea", Role::admin, 0);
  act({.who = "zoe", .role = "trainee", .what = "signIn"});
  ASSERT_TRUE(redact_person(store_, {"zoe", "", "erased person 1"}));
  const auto verified = [&] {
    return bool(store_.read([&](Reading& tx) { return verify_chain(tx, store_.audit_key()); }));
  };
  ASSERT_TRUE(verified());
  auto hand = database_.connection(Access::write);
  for (const char* who : {"eve", "zoe", "erased person 1"}) {
    ASSERT_TRUE(hand->begin(Access::write));
    ASSERT_TRUE(hand->query("update audit set who = ? where what = 'signIn'",
                            std::vector<Value>{std::string(who)}));
    ASSERT_TRUE(hand->commit());
    EXPECT_EQ(verified(), std::string(who) == "erased person 1" || std::string(who) == "zoe")
        << who;
  }
}

TEST_P(Erasing, NobodyIsErasedTwiceAndAPreviewChangesNothing) {
  add("zoe-id", "zoe", Role::trainee, 0);
  const Erasure wish{.account_id = "zoe-id", .begun_utc_us = 7};
  const std::size_t before = trail().size();
  const auto preview = preview_erasure(store_, wish);
  ASSERT_TRUE(preview) << preview.error().what;
  EXPECT_EQ(preview->rows.at("accounts"), 1u);
  EXPECT_EQ(trail().size(), before);
  EXPECT_EQ(store_.read([](Reading& tx) { return account_of(tx, "zoe-id"); }).value()->name, "zoe");
  const auto erase = [&] {
    return store_.write([&](Writing& tx) { return begin_erasure(tx, wish); });
  };
  ASSERT_TRUE(erase());
  EXPECT_EQ(erase().error().code, core::Errc::conflict);
  EXPECT_EQ(preview_erasure(store_, wish).error().code, core::Errc::conflict);
}

constexpr std::int64_t kDay_us = 86'400'000'000;

TEST_P(Erasing, ARetentionRuleNotesWaitsAndThenActs) {
  const std::int64_t now = 4000 * kDay_us;
  add("old", "old", Role::trainee, now - 800 * kDay_us);     // over 2 years of 365.25 days
  add("new", "new", Role::trainee, now - 700 * kDay_us);     // less
  add("fay", "fay", Role::faculty, now - 3000 * kDay_us);    // no trainee
  EXPECT_TRUE(keep_retention(store_, now).value().empty());  // no rules
  ASSERT_TRUE(store_.write([&](Writing& tx) {
    return add_retention_rules(tx, {.rules = {.inactive_years = 2, .notice_days = 30},
                                    .reason = "r",
                                    .made_utc_us = now,
                                    .made_by = "dora"});
  }));
  EXPECT_TRUE(keep_retention(store_, now).value().empty());
  const auto noticed = [&](std::int64_t at) {
    return store_
        .read([&](Reading& tx) { return inactive_people(tx, at - 730 * kDay_us - kDay_us / 2); })
        .value();
  };
  ASSERT_EQ(noticed(now).size(), 1u);
  EXPECT_EQ(noticed(now)[0].name, "old");
  EXPECT_EQ(noticed(now)[0].acts_utc_us, now + 30 * kDay_us);
  EXPECT_TRUE(keep_retention(store_, now + 29 * kDay_us).value().empty());
  EXPECT_EQ(keep_retention(store_, now + 30 * kDay_us).value(), std::vector<std::string>{"old"});
  EXPECT_TRUE(keep_retention(store_, now + 30 * kDay_us).value().empty());
  const auto erased = store_.read([](Reading& tx) { return all_erasures(tx); }).value();
  ASSERT_EQ(erased.size(), 1u);
  EXPECT_EQ(erased[0].cause, ErasureCause::retention);
  EXPECT_EQ(erased[0].mode, ErasureMode::anonymise);
}

TEST_P(Erasing, WhoComesBackInTheNoticePeriodStays) {
  const std::int64_t now = 4000 * kDay_us;
  add("old", "old", Role::trainee, now - 800 * kDay_us);
  ASSERT_TRUE(store_.write([&](Writing& tx) {
    return add_retention_rules(tx, {.rules = {.inactive_years = 2, .notice_days = 30},
                                    .reason = "r",
                                    .made_utc_us = now,
                                    .made_by = "dora"});
  }));
  ASSERT_TRUE(keep_retention(store_, now));
  ASSERT_TRUE(
      store_.write([&](Writing& tx) { return add_session(tx, "hash", "old", now + kDay_us); }));
  EXPECT_TRUE(keep_retention(store_, now + 40 * kDay_us).value().empty());
  const auto notices =
      store_.read([](Reading& tx) { return tx.query("select * from retention_notices"); });
  EXPECT_TRUE(notices.value().empty());
}

TEST_P(Erasing, OldSignInsLoseTheirAddressAfterTheNoticePeriod) {
  add("other", "bea", Role::admin, 0);
  const std::int64_t now = 4000 * kDay_us;
  const std::set<std::string> kinds{"signIn", "oidcSignIn", "ltiLaunch"};
  for (const std::string& what : kinds)
    act({.who = "bea",
         .role = "admin",
         .peer = "10.0.0.9",
         .what = what,
         .at_utc_us = now - 400 * kDay_us});
  act({.who = "bea",
       .role = "admin",
       .peer = "10.0.0.8",
       .what = "signIn",
       .at_utc_us = now - 40 * kDay_us});
  ASSERT_TRUE(store_.write([&](Writing& tx) {
    return add_retention_rules(tx, {.rules = {.sign_ins_months = 12, .notice_days = 30},
                                    .reason = "r",
                                    .made_utc_us = now,
                                    .made_by = "dora"});
  }));
  const auto peers = [&] {
    std::vector<std::string> out;
    for (const AuditRow& row : trail())
      if (kinds.contains(row.act.what)) out.push_back(row.act.peer);
    return out;
  };
  ASSERT_TRUE(keep_retention(store_, now + 29 * kDay_us));
  EXPECT_EQ(peers(), (std::vector<std::string>{"10.0.0.8", "10.0.0.9", "10.0.0.9", "10.0.0.9"}));
  ASSERT_TRUE(keep_retention(store_, now + 30 * kDay_us));
  EXPECT_EQ(peers(), (std::vector<std::string>{"10.0.0.8", "", "", ""}));
}

TEST_P(Erasing, RulesOutsideTheirRangesAreRefusedByName) {
  for (const auto& [text, field] : std::vector<std::pair<std::string, std::string>>{
           {R"({"inactive_years":0})", "/inactive_years"},
           {R"({"notice_days":6})", "/notice_days"},
           {R"({"inactive_mode":"forget"})", "/inactive_mode"},
           {R"({"sign_ins_months":241})", "/sign_ins_months"},
           {R"({"years":1})", "/years"}}) {
    const auto rules = RetentionRules::from_text(text, "body");
    ASSERT_FALSE(rules) << text;
    EXPECT_NE(rules.error().what.find(field), std::string::npos) << rules.error().what;
  }
}

}  // namespace
}  // namespace store
}  // namespace tractus
