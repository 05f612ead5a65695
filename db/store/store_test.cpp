/// What every driver behind Store must do, run on SQLite and on PostgreSQL.
#include "db/store/store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <limits>
#include <thread>
#include <type_traits>

#include "core/try.hpp"
#include "db/store/database/migrations.hpp"
#include "db/store/operations/jobs.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/people/sign_ins.hpp"
#include "db/store/store_test_support.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace store {
namespace {
using test_support::Content;
using test_support::TestDatabase;
using ::testing::HasSubstr;

static_assert(!std::is_convertible_v<Reading&, Writing&>, "a reading transaction cannot write");
static_assert(!std::is_invocable_v<decltype(&remove_session), Reading&, const std::string&>,
              "what changes something does not take a reading transaction");

struct Opened {
  explicit Opened(test_support::DatabaseKind kind) : database(kind), store(database.open()) {}
  TestDatabase database;
  Store store;
};

class StoreContract : public test_support::BothDatabases {};
class MigrationSteps : public test_support::BothDatabases {};
class JobQueue : public test_support::BothDatabases {};
class Logins : public test_support::BothDatabases {};
TRACTUS_ON_BOTH_DATABASES(StoreContract);
TRACTUS_ON_BOTH_DATABASES(MigrationSteps);
TRACTUS_ON_BOTH_DATABASES(JobQueue);
TRACTUS_ON_BOTH_DATABASES(Logins);

core::Result<std::uint64_t> rows_in(Reading& tx, const std::string& table) {
  auto rows = TRY(tx.query("select count(*) from " + table));
  return rows.front().count(0);
}

TEST_P(StoreContract, KeepsEveryValueToTheBit) {
  Opened db(GetParam());
  const core::Bytes blob{std::byte{0}, std::byte{255}, std::byte{7}};
  const double third = 1.0 / 3.0, tiny = std::numeric_limits<double>::denorm_min();
  const std::string text("quoted ' and ? and \xc3\xa9 \xf0\x9f\xa6\xb4");
  auto kept = db.store.write([&](Writing& tx) -> core::Result<Row> {
    TRY(
        tx.query("create table v (a bigint, b double precision, c text, d bytea, e text, f double "
                 "precision)"));
    auto rows = TRY(tx.query(
        "insert into v (a, b, c, d, e, f) values (?, ?, ?, ?, ?, ?) returning a, b, c, d, e, f",
        {std::int64_t{INT64_MIN}, third, text, blob, Value(), tiny}));
    return rows.front();
  });
  ASSERT_TRUE(kept) << kept.error().what;
  EXPECT_EQ(kept->integer(0), INT64_MIN);
  EXPECT_EQ(kept->number(1), third);
  EXPECT_EQ(kept->text(2), text);
  EXPECT_EQ(std::get<core::Bytes>(kept->value(3)), blob);
  EXPECT_FALSE(kept->text_or_null(4));
  EXPECT_EQ(kept->number(5), tiny);
}

TEST_P(StoreContract, ATextThatIsNotUtf8OrHoldsAZeroIsRefusedAndNothingElse) {
  // The examples of RFC 3629 and of Unicode's table 3-7: overlong, a surrogate, beyond U+10FFFF,
  // cut short; and the last character there is.
  Opened db(GetParam());
  const auto keep = [&](std::string text) {
    return db.store.write([&](Writing& tx) {
      return set_failures(tx, {Secret::account_password, text, "p"}, Total::pair, {1.0, 1});
    });
  };
  for (const std::string& bad :
       {std::string("a\0b", 3), std::string("\xc0\xaf"), std::string("\xed\xa0\x80"),
        std::string("\xf4\x90\x80\x80"), std::string("\xe2\x82"), std::string("\x80")}) {
    auto refused = keep(bad);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Errc::bad_input);
  }
  EXPECT_TRUE(keep("\xf4\x8f\xbf\xbf\xee\x80\x80"));
}

TEST_P(StoreContract, AWholeNumberInADoubleColumnComesBackAsADouble) {
  Opened db(GetParam());
  auto kept = db.store.write([](Writing& tx) -> core::Result<Row> {
    TRY(tx.query("create table v (b double precision)"));
    auto rows = TRY(tx.query("insert into v (b) values (?) returning b", {2.0}));
    return rows.front();
  });
  ASSERT_TRUE(kept) << kept.error().what;
  EXPECT_EQ(kept->number(0), 2.0);
}

