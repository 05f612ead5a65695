#include "server/api/people/people_json.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

/// Crockford's: without I, L, O and U. 32 of them, so that a byte's five low bits choose evenly.
constexpr std::string_view kLetters = "0123456789abcdefghjkmnpqrstvwxyz";

std::string letters(std::size_t count) {
  std::string out;
  for (const std::byte byte : core::random_bytes(count))
    out += kLetters[std::to_integer<std::size_t>(byte) & 31u];
  return out;
}

}  // namespace

core::Json account_json(const store::Account& account) {
  return {{"id", account.id},
          {"name", account.name},
          {"role", account.role},
          {"state", account.state},
          {"badge", account.badge.empty() ? core::Json() : core::Json(account.badge)},
          {"has_pin", !account.pin_hash.empty()},
          {"has_codes", account.totp_confirmed},
          {"must_change", account.must_change},
          {"made_utc_us", account.made_utc_us}};
}

core::Json account_schema() {
  using namespace schema;
  std::vector<std::string> roles;
  for (const Role role : kRoles)
    if (role != Role::station) roles.emplace_back(name(role));
  return object({{"id", text("never changes")},
                 {"name", text("typed to sign in")},
                 {"role", one_of(roles, "what it may do")},
                 {"state", one_of({"active", "disabled"}, "a disabled one cannot sign in")},
                 {"badge", nullable(text("what a station reads"))},
                 {"has_pin", truth("can sign in at a station")},
                 {"has_codes", truth("one-time codes are asked for")},
                 {"must_change", truth("a password of its own must be chosen first")},
                 {"made_utc_us", integer("us", "since 1970, UTC")}});
}

std::string password_field(core::Fields& fields, const char* key, bool needed) {
  std::string out = needed ? fields.text(key, kMaxPassword) : fields.text_or(key, "", kMaxPassword);
  if ((needed || fields.has(key)) && out.size() < kMinPassword)
    fields.wrong(key, "at least 12 characters are expected");
  return out;
}

std::string pin_field(core::Fields& fields) {
  std::string out = fields.text_or("pin", "", kMaxPin);
  const bool digits = std::ranges::all_of(out, [](char c) { return c >= '0' && c <= '9'; }) &&
                      out.size() >= kMinPin;
  if (fields.has("pin") && !out.empty() && !digits)
    fields.wrong("pin", "4 to 12 digits are expected");
  return out;
}

std::string badge_field(core::Fields& fields) {
  std::string out = fields.text_or("badge", "", kMaxBadge);
  if (!std::ranges::all_of(out, [](unsigned char c) { return c > 32 && c < 127; }))
    fields.wrong("badge", "letters, digits and signs without blanks are expected");
  return out;
}

core::Result<store::Account> account_of_call(store::Reading& tx, const Call& call) {
  auto account = TRY(store::account_of(tx, call.text("id")));
  if (!account)
    return core::Error{core::Errc::not_found, "no account " + call.text("id").substr(0, 32)};
  return std::move(*account);
}

std::string made_password() { return letters(16); }
std::string new_pseudonym() { return "P" + letters(8); }

}  // namespace api
}  // namespace tractus
