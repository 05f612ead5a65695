#include "db/store/operations/redaction.hpp"

#include <algorithm>
#include <array>

#include "core/json.hpp"
#include "core/require.hpp"
#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

using core::Json;
using core::Result;

constexpr std::int64_t kRowsPerWrite = 500;
constexpr const char* kTrailRow =
    "select number, at_utc_us, who, role, peer, what, object, detail, hash, changes from audit ";
/// Rows that may name a person: a search that finds too many, never too few.
constexpr const char* kMayName =
    "(who = ? or (who like ? escape '!' and not exists (select 1 from accounts a where a.name = "
    "who)) or object like ? escape '!' or detail like ? escape '!' or changes like ? escape '!' "
    "or (? <> '' and detail like ? escape '!')) ";

/// Fields of a detail (server/api/audit_entry.cpp) that name people, and those that hold free text.
constexpr std::array<std::string_view, 9> kNames{"account", "accounts",     "add",
                                                 "badge",   "name",         "participant",
                                                 "people",  "participants", "subject"};
constexpr std::array<std::string_view, 4> kFreeText{"basis", "note", "reason", "title"};
/// Between the person and the station where the person signed in, as the actor of a row.
constexpr const char* kAtStation = " at ";
constexpr std::size_t kShortestWord = 3;  ///< a shorter name is not looked for in free text

AuditRow trail_row(const Row& row) {
  return {row.integer(0),
          {.who = row.text(2),
           .role = row.text(3),
           .peer = row.text(4),
           .what = row.text(5),
           .object = row.text(6),
           .detail = row.text(7),
           .at_utc_us = row.integer(1)},
          row.text(8),
          row.text(9)};
}

std::string redaction_digest(const AuditKey& key, const AuditRow& row) {
  return keyed_hash(
      key, {"redacted row", std::to_string(row.number), std::to_string(row.act.at_utc_us),
            row.act.who, row.act.role, row.act.peer, row.act.what, row.act.object, row.act.detail,
            row.hash, row.changes});
}

bool same(const AuditRow& a, const AuditRow& b) {
  return a.act.who == b.act.who && a.act.peer == b.act.peer && a.act.object == b.act.object &&
         a.act.detail == b.act.detail && a.changes == b.changes;
}

std::string like(const std::string& text) {
  std::string out = "%";
  for (const char c : text) {
    if (c == '%' || c == '_' || c == '!') out += '!';
    out += c;
  }
  return out + "%";
}

/// As it stands within JSON.
std::string in_json(const std::string& text) {
  const std::string quoted = Json(text).dump();
  return quoted.substr(1, quoted.size() - 2);
}

bool is_word_part(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80;
}

/// Every place where `word` stands by itself.
std::string without_word(const std::string& text, const std::string& word,
                         const std::string& alias) {
  if (word.size() < kShortestWord) return text;
  std::string out;
  std::size_t from = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    if (at < from) continue;
    const std::size_t end = at + word.size();
    const bool alone = (at == 0 || !is_word_part(text[at - 1])) &&
                       (end == text.size() || !is_word_part(text[end]));
    if (!alone) continue;
    out += text.substr(from, at - from) + alias;
    from = end;
  }
  return out + text.substr(from);
}

enum class Holds { names, free_text, other };

Holds holds(std::string_view field) {
  if (std::ranges::find(kNames, field) != kNames.end()) return Holds::names;
  if (std::ranges::find(kFreeText, field) != kFreeText.end()) return Holds::free_text;
  return Holds::other;
}

void clean(Json& json, Holds what, const NamedPerson& person) {
  if (json.is_object()) {
    for (auto& [field, value] : json.items()) clean(value, holds(field), person);
  } else if (json.is_array()) {
    for (Json& one : json) clean(one, what, person);
  } else if (json.is_string()) {
    const std::string text = json.get<std::string>();
    const bool named = text == person.name || (!person.badge.empty() && text == person.badge);
    if (what == Holds::names && named) json = person.alias;
    if (what == Holds::free_text) json = without_word(text, person.name, person.alias);
  }
}

/// "id=17 name=anna": the values of a path's arguments.
std::string clean_object(const std::string& object, const NamedPerson& person) {
  const std::string value = "=" + person.name;
  std::string out = object;
  for (auto at = out.find(value); at != std::string::npos; at = out.find(value, at + 1)) {
    const std::size_t end = at + value.size();
    const bool whole = end == out.size() || out[end] == ' ';
    if (whole) out.replace(at + 1, person.name.size(), person.alias);
  }
  return out;
}