TEST_P(StoreContract, AWriteThatFailsLeavesNothing) {
  Opened db(GetParam());
  auto outcome = db.store.write([](Writing& tx) -> core::Result<void> {
    TRY(add_account(tx, {"1", "ada", Role::admin, "hash"}, 5));
    return core::Error{core::Errc::cancelled, "changed my mind"};
  });
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, core::Errc::cancelled);
  EXPECT_EQ(db.store.read([](Reading& tx) { return account_count(tx); }).value(), 0u);
}

TEST_P(StoreContract, ARowWithAWordThatNobodyKnowsIsCorrupt) {
  Opened db(GetParam());
  const auto made = db.store.write([](Writing& tx) -> core::Result<void> {
    TRY(add_account(tx, {"1", "ada", Role::admin, "hash"}, 5));
    TRY(tx.query("update accounts set state = 'asleep' where id = '1'"));
    return {};
  });
  ASSERT_TRUE(made) << made.error().what;
  const auto one = db.store.read([](Reading& tx) { return account_of(tx, "1"); });
  ASSERT_FALSE(one);
  EXPECT_EQ(one.error().code, core::Errc::corrupt);
  EXPECT_EQ(one.error().what, "database: accounts.state: 'asleep' is none of active, disabled");
  const auto all = db.store.read([](Reading& tx) { return all_accounts(tx); });
  ASSERT_FALSE(all);
  EXPECT_EQ(all.error().code, core::Errc::corrupt);
}

TEST_P(StoreContract, AReadingConnectionIsRefusedWritesByTheDatabase) {
  Opened db(GetParam());
  auto outcome = db.store.read([](Reading& tx) -> core::Result<void> {
    TRY(tx.query("delete from accounts"));
    return {};
  });
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().what,
              ::testing::AnyOf(HasSubstr("readonly"), HasSubstr("read-only")));
}

TEST_P(StoreContract, AReaderSeesOneStateWhileAWriterCommits) {
  Opened db(GetParam());
  auto counts =
      db.store.read([&](Reading& tx) -> core::Result<std::pair<std::uint64_t, std::uint64_t>> {
        const auto before = rows_in(tx, "accounts").value();
        TRY(db.store.write([](Writing& w) {
          return add_account(w, {"1", "ada", Role::admin, "hash"}, 5);
        }));
        return std::pair(before, rows_in(tx, "accounts").value());
      });
  ASSERT_TRUE(counts) << counts.error().what;
  EXPECT_EQ(*counts, std::pair(std::uint64_t{0}, std::uint64_t{0}));
  EXPECT_EQ(db.store.read([](Reading& tx) { return account_count(tx); }).value(), 1u);
}

TEST_P(StoreContract, AForeignKeyThatPointsNowhereIsAConflict) {
  Opened db(GetParam());
  auto outcome = db.store.write([](Writing& tx) { return add_session(tx, "token", "nobody", 5); });
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, core::Errc::conflict);
}

TEST_P(StoreContract, ANameIsTakenOnce) {
  Opened db(GetParam());
  const auto add = [&](const char* id) {
    return db.store.write([&](Writing& tx) {
      return add_account(tx, {id, "ada", Role::admin, "hash"}, 5);
    });
  };
  EXPECT_TRUE(add("1"));
  auto again = add("2");
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, core::Errc::conflict);
  EXPECT_NE(again.error().what.find("ada"), std::string::npos);
}

TEST_P(StoreContract, WhatWasCommittedIsThereAfterReopening) {
  const TestDatabase database(GetParam());
  {
    auto store = database.open();
    ASSERT_TRUE(store.write([](Writing& tx) {
      return add_account(tx, {"1", "ada", Role::admin, "hash"}, 5);
    }));
  }
  auto store = database.open();
  auto account = store.read([](Reading& tx) { return account_named(tx, "ada"); });
  ASSERT_TRUE(account);
  ASSERT_TRUE(account->has_value());
  EXPECT_EQ((*account)->password_hash, "hash");
}

TEST(Migrations, BeginAtOneAndEachHasANumberOfItsOwn) {
  const auto steps = migrations();
  ASSERT_FALSE(steps.empty());
  EXPECT_EQ(steps.front().version, 1);
  for (std::size_t i = 1; i < steps.size(); ++i)
    EXPECT_GT(steps[i].version, steps[i - 1].version) << steps[i].name;
}

