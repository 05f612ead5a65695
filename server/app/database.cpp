#include "server/app/database.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <set>

#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/database/migrations.hpp"

namespace tractus {
namespace app {
namespace fs = std::filesystem;
namespace {

std::string asked_for() {
  const char* address = std::getenv(kAddressVariable);
  return address ? address : "";
}

bool is_there(const fs::path& path) {
  std::error_code failure;
  return fs::is_regular_file(path, failure);
}

core::Result<std::string> noted_address(const fs::path& folder) {
  auto bytes = TRY(core::read_file(folder / kAddressFile, 4096));
  std::string address(core::text_of(bytes));
  address = address.substr(0, address.find_first_of("\r\n"));
  if (!address.empty()) return address;
  return core::Error{core::Errc::bad_input,
                     fmt::format("{}: the address of the database has a password and is not stored "
                                 "here: give it in {}, or with --database and PGPASSFILE",
                                 (folder / kAddressFile).string(), kAddressVariable)};
}

}  // namespace

std::string Database::name() const { return is_shared() ? "PostgreSQL" : file.string(); }

core::Result<store::Store> Database::open() const {
  return is_shared() ? store::Store::open_postgres(address) : store::Store::open(file);
}

core::Result<Database> new_database(const fs::path& folder) {
  Database out{folder / kDatabase, asked_for()};
  if (out.is_shared() && is_there(out.file))
    return core::Error{
        core::Errc::conflict,
        fmt::format("{}: the records of this folder are in this file, but a database is named; to "
                    "move the records: backup, then restore --database",
                    out.file.string())};
  if (!out.is_shared() && is_there(folder / kAddressFile)) {
    auto noted = TRY(noted_address(folder));
    out.address = std::move(noted);
  }
  return out;
}

core::Result<Database> database_of(const fs::path& folder) {
  if (!is_there(folder / kDatabase) && !is_there(folder / kAddressFile))
    return core::Error{core::Errc::not_found,
                       fmt::format("{}: this is not the data folder of a server; create one with: "
                                   "tractus-server init --data {}",
                                   folder.string(), folder.string())};
  return new_database(folder);
}

core::Result<void> note_address(const fs::path& folder, const Database& database) {
  if (!database.is_shared() || is_there(folder / kAddressFile)) return {};
  const std::string kept = store::has_password(database.address) ? "" : database.address;
  return core::write_file(folder / kAddressFile, core::bytes_of(kept + "\n"));
}

namespace {

/// The numbers of the steps that were applied.
core::Result<std::set<std::int64_t>> applied_steps(const Database& database) {
  std::unique_ptr<store::Connection> connection;
  if (database.is_shared()) {
    connection = store::postgres_connection(database.address, store::Access::read);
  } else {
    connection = TRY(store::open_sqlite(database.file, store::Access::read));
  }
  TRY(connection->begin(store::Access::read));
  auto rows = TRY(connection->query("select version from schema_versions", {}));
  std::set<std::int64_t> out;
  for (const store::Row& row : rows) out.insert(row.integer(0));
  return out;
}

}  // namespace

core::Result<std::int64_t> schema_of(const Database& database) {
  const auto steps = TRY(applied_steps(database));
  return steps.empty() ? 0 : *steps.rbegin();
}

core::Result<void> check_up_to_date(const Database& database) {
  const auto applied = TRY(applied_steps(database));
  for (const store::Migration& step : store::migrations())
    if (!applied.contains(step.version))
      return core::Error{
          core::Errc::conflict,
          fmt::format("{}: the records are of an earlier version, without migration {:04}_{}: use "
                      "that version's programs, or upgrade (tractus-server serve or migrate)",
                      database.name(), step.version, step.name)};
  return {};
}

core::Result<void> use_address(const std::string& address) {
  if (!address.starts_with("postgresql://") && !address.starts_with("postgres://"))
    return core::Error{core::Errc::bad_input,
                       fmt::format("--database {}: postgresql://[USER@]HOST[:PORT]/NAME is "
                                   "expected",
                                   address.substr(0, 64))};
  if (store::has_password(address))
    return core::Error{
        core::Errc::bad_input,
        fmt::format("--database: the address has a password, which everybody on this machine can "
                    "read on the command line: use PGPASSFILE, or give the address in {}",
                    kAddressVariable)};
  ::setenv(kAddressVariable, address.c_str(), 1);
  return {};
}

}  // namespace app
}  // namespace tractus
