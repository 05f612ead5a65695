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
  auto known = applied(connection);  // again, inside: another process may have been first
  if (!known) return known.error();
  if (known->contains(step.version)) return {};
  TRY(connection.script(step.sql));
  const std::vector<Value> values{step.version, step.name, core::utc_us()};
  TRY(connection.query(
      "insert into schema_versions (version, name, applied_utc_us) values (?, ?, ?)", values));
  return {};
}

/// In a transaction of its own: two processes that meet an empty database come one after the other.
core::Result<void> make_versions(Connection& connection) {
  TRY(connection.begin(Access::write));
  auto made = connection.query(
      "create table if not exists schema_versions "
      "(version bigint primary key, name text not null, applied_utc_us bigint not null)",
      {});
  core::Result<void> done = made ? connection.commit() : core::Result<void>(made.error());
  if (!done) connection.rollback();
  return done;
}

}  // namespace

core::Result<void> migrate(Connection& connection, const std::vector<Migration>& steps) {
  TRY(make_versions(connection));
  auto known = TRY(applied(connection));
  const std::int64_t last = steps.empty() ? 0 : steps.back().version;
  if (!known.empty() && *known.rbegin() > last)
    return core::Error{core::Errc::conflict,
                       fmt::format("the database has schema {}, but this program supports schemas "
                                   "up to {}: use the newer program that made the database",
                                   *known.rbegin(), last)};
  for (const Migration& step : steps) {
    if (known.contains(step.version)) continue;
    TRY(connection.begin(Access::write));
    auto done = apply(connection, step);
    if (done) done = connection.commit();
    if (!done) {
      connection.rollback();
      return core::Error{done.error().code, fmt::format("migration {:04}_{}: {}", step.version,
                                                        step.name, done.error().what)};
    }
  }
  return {};
}

}  // namespace store
}  // namespace tractus
