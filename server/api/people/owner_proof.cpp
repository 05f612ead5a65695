#include "server/api/people/owner_proof.hpp"

#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/throttle.hpp"

namespace tractus::api {

store::Attempt own_attempt_of(const Call& call) {
  return {store::Secret::own_password, call.caller.id, call.caller.session_hash};
}

core::Result<store::Account> own_account(store::Reading& tx, const Call& call) {
  auto account = TRY(store::account_of(tx, call.caller.id));
  core::require(account.has_value(), "who is signed in has an account");
  return std::move(*account);
}

core::Result<store::Account> account_of_session(store::Writing& tx, const Call& call) {
  auto session = TRY(store::session_of(tx, call.caller.session_hash));
  if (!session) return core::Error{core::Errc::unauthorised, "sign in first: the session is over"};
  return std::move(session->account);
}

core::Result<std::optional<http::Response>> refusal_of(const Call& call, const OwnerProof& proof) {
  auto early = too_early(call.backend, own_attempt_of(call));
  if (!early || *early) return early;
  auto account =
      TRY(call.backend.store.read([&](store::Reading& tx) { return own_account(tx, call); }));
  if (!password_matches(account.password_hash, proof.password)) {
    TRY(note_failure(call.backend, own_attempt_of(call)));
    return core::Error{core::Errc::forbidden,
                       std::string("body: /") + proof.field + ": the password is wrong"};
  }
  if (!account.totp_confirmed || !proof.code.empty()) return std::optional<http::Response>();
  return std::optional(
      http::error_response(403, "code_needed", "body: /code: a one-time code is required"));
}

core::Result<void> take_code(const Call& call, store::Account& account, const std::string& code,
                             bool& wrong) {
  wrong = !use_code(call.backend, account, code);
  if (wrong) return core::Error{core::Errc::forbidden, "body: /code: the one-time code is wrong"};
  return {};
}

}  // namespace tractus::api
