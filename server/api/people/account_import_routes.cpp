/// Accounts of a class from one CSV: shown row by row first, then all created or none.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/bytes.hpp"
#include "core/csv.hpp"
#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/assignment_plan.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxImport_bytes = 1u << 18;
constexpr std::size_t kMaxRows = 200, kMaxCsv_bytes = 1u << 17;
constexpr std::array<std::string_view, 5> kColumns{"name", "role", "level", "badge", "pin"};

struct ImportRow {
  std::size_t line = 0;
  store::Account account;
  std::string pin, password;
  std::string error;  ///< empty: an account can be made of the row
};

struct Import {
  std::string csv, cohort, level;
  bool apply = false;
};

Result<Import> import_from(const std::string& body) {
  auto json = TRY(core::parse_json(body, "body"));
  core::Fields fields(json, "body");
  Import out;
  out.csv = fields.text("csv", kMaxCsv_bytes);
  out.cohort = fields.text_or("cohort", "", 64);
  out.level = level_field(fields);
  const Json* apply = fields.member("apply", false);
  if (apply && !apply->is_boolean()) fields.wrong("apply", "true or false is expected");
  out.apply = apply && apply->is_boolean() && apply->get<bool>();
  TRY(fields.done());
  return out;
}

/// Where each of the known columns stands. Errors: bad_input for an unknown or a missing one.
Result<std::map<std::string, std::size_t>> columns_in(const std::vector<std::string_view>& header) {
  std::map<std::string, std::size_t> out;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string column(header[i]);
    if (std::ranges::find(kColumns, column) == kColumns.end())
      return core::bad_input("line 1: the column '" + column.substr(0, 40) +
                             "' is not known; name, role, level, badge and pin are");
    if (!out.emplace(column, i).second)
      return core::bad_input("line 1: the column '" + column + "' stands there twice");
  }
  if (!out.contains("name")) return core::bad_input("line 1: a column 'name' is expected");
  return out;
}

/// The row read by the same rules as one account of a request; the first fault found is its error.
ImportRow row_from(std::size_t line, const std::map<std::string, std::string>& cells) {
  ImportRow out;
  out.line = line;
  Json json = Json::object();
  for (const auto& [column, text] : cells)
    if (!text.empty()) json[column] = text;
  if (!json.contains("role")) json["role"] = name(Role::trainee);
  core::Fields fields(json, "");
  out.account.name = fields.text("name", kMaxName);
  if (out.account.name.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("name", "a name is expected");
  out.account.role = fields.word<Role>("role");
  if (out.account.role == Role::station) fields.wrong("role", "a station is no person's role");
  out.account.level = level_field(fields);
  out.account.badge = badge_field(fields);
  out.pin = pin_field(fields);
  if (const auto read = fields.done(); !read) out.error = read.error().what;
  return out;
}

Result<std::vector<ImportRow>> rows_of(std::string csv) {
  core::CsvReader reader(std::span<char>(csv), "the list");
  std::vector<std::string_view> header, cells;
  TRY(reader.next(header));
  const auto columns = TRY(columns_in(header));
  const std::size_t width = header.size();
  std::vector<ImportRow> out;
  while (TRY(reader.next(cells))) {
    if (core::is_blank(cells)) continue;
    if (out.size() == kMaxRows)
      return core::bad_input(fmt::format("more than {} rows: import them in parts", kMaxRows));
    if (cells.size() != width) {
      out.emplace_back().line = reader.line();
      out.back().error = fmt::format("has {} cells, the first line has {}", cells.size(), width);
      continue;
    }
    std::map<std::string, std::string> texts;
    for (const auto& [column, at] : columns) texts[column] = std::string(cells[at]);
    out.push_back(row_from(reader.line(), texts));
  }
  if (out.empty()) return core::bad_input("the list has no row");
  return out;
}

/// Names and badges that two rows share, or that an account has already.
Result<void> mark_taken(store::Reading& tx, std::vector<ImportRow>& rows) {
  std::set<std::string> names, badges;
  for (ImportRow& row : rows) {
    if (!row.error.empty()) continue;
    const auto& [name, badge] = std::tie(row.account.name, row.account.badge);
    const auto named = TRY(store::account_named(tx, name));
    if (named)
      row.error = "an account has this name already";
    else if (!names.insert(name).second)
      row.error = "this name stands in an earlier row";
    if (badge.empty() || !row.error.empty()) continue;
    const auto bearer = TRY(store::account_with_badge(tx, badge));
    if (bearer)
      row.error = "the badge is that of " + bearer->name;
    else if (!badges.insert(badge).second)
      row.error = "this badge stands in an earlier row";
  }
  return {};
}

/// Trainees and faculty can be in a cohort.
void mark_outside_cohorts(std::vector<ImportRow>& rows) {
  for (ImportRow& row : rows)
    if (row.error.empty() && row.account.role != Role::trainee && row.account.role != Role::faculty)
      row.error = "only trainees and faculty can join a cohort";
}

/// A director brings residents; whoever may see or decide more is made by an administrator.
void mark_beyond_director(std::vector<ImportRow>& rows) {
  for (ImportRow& row : rows)
    if (row.error.empty() && row.account.role != Role::trainee)
      row.error = "a director imports trainees; an administrator creates other accounts";
}

Result<void> fill_secrets(std::vector<ImportRow>& rows, std::int64_t now_utc_us) {
  for (ImportRow& row : rows) {
    row.account.id = core::new_id();
    row.account.pseudonym = new_pseudonym();
    row.account.must_change = true;
    row.account.made_utc_us = now_utc_us;
    row.password = made_password();
    row.account.password_hash = TRY(password_hash(row.password));
    if (!row.pin.empty()) row.account.pin_hash = TRY(password_hash(row.pin));
  }
  return {};
}

Result<void> add_all(store::Writing& tx, const std::vector<ImportRow>& rows,
                     const std::string& cohort, const store::AuditStamp& stamp) {
  for (const ImportRow& row : rows) {
    TRY(store::add_account(tx, row.account, stamp.at_utc_us));
    if (!cohort.empty()) TRY(join_cohort(tx, cohort, row.account, stamp));
  }
  return {};
}

Json rows_json(const std::vector<ImportRow>& rows, bool applied) {
  Json out = Json::array();
  for (const ImportRow& row : rows)
    out.push_back({{"line", row.line},
                   {"name", row.account.name},
                   {"id", row.account.id.empty() ? Json() : Json(row.account.id)},
                   {"role", name(row.account.role)},
                   {"level", row.account.level},
                   {"badge", row.account.badge.empty() ? Json() : Json(row.account.badge)},
                   {"has_pin", !row.pin.empty()},
                   {"error", row.error.empty() ? Json() : Json(row.error)},
                   {"password", applied ? Json(row.password) : Json()}});
  return out;
}

Result<http::Response> import_accounts(const Call& call) {
  const auto asked = TRY(import_from(call.request.body));
  auto rows = TRY(rows_of(asked.csv));
  for (ImportRow& row : rows)
    if (row.account.level.empty()) row.account.level = asked.level;
  if (!asked.cohort.empty()) mark_outside_cohorts(rows);
  if (call.caller.role == Role::director) mark_beyond_director(rows);
  TRY(call.backend.store.read([&](store::Reading& tx) { return mark_taken(tx, rows); }));
  const bool faultless =
      std::ranges::all_of(rows, [](const ImportRow& row) { return row.error.empty(); });
  if (!asked.apply || !faultless)
    return json_response({{"rows", rows_json(rows, false)}, {"applied", false}});
  const store::AuditStamp stamp{call.caller.name, call.backend.now_utc_us()};
  TRY(fill_secrets(rows, stamp.at_utc_us));
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return add_all(tx, rows, asked.cohort, stamp); }));
  return json_response({{"rows", rows_json(rows, true)}, {"applied", true}}, 201);
}

