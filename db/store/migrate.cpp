#include <fmt/format.h>

#include "core/clock.hpp"
#include "db/store/migrations.hpp"

namespace store {
namespace {

core::Result<std::int64_t> version_of(Connection& connection) {
  auto rows = connection.query("select coalesce(max(version), 0) from schema_versions", {});
  if (!rows) return rows.error();
  return rows->front().integer(0);
}

core::Result<void> apply(Connection& connection, const Migration& step) {
  auto version = version_of(connection);  // again, inside: another process may have been first
  if (!version) return version.error();
  if (*version >= step.version) return {};
  if (auto done = connection.script(step.sql); !done) return done.error();
  const std::vector<Value> values{step.version, step.name, core::utc_us()};
  auto noted = connection.query(
      "insert into schema_versions (version, name, applied_utc_us) values (?, ?, ?)", values);
  if (!noted) return noted.error();
  return {};
}

}  // namespace

core::Result<void> migrate(Connection& connection, const std::vector<Migration>& steps) {
  auto made = connection.query(
      "create table if not exists schema_versions "
      "(version bigint primary key, name text not null, applied_utc_us bigint not null)",
      {});
  if (!made) return made.error();
  auto version = version_of(connection);
  if (!version) return version.error();
  const std::int64_t last = steps.empty() ? 0 : steps.back().version;
  if (*version > last)
    return core::Error{core::Errc::conflict,
                       fmt::format("the database has schema {}, this program knows up to {}: use "
                                   "the newer program that made it",
                                   *version, last)};
  for (const Migration& step : steps) {
    if (step.version <= *version) continue;
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