/// Two branches of the product each add a step; whoever ran the later number first still gets the
/// other.
TEST_P(MigrationSteps, AStepIsAppliedThoughALaterOneAlreadyWas) {
  const TestDatabase database(GetParam(), Content::nothing);
  const auto connection = database.connection(Access::write);
  const Migration first{1, "first", "create table a (x bigint)"},
      second{2, "second", "create table b (x bigint)"},
      third{3, "third", "create table c (x bigint)"};
  ASSERT_TRUE(migrate(*connection, {first, third}));
  ASSERT_TRUE(migrate(*connection, {first, second, third}));
  EXPECT_TRUE(connection->query("select x from b", {}));
}

TEST_P(MigrationSteps, ANewerDatabaseIsRefusedByNumber) {
  const TestDatabase database(GetParam(), Content::nothing);
  const auto connection = database.connection(Access::write);
  const std::vector<Migration> newer{{1, "first", "create table a (x bigint)"},
                                     {2, "second", "create table b (x bigint)"}};
  ASSERT_TRUE(migrate(*connection, newer));
  auto refused = migrate(*connection, {newer.front()});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::conflict);
  EXPECT_NE(refused.error().what.find("schema 2"), std::string::npos) << refused.error().what;
}

TEST_P(MigrationSteps, AStepThatBreaksLeavesTheDatabaseAsItWas) {
  const TestDatabase database(GetParam(), Content::nothing);
  const auto connection = database.connection(Access::write);
  const Migration first{1, "first", "create table a (x bigint)"};
  auto broken = migrate(
      *connection, {first, {2, "second", "create table b (x bigint); create table a (x bigint)"}});
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().what.find("0002_second"), std::string::npos) << broken.error().what;
  EXPECT_FALSE(connection->query("select x from a", {})) << "the step before was kept";
  ASSERT_TRUE(migrate(*connection, {first, {2, "second", "create table b (y bigint)"}}));
  EXPECT_TRUE(connection->query("select y from b", {}));
}

TEST_P(MigrationSteps, AreTriedWithoutAChange) {
  const TestDatabase database(GetParam(), Content::nothing);
  const auto connection = database.connection(Access::write);
  const Migration first{1, "first", "create table a (x bigint)"};
  const Migration second{2, "second", "create table b (x bigint)"};
  ASSERT_TRUE(migrate(*connection, {first}));
  const auto tried = try_migrations(*connection, {first, second});
  ASSERT_TRUE(tried);
  ASSERT_EQ(tried->size(), 1u);
  EXPECT_EQ(tried->front().name, "second");
  EXPECT_FALSE(connection->query("select x from b", {}));
  EXPECT_FALSE(try_migrations(*connection, {first, {2, "second", "create table a (x bigint)"}}));
  ASSERT_TRUE(migrate(*connection, {first, second}));
  EXPECT_EQ(try_migrations(*connection, {first, second})->size(), 0u);
}

/// Without giving way, PostgreSQL would end the knot of the two by failing one of them.
TEST_P(MigrationSteps, GiveWayToAReaderOfATableThatTheyChange) {
  const TestDatabase database(GetParam(), Content::nothing);
  const auto connection = database.connection(Access::write);
  const Migration first{1, "first", "create table a (x bigint); create table b (x bigint)"};
  const Migration second{2, "second",
                         "alter table b add column y bigint; alter table a add column y bigint"};
  ASSERT_TRUE(migrate(*connection, {first}));
  const auto reader = database.connection(Access::read);
  ASSERT_TRUE(reader->begin(Access::read));
  ASSERT_TRUE(reader->query("select x from a", {}));
  auto migrated = std::async([&] { return migrate(*connection, {first, second}); });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const auto read = reader->query("select x from b", {});
  EXPECT_TRUE(read) << read.error().what;
  reader->rollback();
  const auto done = migrated.get();
  EXPECT_TRUE(done) << done.error().what;
  EXPECT_TRUE(connection->query("select a.y, b.y from a, b", {}));
}