std::vector<NamedSchema> import_schemas() {
  using namespace schema;
  return {
      {"AccountsImport",
       object({{"csv", text("CSV with a header line; columns: name, and optionally role (default "
                            "trainee), level, badge and pin; at most 200 rows")},
               {"cohort", optional(text("Id of a cohort that all accounts join"))},
               {"level", optional(text("Level of training of the rows that name none"))},
               {"apply", optional(truth("True: creates the accounts, all or none; false (default): "
                                        "only checks the rows"))}})},
      {"ImportedAccount",
       object({{"line", integer("1", "Number of the line of the CSV, counted from 1")},
               {"name", text("Name of the account; empty if the row cannot be read")},
               {"id", nullable(text("Id of the account; null if no account was created"))},
               {"role", text("Role of the account")},
               {"level", text("Level of training; empty if there is none")},
               {"badge", nullable(text("Text of the badge; null if there is none"))},
               {"has_pin", truth("True if the row has a PIN")},
               {"error", nullable(text("Reason why no account can be created from the row; null "
                                       "if one can be"))},
               {"password", nullable(text("Generated password, shown only in this answer; null if "
                                          "no account was created"))}})},
      {"AccountsImported",
       object({{"rows", array(ref("ImportedAccount"), "Rows of the CSV, in its order")},
               {"applied", truth("True if the accounts were created; false if they were only "
                                 "checked, or if a row has an error")}})}};
}

}  // namespace

std::vector<RouteInfo> account_import_routes() {
  RouteInfo out{.method = "POST",
                .path = "/api/v1/accounts/import",
                .id = "importAccounts",
                .summary =
                    "Check a list of accounts in CSV, or create all accounts of the list; a "
                    "director creates trainees",
                .who = {Role::admin, Role::director},
                .parameters = {},
                .body = "AccountsImport",
                .body_limit_bytes = kMaxImport_bytes,
                .answer = "AccountsImported",
                .schemas = import_schemas(),
                .handle = import_accounts};
  out.lane = http::Lane::hashing;
  out.ends = {{"/cohort", Object::cohort, out.who}};
  return {out};
}

}  // namespace api
}  // namespace tractus
