#include <fmt/format.h>

#include <set>

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

core::Result<std::vector<Migration>> run_missing(Connection& connection,
                                                 const std::vector<Migration>& steps) {
  auto out = TRY(missing(connection, steps));
  for (const Migration& step : out) TRY(apply(connection, step));
  return out;
}

}  // namespace

core::Result<void> migrate(Connection& connection, const std::vector<Migration>& steps) {
  TRY(connection.begin(Access::write));
  const auto run = run_missing(connection, steps);
  core::Result<void> done = run ? connection.commit() : core::Result<void>(run.error());
  if (!done) connection.rollback();
  return done;
}

core::Result<std::vector<Migration>> try_migrations(Connection& connection,
                                                    const std::vector<Migration>& steps) {
  TRY(connection.begin(Access::write));
  auto out = run_missing(connection, steps);
  connection.rollback();
  return out;
}

}  // namespace store
}  // namespace tractus
