#include <fmt/format.h>

#include <chrono>
#include <set>
#include <thread>

#include "core/clock.hpp"
#include "core/try.hpp"
#include "db/store/database/migrations.hpp"

namespace tractus {
namespace store {
namespace {

/// The steps that were applied, each by its own number: branches of the product may add steps in
/// any order.
core::Result<std::set<std::int64_t>> applied(Connection& connection) {
  auto rows = TRY(connection.query("select version from schema_versions", {}));
  std::set<std::int64_t> out;
  for (const Row& row : rows) out.insert(row.integer(0));
  return out;
}

core::Result<void> apply(Connection& connection, const Migration& step) {
  auto done = connection.script(step.sql);
  if (done) {
    const std::vector<Value> values{step.version, step.name, core::utc_us()};
    if (const auto noted = connection.query(
            "insert into schema_versions (version, name, applied_utc_us) values (?, ?, ?)", values);
        !noted)
      done = noted.error();
  }
  if (done) return {};
  return core::Error{done.error().code, fmt::format("migration {:04}_{}: {}", step.version,
                                                    step.name, done.error().what)};
}

/// Those that are missing. Two processes that meet an empty database come one after the other: the
/// transaction writes from its first statement on.
core::Result<std::vector<Migration>> missing(Connection& connection,
                                             const std::vector<Migration>& steps) {
  TRY(
      connection.query("create table if not exists schema_versions "
                       "(version bigint primary key, name text not null, applied_utc_us bigint "
                       "not null)",
                       {}));
  const auto known = TRY(applied(connection));
  const std::int64_t last = steps.empty() ? 0 : steps.back().version;
  if (!known.empty() && *known.rbegin() > last)
    return core::Error{core::Errc::conflict,
                       fmt::format("the database has schema {}, but this program supports schemas "
                                   "up to {}: use the newer program that made the database",
                                   *known.rbegin(), last)};
  std::vector<Migration> out;
  for (const Migration& step : steps)
    if (!known.contains(step.version)) out.push_back(step);
  return out;
}

/// Who reads a table that is changed, and then one that was, waits for the migration as it waits
/// for them. PostgreSQL ends such a knot after a second, by failing either; the migration is to
/// give way before, and not to hold others up for long.
constexpr const char* kShortPatience =
    "select /*pg: set_config('lock_timeout', '500ms', true), */ 1";
constexpr std::chrono::minutes kTriedFor{1};
constexpr std::chrono::milliseconds kWayGiven{100};

core::Result<std::vector<Migration>> run_missing(Connection& connection,
                                                 const std::vector<Migration>& steps) {
  TRY(connection.query(kShortPatience, {}));
  auto out = TRY(missing(connection, steps));
  for (const Migration& step : out) TRY(apply(connection, step));
  return out;
}

/// Leaves a transaction open in which the missing steps have run; none if they could not.
core::Result<std::vector<Migration>> begin_with_missing(Connection& connection,
                                                        const std::vector<Migration>& steps) {
  const auto end = std::chrono::steady_clock::now() + kTriedFor;
  for (;;) {
    TRY(connection.begin(Access::write));
    auto run = run_missing(connection, steps);
    if (run) return run;
    connection.rollback();
    if (run.error().code != core::Errc::unavailable || std::chrono::steady_clock::now() > end)
      return run;
    std::this_thread::sleep_for(kWayGiven);
  }
}

}  // namespace

core::Result<void> migrate(Connection& connection, const std::vector<Migration>& steps) {
  TRY(begin_with_missing(connection, steps));
  const auto done = connection.commit();
  if (!done) connection.rollback();
  return done;
}

core::Result<std::vector<Migration>> try_migrations(Connection& connection,
                                                    const std::vector<Migration>& steps) {
  auto out = begin_with_missing(connection, steps);
  connection.rollback();
  return out;
}

}  // namespace store
}  // namespace tractus