/// A database from before the column: an assignment is told by its row in `assignments`.
TEST_P(MigrationSteps, StudiesAndAssignmentsOfAnOlderDatabaseGetTheirKind) {
  const TestDatabase database(GetParam(), Content::nothing);
  const auto connection = database.connection(Access::write);
  auto older = migrations();
  std::erase_if(older, [](const Migration& step) { return step.version >= 16; });
  ASSERT_TRUE(migrate(*connection, older));
  ASSERT_TRUE(
      connection->query("insert into accounts (id, name, role, password_hash, made_utc_us) "
                        "values ('fay', 'fay', 'faculty', 'x', 1)",
                        {}));
  for (const char* id : {"'a-study'", "'spine'"})
    ASSERT_TRUE(connection->query(
        std::string("insert into studies (id, title, state, ordering, repeats, seed, on_invalid, "
                    "made_utc_us, made_by) values (") +
            id + ", '', 'running', 'random', 1, 1, 'at_end', 1, 'ada')",
        {}));
  ASSERT_TRUE(
      connection->query("insert into assignments (study_id, release, made_by_id) values ('spine', "
                        "'held', 'fay')",
                        {}));
  ASSERT_TRUE(migrate(*connection, migrations()));
  const auto rows = connection->query("select id, kind from studies order by id", {});
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 2u);
  EXPECT_EQ((*rows)[0].text(1), "study");
  EXPECT_EQ((*rows)[1].text(1), "assignment");
}

TEST_P(JobQueue, AreClaimedOnceInTheOrderTheyWereQueued) {
  Opened db(GetParam());
  auto claimed = db.store.write([](Writing& tx) -> core::Result<std::vector<std::string>> {
    TRY(queue_job(tx, JobKind::metrics, "later", 20));
    TRY(queue_job(tx, JobKind::metrics, "sooner", 10));
    std::vector<std::string> subjects;
    while (true) {
      auto job = TRY(claim_job(tx, {JobKind::metrics}, 30));
      if (!job.has_value()) return subjects;
      subjects.push_back(job->subject);
    }
  });
  ASSERT_TRUE(claimed) << claimed.error().what;
  EXPECT_EQ(*claimed, (std::vector<std::string>{"sooner", "later"}));
}

TEST_P(JobQueue, WhatADeadProcessHadClaimedWaitsAgainAndCountsItsAttempts) {
  Opened db(GetParam());
  auto again = db.store.write([](Writing& tx) -> core::Result<std::optional<Job>> {
    TRY(queue_job(tx, JobKind::metrics, "t", 10));
    TRY(claim_job(tx, {JobKind::metrics}, 20));
    TRY(requeue_claimed_jobs(tx, 30));
    return claim_job(tx, {JobKind::metrics}, 40);
  });
  ASSERT_TRUE(again) << again.error().what;
  ASSERT_TRUE(again->has_value());
  EXPECT_EQ((*again)->attempts, 2u);
}

TEST_P(JobQueue, AJobWhoseLeaseIsOverWaitsAgainAndIsItsFormerOwnersNoMore) {
  Opened db(GetParam());
  const Worker slow{"slow", 100}, quick{"quick", 100};
  auto outcome = db.store.write([&](Writing& tx) -> core::Result<void> {
    TRY(queue_job(tx, JobKind::metrics, "t", 10));
    auto first = TRY(claim_job(tx, {JobKind::metrics}, 20, slow));
    EXPECT_EQ(requeue_lapsed_jobs(tx, 119).value(), 0u) << "the lease holds until 120";
    EXPECT_EQ(renew_claims(tx, slow, 50).value(), std::vector<std::string>{first->id});
    EXPECT_EQ(requeue_lapsed_jobs(tx, 150).value(), 0u) << "renewed at 50, until 150";
    EXPECT_EQ(requeue_lapsed_jobs(tx, 151).value(), 1u);
    auto second = TRY(claim_job(tx, {JobKind::metrics}, 160, quick));
    EXPECT_EQ(second->attempts, 2u);
    EXPECT_TRUE(renew_claims(tx, slow, 170).value().empty());
    auto late = finish_job(tx, *first, 180);
    EXPECT_TRUE(!late && late.error().code == core::Errc::conflict);
    return finish_job(tx, *second, 190);
  });
  EXPECT_TRUE(outcome) << outcome.error().what;
}

