/// All rows from one kind of database into the other, and back.
#include "db/store/database/copy.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/studies/study_slots.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace store {
namespace {
using test_support::DatabaseKind;
using test_support::TestDatabase;

/// Rows that refer to others, to themselves, and hold every type there is in the schema.
core::Result<void> furnish_tables(Writing& tx) {
  const std::string kA(64, 'a');
  TRY(add_account(tx, {"1", "ada", Role::admin, "hash"}, 1));
  TRY(add_station(tx, {"s", "station-1"}, "token", 1));
  TRY(add_case(tx, {kA, "L3", "made", 1, 0}, {{"case.json", kA, 9, false}}, 1));
  const Study study{.id = "study", .title = "\xc3\xa9", .ordering = CaseOrder::random};
  auto id = TRY(add_study(tx, study, {kA}, {"ada", 1}));
  const Participant person{.name = "P1", .experience_years = 1.0 / 3.0};
  TRY(add_participant(tx, id, person, {kA, kA}, {"ada", 1}));
  // Two that refer to each other: neither can be first.
  auto slots = TRY(study_slots(tx, id));
  for (int i = 0; i < 2; ++i) {
    TRY(tx.query("update study_slots set repeat_of = ? where id = ?",
                 {slots.at(std::size_t(1 - i)).id, slots.at(std::size_t(i)).id}));
  }
  return {};
}

/// Everything in it, by table, each row as text, in an order that no database chooses.
std::map<std::string, std::multiset<std::string>> tables_of(Store& store) {
  std::map<std::string, std::multiset<std::string>> out;
  auto read = store.read([&](Reading& tx) -> core::Result<void> {
    auto tables = TRY(tx.tables());
    for (const Table& table : tables) {
      if (table.name == "schema_versions") continue;
      std::string columns;
      for (const std::string& column : table.columns)
        columns += (columns.empty() ? "" : ", ") + column;
      auto rows = TRY(tx.query("select " + columns + " from " + table.name));
      for (const Row& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
          const Value& value = row.value(i);
          line += std::to_string(value.index()) + ":";
          if (const auto* text = std::get_if<std::string>(&value)) line += *text;
          if (const auto* whole = std::get_if<std::int64_t>(&value)) line += std::to_string(*whole);
          if (const auto* real = std::get_if<double>(&value)) line += std::to_string(*real * 1e9);
          line += "|";
        }
        out[table.name].insert(line);
      }
    }
    return {};
  });
  EXPECT_TRUE(read) << (read ? "" : read.error().what);
  return out;
}

core::Result<std::uint64_t> copy(Store& from, Store& to) {
  return from.read([&](Reading& reading) {
    return to.write([&](Writing& writing) { return copy_rows(reading, writing); });
  });
}

/// From SQLite to the kind under test, and back to SQLite.
class CopyRows : public test_support::BothDatabases {};
TRACTUS_ON_BOTH_DATABASES(CopyRows);

TEST_P(CopyRows, CarriesEveryRowThereAndBack) {
  const TestDatabase first(DatabaseKind::sqlite), second(GetParam()), third(DatabaseKind::sqlite);
  Store from = first.open(), to = second.open(), back = third.open();
  ASSERT_TRUE(from.write(furnish_tables));
  auto there = copy(from, to);
  ASSERT_TRUE(there) << there.error().what;
  EXPECT_EQ(tables_of(to), tables_of(from));
  auto again = copy(to, back);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(tables_of(back), tables_of(from));
  EXPECT_EQ(*there, *again);
}

TEST_P(CopyRows, RefusesADatabaseThatHoldsSomethingAndLeavesItAsItIs) {
  const TestDatabase first(DatabaseKind::sqlite), second(GetParam());
  Store from = first.open(), to = second.open();
  ASSERT_TRUE(from.write(furnish_tables));
  ASSERT_TRUE(to.write([](Writing& tx) { return add_station(tx, {"x", "y"}, "z", 1); }));
  auto refused = copy(from, to);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::conflict);
  EXPECT_EQ(tables_of(to).size(), 2u) << "the station, and the trail of it";
}

TEST_P(CopyRows, ReferencesHoldAfterwards) {
  const TestDatabase first(DatabaseKind::sqlite), second(GetParam());
  Store from = first.open(), to = second.open();
  ASSERT_TRUE(from.write(furnish_tables));
  ASSERT_TRUE(copy(from, to));
  auto dangling = to.write([](Writing& tx) { return add_session(tx, "token", "nobody", 5); });
  ASSERT_FALSE(dangling);
  EXPECT_EQ(dangling.error().code, core::Errc::conflict);
}

}  // namespace
}  // namespace store
}  // namespace tractus
