/// upgrade --check: whether this program version can take over a data folder.
#include <fmt/format.h>

#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/database/migrations.hpp"
#include "db/store/operations/backup.hpp"
#include "server/app/command.hpp"
#include "server/app/database.hpp"

namespace tractus {
namespace app {
namespace {

/// On a copy of SQLite's file, which is removed; in PostgreSQL itself, in a transaction that is
/// rolled back.
core::Result<std::vector<store::Migration>> tried_steps(const Database& database) {
  const auto steps = store::migrations();
  if (database.is_shared()) {
    const auto connection = store::postgres_connection(database.address, store::Access::write);
    return store::try_migrations(*connection, steps);
  }
  auto copy = database.file;
  copy += ".upgrade";
  std::error_code ignored;
  std::filesystem::remove(copy, ignored);  // of a check that was killed
  TRY(store::copy_database(database.file, copy));
  auto out = [&]() -> core::Result<std::vector<store::Migration>> {
    auto connection = TRY(store::open_sqlite(copy, store::Access::write));
    return store::try_migrations(*connection, steps);
  }();
  for (const char* end : {"", "-wal", "-shm"})
    std::filesystem::remove(std::filesystem::path(copy) += end, ignored);
  return out;
}

std::string plan_text(const std::vector<store::Migration>& steps) {
  if (steps.empty()) return "the database is up to date: nothing is migrated";
  std::string out = fmt::format("{} migration{} would run, in one transaction:", steps.size(),
                                steps.size() == 1 ? "" : "s");
  for (const store::Migration& step : steps)
    out += fmt::format("\n  {:04} {}", step.version, step.name);
  return out +
         "\neach was tried just now and succeeded; keep a backup that the version before made: it "
         "reads no later one";
}

}  // namespace

Run upgrade_command(CLI::App& command) {
  const auto common = common_options(command);
  command
      .add_flag_function(
          "--check", [](std::int64_t) {},
          "Try the migrations of this program version, and change nothing. On SQLite they "
          "run on a copy, which needs as much disk space as the database")
      ->required();
  return [=]() -> core::Result<int> {
    const auto database = TRY(database_of(common->data));
    const auto steps = TRY(tried_steps(database));
    core::Json names = core::Json::array();
    for (const store::Migration& step : steps) names.push_back(step.name);
    say(common->json, {{"migrations", names}}, plan_text(steps));
    return 0;
  };
}

}  // namespace app
}  // namespace tractus
