/// A database of a test's own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "db/store/store.hpp"

namespace tractus {
namespace test_support {

enum class DatabaseKind { sqlite, postgresql };

/// What the environment asks for: TRACTUS_TEST_DATABASE=postgresql; else SQLite.
DatabaseKind database_kind();

/// What is in it to begin with.
enum class Content { schema, nothing };

/// Gone with this object. Opening it a second time opens the same one.
class TestDatabase {
 public:
  explicit TestDatabase(DatabaseKind kind = database_kind(), Content content = Content::schema);
  /// A copy of one on PostgreSQL, to which nobody is connected.
  static std::unique_ptr<TestDatabase> copy_of(const TestDatabase& model);
  ~TestDatabase();
  TestDatabase(const TestDatabase&) = delete;
  TestDatabase& operator=(const TestDatabase&) = delete;

  /// Ends the test program when it cannot be opened.
  store::Store open() const;
  core::Result<store::Store> try_open() const;
  std::unique_ptr<store::Connection> connection(store::Access access) const;
  /// PostgreSQL's.
  const std::string& address() const { return address_; }
  DatabaseKind kind() const { return kind_; }

 private:
  explicit TestDatabase(const std::string& model);
  DatabaseKind kind_;
  Content content_;
  std::filesystem::path folder_;
  std::string name_, address_;
};

/// Fixture of tests that every database must pass: TEST_P, then TRACTUS_ON_BOTH_DATABASES(Suite).
class BothDatabases : public ::testing::TestWithParam<DatabaseKind> {};

}  // namespace test_support

#define TRACTUS_ON_BOTH_DATABASES(Suite)                                                          \
  INSTANTIATE_TEST_SUITE_P(SQLite, Suite, ::testing::Values(test_support::DatabaseKind::sqlite)); \
  INSTANTIATE_TEST_SUITE_P(PostgreSQL, Suite,                                                     \
                           ::testing::Values(test_support::DatabaseKind::postgresql))
}  // namespace tractus
