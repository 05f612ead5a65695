#include "db/store/database/copy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

/// Of the program that made the database, not of its users.
constexpr const char* kVersions = "schema_versions";

core::Result<void> check_same_schema(const std::vector<Table>& from, const std::vector<Table>& to) {
  const bool same = std::ranges::equal(from, to, [](const Table& a, const Table& b) {
    return a.name == b.name && std::ranges::is_permutation(a.columns, b.columns);
  });
  if (same) return {};
  return core::Error{core::Errc::conflict,
                     "the two databases have different tables or columns: migrate both to the "
                     "schema of this program first (tractus-server migrate)"};
}

core::Result<void> check_empty(Reading& to, const std::vector<Table>& tables) {
  for (const Table& table : tables) {
    if (table.name == kVersions) continue;
    auto rows = TRY(to.query("select count(*) from " + table.name));
    if (rows.front().count(0) > 0)
      return core::Error{core::Errc::conflict,
                         fmt::format("the database is not empty: table {} has {} rows", table.name,
                                     rows.front().count(0))};
  }
  return {};
}

std::string insertion(const Table& table) {
  std::string marks;
  for (std::size_t i = 0; i < table.columns.size(); ++i) marks += i ? ", ?" : "?";
  return fmt::format("insert into {} ({}) values ({})", table.name, fmt::join(table.columns, ", "),
                     marks);
}

}  // namespace

core::Result<std::vector<Table>> tables_from(Connection& connection, std::string_view sql) {
  auto rows = TRY(connection.query(sql, {}));
  std::vector<Table> out;
  for (const Row& row : rows) {
    if (out.empty() || out.back().name != row.text(0)) out.push_back({row.text(0), {}});
    out.back().columns.push_back(row.text(1));
  }
  return out;
}

core::Result<std::uint64_t> copy_rows(Reading& from, Writing& to) {
  auto sources = TRY(from.tables());
  auto targets = TRY(to.tables());
  TRY(check_same_schema(sources, targets));
  TRY(check_empty(to, targets));
  TRY(to.connection_.defer_references());
  std::uint64_t copied = 0;
  for (const Table& table : sources) {
    if (table.name == kVersions) continue;
    const std::string insert = insertion(table);
    auto done =
        from.each(fmt::format("select {} from {}", fmt::join(table.columns, ", "), table.name),
                  [&](Row row) -> core::Result<void> {
                    std::vector<Value> values;
                    for (std::size_t i = 0; i < row.size(); ++i) values.push_back(row.value(i));
                    auto added = to.connection_.query(insert, values);
                    ++copied;
                    return added ? core::Result<void>() : core::Result<void>(added.error());
                  });
    if (!done)
      return core::Error{done.error().code,
                         fmt::format("table {}: {}", table.name, done.error().what)};
  }
  TRY(to.connection_.check_references());
  return copied;
}

}  // namespace store
}  // namespace tractus
