#include "db/store/operations/coverage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>

#include "core/clock.hpp"
#include "core/json.hpp"
#include "core/require.hpp"
#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

using core::Json;
using core::Result;

constexpr std::size_t kDigest = 32;          // hexadecimal digits: 128 bits, keyed
constexpr std::size_t kChangesPerRow = 500;  // of the trail, where coverage begins
constexpr const char* kNoRow = "";           // digest of a key without a row

/// Every type has a letter of its own; -0.0 is 0.0, which SQLite makes of it.
std::string field_of(const Value& value) {
  struct Writer {
    std::string operator()(std::monostate) const { return "n"; }
    std::string operator()(std::int64_t v) const { return fmt::format("i{}", v); }
    std::string operator()(double v) const {
      return fmt::format("d{:016x}", std::bit_cast<std::uint64_t>(v == 0.0 ? 0.0 : v));
    }
    std::string operator()(const std::string& v) const { return "t" + v; }
    std::string operator()(const core::Bytes& v) const { return "b" + core::hex(v); }
  };
  return std::visit(Writer{}, value);
}

std::string key_text(const Row& row, std::size_t from, std::size_t size) {
  Json key = Json::array();
  for (std::size_t i = from; i < from + size; ++i) {
    if (const auto* number = std::get_if<std::int64_t>(&row.value(i)))
      key.push_back(*number);
    else
      key.push_back(row.text(i));
  }
  return key.dump();
}

/// Rows of one key, in any order.
std::string digest_of(const AuditKey& key, const CoveredTable& table,
                      std::vector<std::string> rows) {
  if (rows.empty()) return kNoRow;
  std::ranges::sort(rows);
  std::vector<std::string> fields{"covered row", table.name};
  fields.insert(fields.end(), rows.begin(), rows.end());
  return keyed_hash(key, fields).substr(0, kDigest);
}

std::string row_text(const Row& row) {
  std::string out;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string field = field_of(row.value(i));
    out += fmt::format("{}:{}", field.size(), field);
  }
  return out;
}

std::string selection(const CoveredTable& table) {
  std::string columns = fmt::format("{}", fmt::join(table.keys, ", "));
  for (const std::string& column : table.columns) columns += ", " + column;
  return fmt::format("select {} from {}", columns, table.name);
}

Result<std::string> digest_now(Reading& tx, const AuditKey& key, const CoveredTable& table,
                               const std::vector<Value>& of) {
  const std::string sql =
      selection(table) + fmt::format(" where {} = ?", fmt::join(table.keys, " = ? and "));
  auto rows = TRY(tx.query_with(sql, std::span(of)));
  std::vector<std::string> texts;
  for (const Row& row : rows) texts.push_back(row_text(row));
  return digest_of(key, table, std::move(texts));
}

/// `seen` gets the key and the digest of every key of a table, in the order of the keys.
Result<void> each_digest(Reading& tx, const AuditKey& key, const CoveredTable& table,
                         const std::function<void(const std::string&, std::string)>& seen) {
  std::string at;
  std::vector<std::string> rows;
  const auto finish = [&] {
    if (!rows.empty()) seen(at, digest_of(key, table, std::exchange(rows, {})));
  };
  auto read = tx.each(selection(table) + fmt::format(" order by {}", fmt::join(table.keys, ", ")),
                      [&](Row row) -> Result<void> {
                        std::string of = key_text(row, 0, table.keys.size());
                        if (of != at) finish();
                        at = std::move(of);
                        rows.push_back(row_text(row));
                        return {};
                      });
  if (read) finish();
  return read;
}

/// What is covered, for the trail: rows are compared by what was covered when they were written.
Json coverage_json(const std::vector<CoveredTable>& tables) {
  Json out = Json::object();
  for (const CoveredTable& table : tables)
    out[table.name] = {{"keys", table.keys}, {"columns", table.columns}};
  return out;
}

/// Of a row of the trail whose hash holds: this program wrote it.
Json written_json(const std::string& text) {
  auto json = core::parse_json(text, "audit trail");
  core::require(bool(json), "the server writes JSON into the trail");
  return std::move(*json);
}

std::vector<CoveredTable> tables_of(const Json& json) {
  std::vector<CoveredTable> out;
  for (const auto& [name, table] : json.items())
    out.push_back({name, table.at("keys").get<std::vector<std::string>>(),
                   table.at("columns").get<std::vector<std::string>>()});
  return out;
}

/// What is wrong with the rows by the coverage that the trail has so far.
Result<std::size_t> differences(Reading& tx, const AuditKey& key) {
  TrailDigests digests;
  auto end = verify_chain(tx, key, [&](const AuditRow& row) { digests.add(row); });
  if (!end) return end.error().code == core::Errc::corrupt ? Result<std::size_t>(1) : end.error();
  std::vector<std::string> found;
  TRY(digests.compare(tx, key, found));
  return found.size();
}