/// Of all keys of covered tables, an invitation's alone holds a name. A key is the text of a list.
void clean_changes(Json& changes, const NamedPerson& person) {
  for (Json& change : changes) {
    if (change.at(0) != "cohort_invitations") continue;
    auto key = core::parse_json(change.at(1).get<std::string>(), "audit trail");
    if (!key || key->at(1) != person.name) continue;
    key->at(1) = person.alias;
    change.at(1) = key->dump();
  }
}

Result<void> put_row(Writing& tx, const AuditKey& key, const AuditRow& row) {
  TRY(tx.query(
      "update audit set who = ?, peer = ?, object = ?, detail = ?, changes = ? where "
      "number = ?",
      {row.act.who, row.act.peer, row.act.object, row.act.detail, row.changes, row.number}));
  TRY(
      tx.query("insert into redactions (number, digest) values (?, ?) on conflict (number) do "
               "update set digest = excluded.digest",
               {row.number, redaction_digest(key, row)}));
  return {};
}

Result<Rows> candidates(Reading& tx, const NamedPerson& person, std::int64_t after) {
  const std::string text = like(in_json(person.name));
  return tx.query(
      std::string(kTrailRow) + "where number > ? and " + kMayName + "order by number limit ?",
      {after, person.name, like(person.name + kAtStation).substr(1), like(person.name), text, text,
       person.badge, like(in_json(person.badge)), kRowsPerWrite});
}

}  // namespace

Result<bool> is_redacted(Reading& tx, const AuditKey& key, const AuditRow& row) {
  auto rows = TRY(tx.query("select digest from redactions where number = ?", {row.number}));
  return !rows.empty() && rows.front().text(0) == redaction_digest(key, row);
}

AuditRow without_person(AuditRow row, const NamedPerson& person) {
  const bool acted =
      row.act.role != "station" &&
      (row.act.who == person.name || row.act.who.starts_with(person.name + kAtStation));
  if (acted) row.act.who.replace(0, person.name.size(), person.alias);
  row.act.object = clean_object(row.act.object, person);
  if (auto detail = core::parse_json(row.act.detail, "audit trail")) {
    const Json before = *detail;
    clean(*detail, Holds::other, person);
    if (*detail != before) row.act.detail = detail->dump();
  }
  if (row.changes.empty()) return row;
  if (auto changes = core::parse_json(row.changes, "audit trail")) {
    const Json before = *changes;
    clean_changes(*changes, person);
    if (*changes != before) row.changes = changes->dump();
  }
  return row;
}

Result<std::uint64_t> rows_naming(Reading& tx, const NamedPerson& person) {
  std::uint64_t out = 0;
  for (std::int64_t after = 0;;) {
    auto rows = TRY(candidates(tx, person, after));
    for (const Row& raw : rows) {
      const AuditRow row = trail_row(raw);
      after = row.number;
      if (!same(row, without_person(row, person))) ++out;
    }
    if (rows.size() < static_cast<std::size_t>(kRowsPerWrite)) return out;
  }
}

Result<void> redact_person(Store& store, const NamedPerson& person) {
  core::require(!person.name.empty(), "who is taken out of the trail has a name");
  for (std::int64_t after = 0;;) {
    auto seen = TRY(store.write([&](Writing& tx) -> Result<std::size_t> {
      auto rows = TRY(candidates(tx, person, after));
      for (const Row& raw : rows) {
        const AuditRow row = trail_row(raw);
        const AuditRow clean_row = without_person(row, person);
        if (!same(row, clean_row)) TRY(put_row(tx, store.audit_key(), clean_row));
      }
      if (!rows.empty()) after = rows.back().integer(0);
      return rows.size();
    }));
    if (seen < static_cast<std::size_t>(kRowsPerWrite)) return {};
  }
}

Result<std::uint64_t> redact_sign_ins(Store& store, std::int64_t before_utc_us) {
  for (std::uint64_t done = 0;;) {
    auto changed = TRY(store.write([&](Writing& tx) -> Result<std::uint64_t> {
      auto rows = TRY(
          tx.query(std::string(kTrailRow) +
                       "where what in ('signIn', 'oidcSignIn', 'oidcCallback', 'ltiLaunch') and "
                       "peer <> '' and at_utc_us < ? order by number limit ?",
                   {before_utc_us, kRowsPerWrite}));
      for (const Row& raw : rows) {
        AuditRow row = trail_row(raw);
        row.act.peer.clear();
        TRY(put_row(tx, store.audit_key(), row));
      }
      return rows.size();
    }));
    done += changed;
    if (changed < static_cast<std::uint64_t>(kRowsPerWrite)) return done;
  }
}

}  // namespace store
}  // namespace tractus
