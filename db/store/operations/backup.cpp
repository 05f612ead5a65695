#include "db/store/operations/backup.hpp"

#include <fmt/format.h>

#include <map>

#include "core/try.hpp"
#include "db/store/operations/coverage.hpp"
#include "db/store/people/erasure.hpp"

namespace tractus {
namespace store {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

/// PostgreSQL holds its references itself and has no such judgement to ask for: every row is read
/// instead, which meets every page and its checksum.
core::Result<void> read_everything(Reading& tx, Findings& found) {
  auto tables = TRY(tx.tables());
  for (const Table& table : tables) {
    auto read = tx.each("select * from " + table.name, [](Row) { return core::Result<void>(); });
    if (!read)
      found.lines.push_back(
          fmt::format("database: table {} cannot be read: {}", table.name, read.error().what));
  }
  return {};
}

/// The database's own judgement of itself.
core::Result<void> check_sqlite(Reading& tx, Findings& found) {
  auto structure = TRY(tx.query("pragma integrity_check(20)"));
  for (const Row& row : structure)
    if (row.text(0) != "ok") found.lines.push_back("database: " + row.text(0));
  auto references = TRY(tx.query("pragma foreign_key_check"));
  for (const Row& row : references)
    found.lines.push_back(
        fmt::format("database: a row of {} refers to what is not there", row.text(0)));
  return {};
}

core::Result<void> check_audit(Reading& tx, const AuditKey& key, const Anchors& anchors,
                               Findings& found) {
  std::map<std::int64_t, std::string> noted;
  for (const ChainEnd& anchor : anchors) noted[anchor.number] = anchor.hash;
  std::int64_t last = 0;
  TrailDigests digests;
  auto end = verify_chain(tx, key, [&](const AuditRow& row) {
    last = row.number;
    digests.add(row);
    const auto at = noted.find(row.number);
    if (at != noted.end() && at->second != row.hash)
      found.lines.push_back(
          fmt::format("audit trail: row {} is not the one that was noted", row.number));
  });
  if (!end && end.error().code != core::Errc::corrupt) return end.error();
  found.covered_since_utc_us = digests.since_utc_us();
  found.covered_tables = digests.tables();
  if (!end) {
    found.lines.push_back(end.error().what);
    found.lines.push_back("tables: not compared with the audit trail, which does not hold");
    return {};
  }
  found.audit = *end;
  if (!noted.empty() && noted.rbegin()->first > last)
    found.lines.push_back(
        fmt::format("audit trail: ends at row {}, but row {} was noted: the "
                    "newest rows were cut off",
                    last, noted.rbegin()->first));
  return digests.compare(tx, key, found.lines);
}

std::string wrong_with(const Objects& objects, const ObjectEntry& entry) {
  const auto size = objects.size_of(entry.sha256);
  if (!size) return fmt::format("object {}: {}", entry.sha256, size.error().what);
  if (!*size) return fmt::format("object {}: is missing", entry.sha256);
  if (**size != entry.size_bytes)
    return fmt::format("object {}: has {} bytes, {} were stored", entry.sha256, **size,
                       entry.size_bytes);
  auto sha256 = objects.kept_sha256(entry.sha256);
  if (!sha256) return fmt::format("object {}: {}", entry.sha256, sha256.error().what);
  return *sha256 == entry.sha256 ? "" : fmt::format("object {}: its bytes changed", entry.sha256);
}

}  // namespace

core::Result<void> copy_database(const std::filesystem::path& database,
                                 const std::filesystem::path& copy) {
  std::error_code failure;
  if (std::filesystem::exists(copy, failure))
    return core::Error{core::Errc::conflict, copy.string() + ": exists already"};
  auto connection = TRY(open_sqlite(database, Access::write));
  return connection->script("vacuum into " + quoted(copy.string()));
}

core::Result<std::vector<ObjectEntry>> all_objects(Reading& tx) {
  auto rows = TRY(tx.query("select sha256, size_bytes from objects order by sha256"));
  std::vector<ObjectEntry> out;
  for (const Row& row : rows) out.push_back({row.text(0), row.count(1)});
  return out;
}

core::Result<Findings> look_over(Store& store, const Objects& objects, const AuditKey& key,
                                 const Anchors& anchors, const std::function<bool(double)>& shown) {
  Findings found;
  auto entries = TRY(store.read([&](Reading& tx) -> core::Result<std::vector<ObjectEntry>> {
    TRY(store.shared() ? read_everything(tx, found) : check_sqlite(tx, found));
    TRY(check_audit(tx, key, anchors, found));
    const auto left = TRY(erasure_findings(tx, objects));
    found.lines.insert(found.lines.end(), left.begin(), left.end());
    return all_objects(tx);
  }));
  for (const ObjectEntry& entry : entries) {
    if (std::string wrong = wrong_with(objects, entry); !wrong.empty())
      found.lines.push_back(std::move(wrong));
    found.bytes += entry.size_bytes;
    if (shown && !shown(double(++found.objects) / double(entries.size())))
      return core::Error{core::Errc::cancelled, "stopped"};
    if (!shown) ++found.objects;
  }
  return found;
}

}  // namespace store
}  // namespace tractus