struct Beginning {
  Writing& tx;
  const AuditKey& key;
  Json detail;
  Json changes = Json::array();
  const char* what = kBeginCoverage;

  Result<void> flush() {
    const AuditedAction act{.who = kServer,
                            .role = kServer,
                            .what = std::exchange(what, kGoOnCoverage),
                            .detail = std::exchange(detail, Json::object()).dump(),
                            .at_utc_us = core::utc_us()};
    return add_act(tx, key, act, std::exchange(changes, Json::array()).dump());
  }
  Result<void> add(const CoveredTable& table) {
    Result<void> outcome;
    std::vector<std::pair<std::string, std::string>> all;  // a table is read before it is written
    TRY(each_digest(tx, key, table, [&](const std::string& of, std::string digest) {
      all.emplace_back(of, std::move(digest));
    }));
    for (const auto& [of, digest] : all) {
      changes.push_back(Json::array({table.name, of, digest}));
      if (changes.size() < kChangesPerRow) continue;
      TRY(flush());
    }
    return {};
  }
};

}  // namespace

const CoveredTable* changed_table(std::string_view sql) {
  for (const std::string_view verb : {"insert into ", "update ", "delete from "}) {
    if (!sql.starts_with(verb)) continue;
    sql.remove_prefix(verb.size());
    const std::string_view name = sql.substr(0, sql.find_first_of(" ("));
    const auto& tables = covered_tables();
    const auto found = std::ranges::find(tables, name, &CoveredTable::name);
    return found == tables.end() ? nullptr : &*found;
  }
  return nullptr;
}

std::string returning_keys(std::string_view sql, const CoveredTable& table) {
  const char* joint = sql.find(" returning ") == std::string_view::npos ? " returning " : ", ";
  return fmt::format("{}{}{}", sql, joint, fmt::join(table.keys, ", "));
}

Result<std::string> changes_text(Reading& tx, const AuditKey& key, const ChangedRows& rows) {
  if (rows.empty()) return std::string();
  Json out = Json::array();
  for (const auto& [table, of] : rows) {
    auto digest = TRY(digest_now(tx, key, *table, of));
    out.push_back(Json::array({table->name, key_text(Row(of), 0, of.size()), digest}));
  }
  return out.dump();
}

Result<bool> begin_coverage(Store& store) {
  const AuditKey& key = store.audit_key();
  return store.write([&](Writing& tx) -> Result<bool> {
    auto last = TRY(tx.query(
        "select detail from audit where what = 'beginCoverage' order by number desc limit 1"));
    Json detail{{"tables", coverage_json(covered_tables())}, {"differences", 0}};
    if (!last.empty()) {
      const auto before = core::parse_json(last.front().text(0), "audit trail");
      if (before && before->is_object() && before->value("tables", Json()) == detail["tables"])
        return false;
      auto differ = TRY(differences(tx, key));
      detail["differences"] = differ;
    }
    Beginning beginning{tx, key, std::move(detail)};
    for (const CoveredTable& table : covered_tables()) TRY(beginning.add(table));
    TRY(beginning.flush());
    return true;
  });
}

void TrailDigests::begin(const AuditRow& row) {
  const Json detail = written_json(row.act.detail);
  tables_ = tables_of(detail.at("tables"));
  digests_.clear();
  since_utc_us_ = row.act.at_utc_us;
  if (const auto differ = detail.at("differences").get<std::size_t>(); differ > 0)
    found_.push_back(
        fmt::format("audit trail: row {}: when the covered columns changed, {} rows differed",
                    row.number, differ));
}

void TrailDigests::add(const AuditRow& row) {
  if (row.act.what == kBeginCoverage) begin(row);
  if (row.changes.empty() || since_utc_us_ == 0) return;
  for (const Json& change : written_json(row.changes))
    digests_[change.at(0).get<std::string>()][change.at(1).get<std::string>()] =
        change.at(2).get<std::string>();
}

Result<void> TrailDigests::compare(Reading& tx, const AuditKey& key,
                                   std::vector<std::string>& findings) {
  findings.insert(findings.end(), found_.begin(), found_.end());
  for (const CoveredTable& table : tables_) {
    auto& known = digests_[table.name];
    const auto tell = [&](const std::string& of, const char* what) {
      findings.push_back(fmt::format("table {}: row {} {}", table.name, of, what));
    };
    TRY(each_digest(tx, key, table, [&](const std::string& of, std::string digest) {
      const auto at = known.find(of);
      if (at == known.end() || at->second.empty())
        tell(of, "was inserted by other means than this program");
      else if (at->second != digest)
        tell(of, "was changed by other means than this program");
      if (at != known.end()) known.erase(at);
    }));
    for (const auto& [of, digest] : known)
      if (!digest.empty()) tell(of, "was deleted by other means than this program");
  }
  return {};
}

}  // namespace store
}  // namespace tractus