TEST_P(JobQueue, AJobKeepsItsTraceForWhoeverClaimsIt) {
  Opened db(GetParam());
  // The example of W3C Trace Context, section 3.2.
  const std::string trace = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";
  auto outcome = db.store.write([&](Writing& tx) -> core::Result<void> {
    TRY(queue_job(tx, JobKind::metrics, "t", 10, trace));
    TRY(queue_job(tx, JobKind::metrics, "without", 20));
    auto first = TRY(claim_job(tx, {JobKind::metrics}, 30, {"dies", 100}));
    EXPECT_EQ(first->traceparent, trace);
    TRY(requeue_lapsed_jobs(tx, 500));
    auto again = TRY(claim_job(tx, {JobKind::metrics}, 510, {"lives", 100}));
    EXPECT_EQ(again->traceparent, trace);
    auto other = TRY(claim_job(tx, {JobKind::metrics}, 510, {"lives", 100}));
    EXPECT_EQ(other->traceparent, "");
    return {};
  });
  EXPECT_TRUE(outcome) << outcome.error().what;
}

TEST_P(JobQueue, AJobLeftOffWaitsAgainAndTheAttemptDoesNotCount) {
  Opened db(GetParam());
  auto again = db.store.write([](Writing& tx) -> core::Result<std::optional<Job>> {
    TRY(queue_job(tx, JobKind::lab, "t", 10));
    auto first = TRY(claim_job(tx, {JobKind::lab}, 20));
    TRY(give_back_job(tx, *first, 30));
    return claim_job(tx, {JobKind::lab}, 40);
  });
  ASSERT_TRUE(again && again->has_value());
  EXPECT_EQ((*again)->attempts, 1u);
}

TEST_P(Logins, FailuresAreOfAKindOfSecretANameAndAnOrigin) {
  Opened db(GetParam());
  const Attempt account{Secret::account_password, "102", "10.0.0.1"};
  auto done = db.store.write([&](Writing& tx) -> core::Result<void> {
    TRY(set_failures(tx, account, Total::pair, {3.5, 20}));
    TRY(set_failures(tx, account, Total::pair, {4.5, 30}));
    return set_failures(tx, account, Total::origin, {7.0, 30});
  });
  ASSERT_TRUE(done) << done.error().what;
  const auto count = [&](const Attempt& attempt, Total total) {
    return db.store.read([&](Reading& tx) { return failures_of(tx, attempt, total); })
        .value()
        .count;
  };
  EXPECT_EQ(count(account, Total::pair), 4.5);
  EXPECT_EQ(count(account, Total::name), 0.0);
  EXPECT_EQ(count({Secret::account_password, "ada", "10.0.0.1"}, Total::origin), 7.0);
  EXPECT_EQ(count({Secret::badge_pin, "102", "10.0.0.1"}, Total::pair), 0.0);
  EXPECT_EQ(count({Secret::account_password, "102", "10.0.0.2"}, Total::pair), 0.0);
  done = db.store.write([&](Writing& tx) -> core::Result<void> {
    return clear_failures_of_name(tx, Secret::account_password, "102");
  });
  ASSERT_TRUE(done);
  EXPECT_EQ(count(account, Total::pair), 0.0);
  EXPECT_EQ(count(account, Total::origin), 7.0) << "of all names";
}

TEST_P(Logins, AnOriginIsKnownByTheAccountThatGotInFromIt) {
  Opened db(GetParam());
  const Attempt in{Secret::account_password, "ada", "10.0.0.1"};
  const auto known = [&](const Attempt& attempt) {
    return db.store.read([&](Reading& tx) { return is_known_origin(tx, attempt); }).value();
  };
  auto done = db.store.write([&](Writing& tx) -> core::Result<void> {
    for (const auto& [id, name] : {std::pair{"1", "ada"}, {"2", "bob"}})
      TRY(add_account(tx, {id, name, Role::admin, "hash"}, 0));
    return note_origin(tx, "1", in, 10, 0);
  });
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_TRUE(known(in));
  EXPECT_FALSE(known({Secret::account_password, "bob", "10.0.0.1"}));
  EXPECT_FALSE(known({Secret::account_password, "ada", "10.0.0.2"}));
  EXPECT_FALSE(known({Secret::badge_pin, "ada", "10.0.0.1"}));
  done = db.store.write([&](Writing& tx) {
    return note_origin(tx, "1", {in.secret, "ada", "10.0.0.2"}, 30, 20);
  });
  ASSERT_TRUE(done);
  EXPECT_FALSE(known(in)) << "not seen since 20";
}

}  // namespace
}  // namespace store
}  // namespace tractus
