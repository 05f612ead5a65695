#include "db/store/operations/audit.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include "core/clock.hpp"
#include "core/try.hpp"
#include "db/store/operations/redaction.hpp"
#include "db/store/people/role.hpp"

namespace tractus {
namespace store {
namespace {

constexpr std::int64_t kPiece = 5000;

thread_local AuditScope* t_now = nullptr;

std::string hash_of(const AuditKey& key, const std::string& previous, std::int64_t number,
                    const AuditedAction& act, const std::string& changes) {
  std::vector<std::string> fields{previous,
                                  std::to_string(number),
                                  std::to_string(act.at_utc_us),
                                  act.who,
                                  act.role,
                                  act.peer,
                                  act.what,
                                  act.object,
                                  act.detail};
  if (!changes.empty()) fields.push_back(changes);  // rows from before there were any stay valid
  return keyed_hash(key, fields);
}

/// Columns number, at_utc_us, who, role, peer, what, object, detail, hash, changes.
AuditRow row_from(const Row& row) {
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

/// Every role, the command line and the server itself.
std::vector<ListChoice> actors() {
  auto out = choices_of<Role>("a.role");
  for (const char* other : {kCommandLine, kServer})
    out.push_back({other, std::string("a.role = '") + other + "'"});
  return out;
}

core::Error broken(std::int64_t number, const std::string& why) {
  return {core::Errc::corrupt, fmt::format("audit trail: row {}: {}", number, why)};
}

}  // namespace

std::string keyed_hash(const AuditKey& key, const std::vector<std::string>& fields) {
  std::string message;
  for (const std::string& field : fields) {
    message += fmt::format("{}:", field.size());
    message += field;
  }
  static_assert(std::tuple_size_v<AuditKey> == crypto_auth_hmacsha256_KEYBYTES);
  std::array<unsigned char, crypto_auth_hmacsha256_BYTES> hash{};
  crypto_auth_hmacsha256(hash.data(), reinterpret_cast<const unsigned char*>(message.data()),
                         message.size(), reinterpret_cast<const unsigned char*>(key.data()));
  return core::hex(std::as_bytes(std::span(hash)));
}

AuditScope::AuditScope(AuditedAction act) : act_(std::move(act)) {
  core::require(t_now == nullptr, "a thread does one act at a time");
  t_now = this;
}

AuditScope::~AuditScope() { t_now = nullptr; }

void AuditScope::is_by(const std::string& who, std::string_view role) {
  if (!t_now) return;
  t_now->act_.who = who;
  t_now->act_.role = role;
}

void AuditScope::without_detail() {
  if (t_now) t_now->act_.detail = "{}";
}

core::Result<void> note_act(Writing& tx, const AuditKey& key, const std::string& changes) {
  if (changes.empty() && !act_waits()) return {};
  if (t_now) return add_act(tx, key, t_now->act_, changes);
  const AuditedAction own{
      .who = kServer, .role = kServer, .what = kServerWork, .at_utc_us = core::utc_us()};
  return add_act(tx, key, own, changes);
}

bool act_waits() noexcept { return t_now && !t_now->noted_; }

void act_was_noted() noexcept {
  if (t_now) t_now->noted_ = true;
}

core::Result<ChainEnd> chain_end(Reading& tx) {
  auto rows = TRY(tx.query("select number, hash from audit order by number desc limit 1"));
  if (rows.empty()) return ChainEnd{};
  return ChainEnd{rows.front().integer(0), rows.front().text(1)};
}

core::Result<void> add_act(Writing& tx, const AuditKey& key, const AuditedAction& act,
                           const std::string& changes) {
  auto end = TRY(chain_end(tx));
  const std::int64_t number = end.number + 1;
  TRY(
      tx.query("insert into audit (number, at_utc_us, who, role, peer, what, object, detail, hash, "
               "changes) values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
               {number, act.at_utc_us, act.who, act.role, act.peer, act.what, act.object,
                act.detail, hash_of(key, end.hash, number, act, changes), changes}));
  return {};
}

const ListShape& audit_list() {
  const OrderColumn key{"a.number", ColumnType::integer};
  static const ListShape kShape{
      .from = "audit a",
      .searched = "a.who || ' ' || a.what || ' ' || a.object || ' ' || a.detail || ' ' || a.peer",
      .orders = {{"number", {key}, true}, {"who", {{"a.who"}, key}}, {"what", {{"a.what"}, key}}},
      .filters = {{"role", "Only rows of actors with this role", actors()}}};
  return kShape;
}

core::Result<FoundAudit> find_audit(Reading& tx, const ListRequest& request) {
  auto found = TRY(find_keys(tx, audit_list(), request));
  const SqlPart select{
      "select number, at_utc_us, who, role, peer, what, object, detail, hash, '' from audit where "
      "number in"};
  const auto rows = TRY(rows_of_keys(tx, select, found.keys));
  FoundAudit out{{}, std::move(found.page)};
  for (const Row& row : rows) out.rows.push_back(row_from(row));
  return out;
}

core::Result<std::vector<AuditRow>> audit_before(Reading& tx, std::int64_t number,
                                                 std::int64_t limit) {
  auto rows = TRY(tx.query(
      "select number, at_utc_us, who, role, peer, what, object, detail, hash, '' from audit "
      "where number < ? order by number desc limit ?",
      {number, limit}));
  std::vector<AuditRow> out;
  for (const Row& row : rows) out.push_back(row_from(row));
  return out;
}

core::Result<ChainEnd> verify_chain(Reading& tx, const AuditKey& key,
                                    const std::function<void(const AuditRow&)>& seen) {
  ChainEnd end;
  while (true) {
    auto rows = TRY(tx.query(
        "select number, at_utc_us, who, role, peer, what, object, detail, hash, changes from "
        "audit where number > ? order by number limit ?",
        {end.number, kPiece}));
    for (const Row& raw : rows) {
      const AuditRow row = row_from(raw);
      if (row.number != end.number + 1)
        return broken(end.number + 1, fmt::format("is missing; row {} follows", row.number));
      if (row.hash != hash_of(key, end.hash, row.number, row.act, row.changes) &&
          !TRY(is_redacted(tx, key, row)))
        return broken(row.number, "was changed, or the row before it was");
      if (seen) seen(row);
      end = {row.number, row.hash};
    }
    if (rows.size() < static_cast<std::size_t>(kPiece)) return end;
  }
}

}  // namespace store
}  // namespace tractus
