/// What several processes on one PostgreSQL database rely on. Each has a Store of its own; here
/// they are in one process, which the database cannot tell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <future>
#include <mutex>
#include <set>
#include <thread>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/database/postgres_link.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/operations/jobs.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/people/sign_ins.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace store {
namespace {
using test_support::DatabaseKind;
using test_support::TestDatabase;

class SharedDatabase : public ::testing::TestWithParam<DatabaseKind> {
 protected:
  /// Every connection of both is cut by the server.
  void cut_all_connections() {
    auto apart = database_.connection(Access::write);
    ASSERT_TRUE(apart->begin(Access::beside) && apart->commit());
    ASSERT_TRUE(
        apart->query("select pg_terminate_backend(pid) from pg_stat_activity where datname = "
                     "current_database() and pid <> pg_backend_pid()",
                     {}));
  }
  TestDatabase database_{GetParam()};
  Store one_ = database_.open(), other_ = database_.open();
};
INSTANTIATE_TEST_SUITE_P(PostgreSQL, SharedDatabase, ::testing::Values(DatabaseKind::postgresql));

TEST_P(SharedDatabase, TheAuditTrailIsOneChainWhoeverWrites) {
  constexpr int kEach = 40;
  const AuditKey key{std::byte{3}};
  const auto act = [&](Store& store, const std::string& who) {
    store.set_audit_key(key);
    for (int i = 0; i < kEach; ++i) {
      const AuditScope acting(
          {.who = who, .role = "admin", .what = "deed", .object = std::to_string(i)});
      EXPECT_TRUE(store.write([&](Writing& tx) {
        const Attempt attempt{Secret::account_password, who, std::to_string(i)};
        return set_failures(tx, attempt, Total::pair, {1.0, 1});
      }));
    }
  };
  std::thread first([&] { act(one_, "ada"); }), second([&] { act(other_, "bob"); });
  first.join();
  second.join();
  auto end = one_.read([&](Reading& tx) { return verify_chain(tx, key); });
  ASSERT_TRUE(end) << end.error().what;
  EXPECT_EQ(end->number, 2 * kEach);
}

TEST_P(SharedDatabase, AWriteSeesWhatTheOneBeforeItDid) {
  constexpr int kEach = 60;
  ASSERT_TRUE(one_.write([](Writing& tx) { return add_station(tx, {"s", "0"}, "token", 1); }));
  const auto count_up = [](Store& store) {
    for (int i = 0; i < kEach; ++i)
      EXPECT_TRUE(store.write([](Writing& tx) -> core::Result<Rows> {
        auto name = station_name(tx, "s");  // read, then written: lost if two did it at once
        if (!name) return name.error();
        return tx.query("update stations set name = ? where id = 's'",
                        {std::to_string(std::stoi(*name) + 1)});
      }));
  };
  std::thread first([&] { count_up(one_); }), second([&] { count_up(other_); });
  first.join();
  second.join();
  EXPECT_EQ(one_.read([](Reading& tx) { return station_name(tx, "s"); }).value(),
            std::to_string(2 * kEach));
}

TEST_P(SharedDatabase, EveryJobIsClaimedOnceByWhoeverComesFirst) {
  constexpr int kJobs = 60;
  ASSERT_TRUE(one_.write([](Writing& tx) -> core::Result<void> {
    for (int i = 0; i < kJobs; ++i) TRY(queue_job(tx, JobKind::metrics, std::to_string(i), i));
    return {};
  }));
  std::mutex mutex;
  std::multiset<std::string> claimed;
  const auto work = [&](Store& store, const std::string& id) {
    while (true) {
      auto job = store.write_beside(
          [&](Writing& tx) { return claim_job(tx, {JobKind::metrics}, 100, Worker{id}); });
      ASSERT_TRUE(job) << job.error().what;
      if (!job->has_value()) return;
      const std::lock_guard held(mutex);
      claimed.insert((*job)->subject);
    }
  };
  std::vector<std::thread> workers;
  for (int i = 0; i < 4; ++i)
    workers.emplace_back([&, i] { work(i % 2 ? one_ : other_, std::to_string(i)); });
  for (std::thread& worker : workers) worker.join();
  EXPECT_EQ(claimed.size(), std::size_t{kJobs});
  EXPECT_EQ(std::set<std::string>(claimed.begin(), claimed.end()).size(), std::size_t{kJobs});
}

TEST_P(SharedDatabase, WhatIsReadUnderANameSeesWhatWhoHeldItBeforeDid) {
  const auto rename = [](const char* name) {
    return [name](Writing& tx) {
      return tx.query("update stations set name = ? where id = 's'", {name});
    };
  };
  ASSERT_TRUE(one_.write([](Writing& tx) { return add_station(tx, {"s", "0"}, "token", 1); }));
  auto mine = one_.hold("upload 7");
  ASSERT_TRUE(mine);
  auto theirs = std::async(std::launch::async, [&] {
    return other_.hold_and_query(
        "upload 7", {.sql = "select name from stations where id = ?", .values = {"s"}});
  });
  EXPECT_EQ(theirs.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  ASSERT_TRUE(one_.write(rename("1")));
  mine->reset();
  auto found = theirs.get();
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(found->second.front().text(0), "1");
}

TEST_P(SharedDatabase, ManyWhoReadUnderANameEachHoldItAlone) {
  constexpr int kEach = 100;
  ASSERT_TRUE(one_.write([](Writing& tx) { return add_station(tx, {"s", "0"}, "token", 1); }));
  const auto count_up = [](Store& store) {
    for (int i = 0; i < kEach; ++i) {
      auto held = store.hold_and_query(
          "upload 7",
          {.sql = "select id, name, token_hash from stations where id = ?", .values = {"s"}});
      ASSERT_TRUE(held) << held.error().what;
      ASSERT_EQ(held->second.size(), 1u);
      const int next = std::stoi(held->second.front().text(1)) + 1;
      EXPECT_TRUE(store.write([&](Writing& tx) {
        return tx.query("update stations set name = ? where id = 's'", {std::to_string(next)});
      }));
    }
  };
  std::vector<std::thread> workers;
  for (Store* store : {&one_, &other_, &one_, &other_})
    workers.emplace_back([&, store] { count_up(*store); });
  for (std::thread& worker : workers) worker.join();
  EXPECT_EQ(one_.read([](Reading& tx) { return station_name(tx, "s"); }).value(),
            std::to_string(4 * kEach));
}

TEST_P(SharedDatabase, WhatIsReadUnderANameIsNotMixedWithWhetherAnotherIsHeld) {
  ASSERT_TRUE(one_.write([](Writing& tx) { return add_station(tx, {"s", "0"}, "token", 1); }));
  auto mine = one_.hold("upload 7");
  ASSERT_TRUE(mine);
  auto waits = std::async(std::launch::async, [&] { return bool(other_.hold("upload 7")); });
  for (int i = 0; i < 20; ++i) {  // while the line that they share says again and again: not yet
    auto found = other_.hold_and_query(
        "upload 8", {.sql = "select id, name from stations where id = ?", .values = {"s"}});
    ASSERT_TRUE(found) << found.error().what;
    ASSERT_EQ(found->second.size(), 1u);
    EXPECT_EQ(found->second.front().text(1), "0");
    found->first.reset();
    std::this_thread::sleep_for(std::chrono::milliseconds(7));
  }
  mine->reset();
  EXPECT_TRUE(waits.get());
}

TEST_P(SharedDatabase, ANameIsFreeAgainWhenWhatWasToBeReadFails) {
  const Statement unknown{.sql = "select none from stations", .values = {}};
  const Statement by_zero{.sql = "select 1 / (select count(*) from stations where id = 'none')",
                          .values = {}};
  EXPECT_FALSE(other_.hold_and_query("upload 7", unknown));
  EXPECT_TRUE(one_.hold("upload 7"));
  EXPECT_FALSE(other_.hold_and_query("upload 7", by_zero))
      << "it fails only once it runs, when the name is held";
  EXPECT_TRUE(one_.hold("upload 7"));
}

TEST_P(SharedDatabase, ANameIsHeldByOneUntilItLetsGo) {
  auto mine = one_.hold("upload 7");
  ASSERT_TRUE(mine);
  std::atomic<bool> let_go = false;
  auto theirs = std::async(std::launch::async, [&] {
    auto held = other_.hold("upload 7");
    EXPECT_TRUE(held);
    EXPECT_TRUE(let_go) << "two hold it at once";
  });
  EXPECT_TRUE(other_.hold("upload 8")) << "another name waits for nobody";
  let_go = true;
  mine->reset();
  theirs.get();
}

TEST_P(SharedDatabase, AConnectionThatBrokeIsMadeAnew) {
  ASSERT_TRUE(one_.read([](Reading& tx) { return account_count(tx); }));
  cut_all_connections();
  EXPECT_TRUE(one_.read([](Reading& tx) { return account_count(tx); }));
  EXPECT_TRUE(one_.write([](Writing& tx) { return add_station(tx, {"s", "n"}, "t", 1); }));
  EXPECT_TRUE(one_.hold("a name"));
}

TEST_P(SharedDatabase, SignalsReachTheOthersAndABreakIsTold) {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Signal> heard;
  auto listening = other_.signals().listen("live", [&](const Signal& signal) {
    const std::lock_guard held(mutex);
    heard.push_back(signal);
    changed.notify_all();
  });
  ASSERT_TRUE(listening);
  const auto wait_for = [&](std::size_t count) {
    std::unique_lock held(mutex);
    return changed.wait_for(held, std::chrono::seconds(20), [&] { return heard.size() >= count; });
  };
  ASSERT_TRUE(one_.signals().send("live", "hello"));
  ASSERT_TRUE(wait_for(1));
  EXPECT_EQ(heard[0].from, one_.signals().own_id());
  EXPECT_EQ(heard[0].payload, "hello");
  cut_all_connections();
  ASSERT_TRUE(wait_for(2));
  EXPECT_TRUE(heard[1].from.empty() && heard[1].payload.empty()) << "that something may be missing";
  ASSERT_TRUE(one_.signals().send("live", "again"));
  ASSERT_TRUE(wait_for(3));
  EXPECT_EQ(heard[2].payload, "again");
}

TEST(PostgresText, NumbersThePlaceholdersOutsideOfQuotesAndOpensWhatIsItsOwn) {
  EXPECT_EQ(postgres_text("select '?' || a from t where b = ? and c = ? /*pg: for update */"),
            "select '?' || a from t where b = $1 and c = $2  for update ");
}

TEST(PostgresAddress, SaysWhetherItHoldsAPassword) {
  EXPECT_TRUE(has_password("postgresql://ada:secret@db/tractus"));
  EXPECT_TRUE(has_password("host=db password=secret"));
  EXPECT_FALSE(has_password("postgresql://ada@db/tractus"));
}

}  // namespace
}  // namespace store
}  // namespace tractus
