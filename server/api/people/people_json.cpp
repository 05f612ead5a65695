#include "server/api/people/people_json.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/people/erasure.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

/// Crockford's base32 alphabet, without I, L, O and U. It has 32 characters, so that the five low
/// bits of a random byte choose each character with equal probability.
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
          {"role", name(account.role)},
          {"state", name(account.state)},
          {"badge", account.badge.empty() ? core::Json() : core::Json(account.badge)},
          {"has_pin", !account.pin_hash.empty()},
          {"has_codes", account.totp_confirmed},
          {"must_change", account.must_change},
          {"level", account.level},
          {"made_utc_us", account.made_utc_us}};
}

core::Json account_schema() {
  using namespace schema;
  std::vector<std::string> roles;
  for (const Role role : kRoles)
    if (role != Role::station) roles.emplace_back(name(role));
  return object(
      {{"id", text("Id of the account, which never changes")},
       {"name", text("Name with which the person signs in")},
       {"role", one_of(roles, "Role, which decides what the account may do")},
       {"state",
        one_of<store::AccountState>("State of the account; a disabled account cannot sign in")},
       {"badge",
        nullable(
            text("Text of the badge that a station's reader reads; null if there is no badge"))},
       {"has_pin", truth("True if the account has a PIN for signing in at stations")},
       {"has_codes", truth("True if signing in requires a one-time code")},
       {"must_change",
        truth("True if the person must choose a new password before any other request")},
       {"level", text("Level of training, in the programme's own words; empty if there is none")},
       {"made_utc_us", integer("us", "Time of creation, in microseconds since 1970-01-01 UTC")}});
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
  if (!account || TRY(store::is_erased(tx, account->id)))
    return core::Error{core::Errc::not_found, "no account " + call.text("id").substr(0, 32)};
  return std::move(*account);
}

std::string level_field(core::Fields& fields) { return fields.text_or("level", "", 64); }

core::Result<void> check_an_admin_stays(store::Reading& tx, const store::Account& changing) {
  auto all = TRY(store::all_accounts(tx));
  const bool stays = std::ranges::any_of(all, [&](const store::Account& other) {
    return other.id != changing.id && other.role == Role::admin &&
           other.state == store::AccountState::active;
  });
  if (stays) return {};
  return core::Error{
      core::Errc::conflict,
      "this is the last active administrator: make another account an administrator first"};
}

std::string made_password() { return letters(16); }
std::string new_pseudonym() { return "P" + letters(8); }

}  // namespace api
}  // namespace tractus
