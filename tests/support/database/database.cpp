#include "tests/support/database/database.hpp"

#include <cstdlib>

#include "core/bytes.hpp"
#include "tests/support/database/emptied.hpp"
#include "tests/support/postgres/postgres_server.hpp"

namespace tractus {
namespace test_support {
namespace {

namespace fs = std::filesystem;

fs::path new_folder() {
  const fs::path folder = place_of(Durable::no) / ("tractus-" + core::new_id());
  fs::create_directories(folder);
  return folder;
}

/// SQLite's file that others are copied from, its schema up to date; gone with the program.
const fs::path& file_with_schema() {
  struct Made {
    fs::path folder = new_folder();
    fs::path file = folder / "tractus.db";
    Made() {
      auto opened = store::Store::open(file);
      core::require(bool(opened), opened ? "" : opened.error().what.c_str());
    }
    ~Made() {
      std::error_code ignored;
      fs::remove_all(folder, ignored);
    }
  };
  static const Made made;
  return made.file;
}

/// PostgreSQL's, their schema up to date. Used by one thread.
EmptiedDatabases& with_schema() {
  static EmptiedDatabases databases;
  return databases;
}

}  // namespace

DatabaseKind database_kind() {
  const char* asked = std::getenv("TRACTUS_TEST_DATABASE");
  return asked && std::string_view(asked) == "postgresql" ? DatabaseKind::postgresql
                                                          : DatabaseKind::sqlite;
}

TestDatabase::TestDatabase(DatabaseKind kind, Content content) : kind_(kind), content_(content) {
  if (kind == DatabaseKind::sqlite) {
    folder_ = new_folder();
    if (content == Content::schema) fs::copy_file(file_with_schema(), folder_ / "tractus.db");
    return;
  }
  name_ = content == Content::schema ? with_schema().take() : postgres_server().add_database();
  address_ = postgres_server().address(name_);
}

TestDatabase::TestDatabase(const std::string& model)
    : kind_(DatabaseKind::postgresql),
      content_(Content::nothing),
      name_(postgres_server().add_database(model)),
      address_(postgres_server().address(name_)) {}

std::unique_ptr<TestDatabase> TestDatabase::copy_of(const TestDatabase& model) {
  return std::unique_ptr<TestDatabase>(new TestDatabase(model.name_));
}

TestDatabase::~TestDatabase() {
  if (kind_ == DatabaseKind::postgresql && content_ == Content::schema)
    with_schema().give_back(name_);
  else if (kind_ == DatabaseKind::postgresql)
    postgres_server().drop_database(name_);
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

core::Result<store::Store> TestDatabase::try_open() const {
  return kind_ == DatabaseKind::sqlite ? store::Store::open(folder_ / "tractus.db")
                                       : store::Store::open_postgres(address_);
}

store::Store TestDatabase::open() const {
  auto opened = try_open();
  core::require(bool(opened), opened ? "" : opened.error().what.c_str());
  return std::move(*opened);
}

std::unique_ptr<store::Connection> TestDatabase::connection(store::Access access) const {
  if (kind_ == DatabaseKind::postgresql) return store::postgres_connection(address_, access);
  auto opened = store::open_sqlite(folder_ / "tractus.db", access);
  core::require(bool(opened), "SQLite opens its file");
  return std::move(*opened);
}

}  // namespace test_support
}  // namespace tractus
