#include <fmt/format.h>

#include <set>

#include "core/clock.hpp"
#include "db/store/database/migrations.hpp"

namespace tractus {
namespace store {
namespace {

/// The steps that were applied, each by its own number: branches of the product may add steps in
/// any order.
core::Result<std::set<std::int64_t>> applied(Connection& connection) {
  auto rows = connection.query("select version from schema_versions", {});
  if (!rows) return rows.error();
  std::set<std::int64_t> out;
  for (const Row& row : *rows) out.insert(row.integer(0));
  return out;
}

core::Result<void> apply(Connection& connection, const Migration& step) {
  auto known = applied(connection);  // again, inside: another process may have been first
  if (!known) return known.error();
  if (known->contains(step.version)) return {};
  if (auto done = connection.script(step.sql); !done) return done.error();
  const std::vector<Value> values{step.version, step.name, core::utc_us()};
  auto noted = connection.query(
      "insert into schema_versions (version, name, applied_utc_us) values (?, ?, ?)", values);
  if (!noted) return noted.error();
  return {};
}

/// In a transaction of its own: two processes that meet an empty database come one after the other.
core::Result<void> make_versions(Connection& connection) {
  if (auto begun = connection.begin(Access::write); !begun) return begun;
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
  if (auto made = make_versions(connection); !made) return made;
  auto known = applied(connection);
  if (!known) return known.error();
  const std::int64_t last = steps.empty() ? 0 : steps.back().version;
  if (!known->empty() && *known->rbegin() > last)
    return core::Error{core::Errc::conflict,
                       fmt::format("the database has schema {}, this program knows up to {}: use "
                                   "the newer program that made it",
                                   *known->rbegin(), last)};
  for (const Migration& step : steps) {
    if (known->contains(step.version)) continue;
    if (auto begun = connection.begin(Access::write); !begun) return begun.error();
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
