/// Signals arrive in order, once, and only of what was committed.
#include "db/store/database/signals.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>

#include "core/try.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace store {
namespace {

/// What was heard, for a test to wait for.
class Ear {
 public:
  Signals::Heard heard() {
    return [this](const Signal& signal) {
      const std::lock_guard held(mutex_);
      payloads_.push_back(signal.payload);
      senders_.push_back(signal.from);
      changed_.notify_all();
    };
  }
  /// The first `count` payloads; fails the test when they do not come.
  std::vector<std::string> first(std::size_t count) {
    std::unique_lock held(mutex_);
    EXPECT_TRUE(changed_.wait_for(held, std::chrono::seconds(20),
                                  [&] { return payloads_.size() >= count; }));
    return payloads_;
  }
  std::string sender() {
    const std::lock_guard held(mutex_);
    return senders_.empty() ? "" : senders_.front();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> payloads_, senders_;
};

struct Furnished {
  explicit Furnished(test_support::DatabaseKind kind) : database(kind), store(database.open()) {}
  test_support::TestDatabase database;
  Store store;
};

class SignalsContract : public test_support::BothDatabases {};
TRACTUS_ON_BOTH_DATABASES(SignalsContract);

TEST_P(SignalsContract, OneSendersArriveInOrderAndSayWhoSentThem) {
  Furnished db(GetParam());
  Ear ear;
  auto listening = db.store.signals().listen("live", ear.heard());
  ASSERT_TRUE(listening);
  std::vector<std::string> sent;
  for (int i = 0; i < 100; ++i) {
    sent.push_back(std::to_string(i));
    ASSERT_TRUE(db.store.signals().send("live", sent.back()));
  }
  EXPECT_EQ(ear.first(100), sent);
  EXPECT_EQ(ear.sender(), db.store.signals().own_id());
}

TEST_P(SignalsContract, OfAWriteAreHeardWhenItCommitsAndNotWhenItFails) {
  Furnished db(GetParam());
  Ear ear;
  auto listening = db.store.signals().listen("jobs", ear.heard());
  ASSERT_TRUE(listening);
  auto failed = db.store.write([](Writing& tx) -> core::Result<void> {
    TRY(notify(tx, "jobs", "never"));
    return core::Error{core::Errc::cancelled, "changed my mind"};
  });
  EXPECT_FALSE(failed);
  ASSERT_TRUE(db.store.write([](Writing& tx) { return notify(tx, "jobs", "committed"); }));
  EXPECT_EQ(ear.first(1), std::vector<std::string>{"committed"});
}

TEST_P(SignalsContract, OfAnotherChannelAreNotHeard) {
  Furnished db(GetParam());
  Ear ear;
  auto listening = db.store.signals().listen("live", ear.heard());
  ASSERT_TRUE(listening);
  ASSERT_TRUE(db.store.signals().send("jobs", "elsewhere"));
  ASSERT_TRUE(db.store.signals().send("live", "here"));
  EXPECT_EQ(ear.first(1), std::vector<std::string>{"here"});
}

TEST_P(SignalsContract, AListenerMaySendAndMayEndWhileOthersAreSpoken) {
  Furnished db(GetParam());
  Ear ear, second;
  Signals& signals = db.store.signals();
  auto answering = signals.listen("ask", [&](const Signal& signal) {
    EXPECT_TRUE(signals.send("answer", signal.payload + "!"));
  });
  ASSERT_TRUE(answering);
  auto listening = signals.listen("answer", ear.heard());
  ASSERT_TRUE(listening);
  ASSERT_TRUE(signals.send("ask", "one"));
  EXPECT_EQ(ear.first(1), std::vector<std::string>{"one!"});
  answering->reset();
  auto other = signals.listen("ask", second.heard());
  ASSERT_TRUE(other);
  ASSERT_TRUE(signals.send("ask", "two"));
  EXPECT_EQ(second.first(1), std::vector<std::string>{"two"});
  EXPECT_EQ(ear.first(1).size(), 1u);
}

TEST_P(SignalsContract, OneThatIsTooLongIsRefused) {
  Furnished db(GetParam());
  const std::string most(Signals::kMostPayload_bytes, 'x');
  EXPECT_TRUE(db.store.signals().send("live", most));
  auto refused = db.store.signals().send("live", most + "x");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::too_large);
}

}  // namespace
}  // namespace store
}  // namespace tractus
