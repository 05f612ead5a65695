/// Accounts: made, switched off, given a role, a badge, a new password. By administrators; badge
/// and PIN of their trainees by those who teach them.
#include "core/bytes.hpp"
#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/finding/list_request.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/people/throttle.hpp"
#include "server/api/people/token_scopes.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using store::AccountState;

constexpr std::uint64_t kMaxAccount_bytes = 8192;

Result<http::Response> list_accounts(const Call& call) {
  const auto request = TRY(list_request(call, store::account_list()));
  auto found = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::find_accounts(tx, request); }));
  core::Json list = core::Json::array();
  for (const auto& account : found.accounts) list.push_back(account_json(account));
  return json_response(with_page({{"accounts", list}}, found.page));
}

Role role_field(core::Fields& fields) {
  const auto role = fields.word<Role>("role");
  if (role == Role::station)
    fields.wrong("role", "admin, director, faculty, researcher, technician or trainee is expected");
  return role;
}

/// The account that a request's body describes; without a password, one is generated.
struct Wanted {
  store::Account account;
  std::string password, pin;
  bool made = false;
};

Result<Wanted> wanted(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  Wanted out;
  out.account.id = core::new_id();
  out.account.name = fields.text("name", kMaxName);
  if (out.account.name.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("name", "a name is expected");
  out.account.role = role_field(fields);
  out.password = password_field(fields, "password", false);
  out.account.badge = badge_field(fields);
  out.pin = pin_field(fields);
  out.account.level = level_field(fields);
  TRY(fields.done());
  out.made = out.password.empty();
  if (out.made) out.password = made_password();
  out.account.must_change = true;
  out.account.pseudonym = new_pseudonym();
  return out;
}

Result<http::Response> add_account_route(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  auto asked = TRY(wanted(json, "body"));
  auto hash = TRY(password_hash(asked.password));
  asked.account.password_hash = hash;
  if (!asked.pin.empty()) {
    auto pin = TRY(password_hash(asked.pin));
    asked.account.pin_hash = pin;
  }
  asked.account.made_utc_us = call.backend.now_utc_us();
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::add_account(tx, asked.account, asked.account.made_utc_us);
  }));
  core::Json answer{{"account", account_json(asked.account)}};
  answer["password"] = asked.made ? core::Json(asked.password) : core::Json();
  return json_response(answer, 201);
}

/// Changes the account of the path within one transaction, ends its sessions and answers with it.
/// `work(account)` may refuse.
template <class Work>
Result<http::Response> changed_account(const Call& call, Work work) {
  auto account = TRY(call.backend.store.write([&](store::Writing& tx) -> Result<store::Account> {
    auto found = account_of_call(tx, call);
    if (!found) return found;
    TRY(work(tx, *found));
    TRY(store::set_account(tx, *found));
    TRY(store::remove_sessions_of(tx, found->id, ""));
    return found;
  }));
  close_conversations(call.backend, account.id);
  return json_response(account_json(account));
}

Result<http::Response> set_state(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const auto state = fields.word<AccountState>("state");
  TRY(fields.done());
  return changed_account(call, [&](store::Writing& tx, store::Account& account) -> Result<void> {
    if (state == AccountState::disabled && account.role == Role::admin)
      TRY(check_an_admin_stays(tx, account));
    account.state = state;
    if (state == AccountState::active) return {};
    return store::revoke_api_tokens_of(tx, account.id, token_end_of(call));
  });
}

Result<http::Response> set_role(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const Role role = role_field(fields);
  TRY(fields.done());
  return changed_account(call, [&](store::Writing& tx, store::Account& account) -> Result<void> {
    if (account.role == Role::admin && role != Role::admin) TRY(check_an_admin_stays(tx, account));
    account.role = role;
    return store::limit_api_tokens_of(tx, account.id, scopes_for(role), token_end_of(call));
  });
}

/// For other people's accounts only: the route for one's own account asks for the old password.
Result<http::Response> reset_password(const Call& call) {
  if (call.text("id") == call.caller.id)
    return Error{
        Errc::forbidden,
        "this is your own account: change its password with POST /api/v1/session/password"};
  const std::string password = made_password();
  auto hash = TRY(password_hash(password));
  TRY(changed_account(call, [&](store::Writing& tx, store::Account& account) -> Result<void> {
    TRY(store::revoke_api_tokens_of(tx, account.id, token_end_of(call)));
    account.password_hash = hash;
    account.must_change = true;
    account.totp_secret.clear();
    account.totp_confirmed = false;
    return start_afresh(tx, account.id, store::Secret::account_password, account.name);
  }));
  return json_response({{"password", password}});
}

