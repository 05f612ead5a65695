#include "db/store/operations/audit.hpp"

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace store {
namespace {

AuditKey key_of(unsigned char first) {
  AuditKey key{};
  key[0] = std::byte{first};
  return key;
}

/// Nine acts, each with a change.
class AuditTrail : public test_support::BothDatabases {
 protected:
  AuditTrail() {
    store_.set_audit_key(key_);
    for (int i = 1; i <= 9; ++i) {
      const AuditScope acting({.who = "ada",
                               .role = "admin",
                               .peer = "::1",
                               .what = "deed" + std::to_string(i),
                               .object = "id=" + std::to_string(i),
                               .detail = "{}",
                               .at_utc_us = i});
      EXPECT_TRUE(store_.write(
          [&](Writing& tx) { return add_object(tx, std::string(64, char('0' + i)), 1, i); }));
    }
  }
  core::Result<ChainEnd> check(const AuditKey& key) {
    return store_.read([&](Reading& tx) { return verify_chain(tx, key); });
  }
  void tamper(const std::string& sql) {
    const auto done = store_.write([&](Writing& tx) { return tx.query(sql); });
    ASSERT_TRUE(done) << done.error().what;
  }
  std::string failure() {
    const auto end = check(key_);
    return end ? "" : end.error().what;
  }

  const AuditKey key_ = key_of(7);
  test_support::TestDatabase database_{GetParam()};
  Store store_ = database_.open();
};
TRACTUS_ON_BOTH_DATABASES(AuditTrail);

TEST_P(AuditTrail, HoldsAsItWasWritten) {
  const auto end = check(key_);
  ASSERT_TRUE(end) << end.error().what;
  EXPECT_EQ(end->number, 9);
  EXPECT_EQ(end->hash.size(), 64u);
}

TEST_P(AuditTrail, EveryFieldOfEveryRowIsCovered) {
  const std::vector<std::string> changes{
      "at_utc_us = at_utc_us + 1", "who = 'eve'", "role = 'trainee'", "peer = ''",
      "what = what || ' '", "object = '='", "detail = '[]'", "hash = lower(hash || '0')",
      // the same text, its border between two fields moved
      "who = 'ad', role = 'aadmin'"};
  for (const std::string& change : changes)
    for (int row = 1; row <= 9; ++row) {
      tamper("create table kept as select * from audit");
      tamper("update audit set " + change + " where number = " + std::to_string(row));
      EXPECT_NE(failure().find("row " + std::to_string(row)), std::string::npos)
          << change << " in row " << row << ": " << failure();
      tamper("delete from audit");
      tamper("insert into audit select * from kept");
      tamper("drop table kept");
    }
  EXPECT_EQ(failure(), "");
}

TEST_P(AuditTrail, ARowTakenOutIsSeen) {
  tamper("delete from audit where number = 4");
  EXPECT_NE(failure().find("row 4: is missing"), std::string::npos) << failure();
}

TEST_P(AuditTrail, ARowTakenOutIsSeenThoughTheOthersMoveUp) {
  tamper("delete from audit where number = 4");
  tamper("update audit set number = -number where number > 4");
  tamper("update audit set number = -number - 1 where number < 0");
  EXPECT_NE(failure().find("row 4"), std::string::npos) << failure();
}

TEST_P(AuditTrail, TwoRowsThatChangePlacesAreSeen) {
  tamper("update audit set number = 100 where number = 3");
  tamper("update audit set number = 3 where number = 6");
  tamper("update audit set number = 6 where number = 100");
  EXPECT_NE(failure().find("row 3"), std::string::npos) << failure();
}

/// Who can write to the database but has not the key.
TEST_P(AuditTrail, AChainRewrittenWithAnotherKeyIsSeen) { EXPECT_FALSE(check(key_of(8))); }

TEST_P(AuditTrail, AChangeThatFailsLeavesNoRow) {
  const AuditScope acting({.who = "ada", .what = "fails", .detail = "{}"});
  const auto done = store_.write([&](Writing& tx) -> core::Result<void> {
    TRY(add_object(tx, std::string(64, 'x'), 1, 1));
    return core::Error{core::Errc::conflict, "thought better of it"};
  });
  EXPECT_FALSE(done);
  EXPECT_EQ(check(key_).value().number, 9);
}

TEST_P(AuditTrail, OneActIsOneRowHoweverManyWritesItTakes) {
  const AuditScope acting({.who = "ada", .what = "twice", .detail = "{}"});
  for (const char name : {'x', 'y'})
    ASSERT_TRUE(
        store_.write([&](Writing& tx) { return add_object(tx, std::string(64, name), 1, 1); }));
  EXPECT_EQ(check(key_).value().number, 10);
}

TEST_P(AuditTrail, WithoutAnActNothingIsNoted) {
  ASSERT_TRUE(
      store_.write([&](Writing& tx) { return add_object(tx, std::string(64, 'x'), 1, 1); }));
  EXPECT_EQ(check(key_).value().number, 9);
}

}  // namespace
}  // namespace store
}  // namespace tractus
