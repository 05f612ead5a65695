/// Many accounts changed at once, all or none: role, level, cohort, badges, new first passwords.
#include <fmt/format.h>

#include "core/try.hpp"
#include "db/store/people/erasure.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/people/throttle.hpp"
#include "server/api/people/token_scopes.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/assignment_plan.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxChanges_bytes = 1u << 17;
constexpr std::size_t kMaxChanged = 200;

struct AccountChange {
  std::string id;
  std::optional<std::string> badge = {}, pin_hash = {};
  std::string password = {}, password_hash = {};  ///< empty: stays
};

struct Changes {
  std::vector<AccountChange> accounts;
  std::optional<Role> role;
  std::optional<std::string> level;
  std::string cohort;
  bool new_passwords = false;
};

Result<AccountChange> change_from(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  AccountChange out{.id = fields.text("id", 64)};
  if (fields.has("badge")) out.badge = badge_field(fields);
  const std::string pin = pin_field(fields);
  TRY(fields.done());
  if (!pin.empty()) out.pin_hash = TRY(password_hash(pin));
  return out;
}

Result<Changes> changes_from(const std::string& body) {
  const auto json = TRY(core::parse_json(body, "body"));
  core::Fields fields(json, "body");
  Changes out;
  if (fields.has("role")) out.role = fields.word<Role>("role");
  if (out.role == Role::station) fields.wrong("role", "a station is no person's role");
  if (fields.has("level")) out.level = level_field(fields);
  out.cohort = fields.text_or("cohort", "", 64);
  const Json* fresh = fields.member("new_passwords", false);
  if (fresh && !fresh->is_boolean()) fields.wrong("new_passwords", "true or false is expected");
  out.new_passwords = fresh && fresh->is_boolean() && fresh->get<bool>();
  const Json* accounts = fields.member("accounts");
  if (accounts && (!accounts->is_array() || accounts->empty() || accounts->size() > kMaxChanged))
    fields.wrong("accounts", fmt::format("an array of 1 to {} is expected", kMaxChanged));
  TRY(fields.done());
  for (const Json& one : *accounts) {
    auto change = TRY(change_from(one, fmt::format("body: /accounts/{}", out.accounts.size())));
    out.accounts.push_back(std::move(change));
  }
  return out;
}

Result<void> make_passwords(Changes& changes) {
  if (!changes.new_passwords) return {};
  for (AccountChange& one : changes.accounts) {
    one.password = made_password();
    one.password_hash = TRY(password_hash(one.password));
  }
  return {};
}

/// What would lock the caller out, or hand the caller a password that needs no old one.
Result<void> check_own(const Call& call, const Changes& changes, const std::string& id) {
  if (id != call.caller.id || (!changes.role && !changes.new_passwords)) return {};
  return Error{Errc::forbidden,
               call.caller.name + ": this is your own account; leave it out of the list"};
}

Result<void> set_secrets(store::Writing& tx, const AccountChange& change, store::Account& account) {
  if (change.badge) account.badge = *change.badge;
  if (change.pin_hash) account.pin_hash = *change.pin_hash;
  if (change.badge || change.pin_hash)
    TRY(start_afresh(tx, account.id, store::Secret::badge_pin, account.badge));
  if (change.password.empty()) return {};
  account.password_hash = change.password_hash;
  account.must_change = true;
  account.totp_secret.clear();
  account.totp_confirmed = false;
  return start_afresh(tx, account.id, store::Secret::account_password, account.name);
}

Result<store::Account> change_one(store::Writing& tx, const Call& call, const Changes& changes,
                                  const AccountChange& change) {
  auto found = TRY(store::account_of(tx, change.id));
  if (!found || TRY(store::is_erased(tx, change.id)))
    return Error{Errc::not_found, "no account " + change.id.substr(0, 32)};
  TRY(check_own(call, changes, found->id));
  const bool loses_admin =
      changes.role && found->role == Role::admin && *changes.role != Role::admin;
  if (loses_admin) TRY(check_an_admin_stays(tx, *found));
  if (changes.role) {
    found->role = *changes.role;
    TRY(store::limit_api_tokens_of(tx, found->id, scopes_for(found->role), token_end_of(call)));
  }
  if (changes.new_passwords) TRY(store::revoke_api_tokens_of(tx, found->id, token_end_of(call)));
  if (changes.level) found->level = *changes.level;
  TRY(set_secrets(tx, change, *found));
  const auto set = store::set_account(tx, *found);
  if (!set) return Error{set.error().code, found->name + ": " + set.error().what};
  if (!changes.cohort.empty())
    TRY(join_cohort(tx, changes.cohort, *found, {call.caller.name, call.backend.now_utc_us()}));
  const bool ends_sessions =
      changes.role || change.badge || change.pin_hash || changes.new_passwords;
  if (ends_sessions) TRY(store::remove_sessions_of(tx, found->id, ""));
  return std::move(*found);
}

Result<http::Response> change_accounts(const Call& call) {
  auto changes = TRY(changes_from(call.request.body));
  TRY(make_passwords(changes));
  Json list = Json::array();
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    list = Json::array();
    for (const AccountChange& change : changes.accounts) {
      const auto account = TRY(change_one(tx, call, changes, change));
      list.push_back(
          {{"account", account_json(account)}, {"password", core::or_null(change.password)}});
    }
    return {};
  }));
  for (const AccountChange& change : changes.accounts) close_conversations(call.backend, change.id);
  return json_response({{"accounts", list}});
}

std::vector<NamedSchema> change_schemas() {
  using namespace schema;
  return {
      {"AccountChange",
       object({{"id", text("Id of the account")},
               {"badge", optional(text("New text of the badge; empty removes it; if it is missing, "
                                       "the badge stays"))},
               {"pin", optional(text("New PIN of 4 to 12 digits; if it is missing, it stays"))}})},
      {"AccountChanges",
       object(
           {{"accounts", array(ref("AccountChange"), "Accounts to change, at most 200")},
            {"role", optional(text("New role of all these accounts"))},
            {"level", optional(text("New level of training of all these accounts"))},
            {"cohort", optional(text("Id of a cohort that all these accounts join"))},
            {"new_passwords", optional(truth("True: every account gets a new generated password, "
                                             "to be changed at the next sign-in"))}})},
      {"ChangedAccount",
       object({{"account", ref("Account")},
               {"password", nullable(text("Generated password, shown only in this answer; null if "
                                          "none was asked for"))}})},
      {"ChangedAccounts", object({{"accounts", array(ref("ChangedAccount"),
                                                     "Accounts in the order of the request")}})}};
}

}  // namespace

std::vector<RouteInfo> account_changes_routes() {
  RouteInfo out{.method = "POST",
                .path = "/api/v1/accounts/change",
                .id = "changeAccounts",
                .summary =
                    "Change role, level, cohort, badges or passwords of many accounts, all "
                    "or none",
                .who = {Role::admin},
                .parameters = {},
                .body = "AccountChanges",
                .body_limit_bytes = kMaxChanges_bytes,
                .answer = "ChangedAccounts",
                .schemas = change_schemas(),
                .handle = change_accounts};
  out.lane = http::Lane::hashing;
  out.ends = {{"/accounts/*/id", Object::account, {Role::admin}},
              {"/cohort", Object::cohort, {Role::admin}}};
  return {out};
}

}  // namespace api
}  // namespace tractus