Result<http::Response> set_badge(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string badge = badge_field(fields), pin = pin_field(fields);
  TRY(fields.done());
  std::string hash;
  if (!pin.empty()) {
    auto made = TRY(password_hash(pin));
    hash = std::move(made);
  }
  return changed_account(call, [&](store::Writing& tx, store::Account& account) {
    account.badge = badge;
    account.pin_hash = hash;
    return start_afresh(tx, account.id, store::Secret::badge_pin, badge);
  });
}

RouteInfo account_route(std::string tail, std::string id, std::string summary, std::string answer,
                        Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = "POST",
                .path = "/api/v1/accounts" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin},
                .object = tail.empty() ? Object::none : Object::account,
                .parameters = {},
                .body = "",
                .body_limit_bytes = kMaxAccount_bytes,
                .answer = std::move(answer),
                .schemas = {},
                .handle = handle};
  if (!tail.empty()) out.parameters.push_back(path_text("id", "Id of the account"));
  return out;
}

}  // namespace

std::vector<RouteInfo> accounts_routes() {
  using namespace schema;
  RouteInfo list =
      account_route("", "accounts", "List accounts, without password hashes and secrets",
                    "Accounts", list_accounts);
  list.method = "GET";
  list.body_limit_bytes = 0;
  list.parameters = list_parameters(store::account_list(), "name, badge or level");
  std::vector<Field> fields = page_fields();
  fields.emplace_back("accounts", array(ref("Account"), "Accounts in the order asked for"));
  list.schemas = {{"Account", account_schema()}, {"Accounts", object(fields)}};
  RouteInfo add =
      account_route("", "addAccount",
                    "Create an account; its owner must choose a new password at the first sign-in",
                    "NewAccountMade", add_account_route);
  add.lane = http::Lane::hashing;
  add.body = "NewAccount";
  add.schemas = {
      {"NewAccount",
       object({{"name", text("Name of the account, at most 128 bytes")},
               {"role", text("Role of the account: admin, director, faculty, researcher, "
                             "technician or trainee")},
               {"password", optional(text("Initial password, 12 to 1024 bytes; if it is missing, "
                                          "the server generates a password"))},
               {"badge", optional(text("Text of the badge that a station's reader reads"))},
               {"pin", optional(text("PIN for signing in at stations, 4 to 12 digits"))},
               {"level", optional(text("Level of training, at most 64 bytes"))}})},
      {"NewAccountMade",
       object({{"account", ref("Account")},
               {"password", nullable(text("Generated password, shown only in this answer; null if "
                                          "the request gave a password"))}})}};
  RouteInfo state = account_route("/{id}/state", "setAccountState",
                                  "Disable or enable an account; this ends the account's sessions",
                                  "Account", set_state);
  state.body = "AccountState";
  state.schemas = {
      {"AccountState",
       object({{"state", one_of<AccountState>(
                             "New state of the account; a disabled account cannot sign in")}})}};
  RouteInfo role = account_route("/{id}/role", "setAccountRole",
                                 "Change the role of an account; this ends the account's sessions",
                                 "Account", set_role);
  role.body = "AccountRole";
  role.schemas = {
      {"AccountRole",
       object({{"role",
                text("New role: admin, director, faculty, researcher, technician or trainee")}})}};
  RouteInfo reset = account_route(
      "/{id}/password", "resetPassword",
      "Set a new generated password for another person's account; this ends the account's "
      "sessions and API tokens, turns its one-time codes off and clears its failed attempts",
      "PasswordMade", reset_password);
  reset.lane = http::Lane::hashing;
  reset.schemas = {{"PasswordMade",
                    object({{"password", text("Generated password, shown only in this answer")}})}};
  RouteInfo badge =
      account_route("/{id}/badge", "setBadge",
                    "Set or remove the badge and the PIN for stations; this ends the "
                    "account's sessions and clears the failed attempts with the badge",
                    "Account", set_badge);
  badge.lane = http::Lane::hashing;
  badge.who.push_back({Role::faculty, Scope::cohort});
  badge.body = "Badge";
  badge.schemas = {
      {"Badge",
       object(
           {{"badge", optional(text("Text of the badge; if it is missing, the badge is removed"))},
            {"pin",
             optional(text("PIN of 4 to 12 digits; if it is missing, the PIN is removed"))}})}};
  return {list, add, state, role, reset, badge};
}

}  // namespace api
}  // namespace tractus
