/// Proof that a request comes from the account's owner, not from another person at an open browser:
/// the password, and a one-time code if the account uses them.
#pragma once

#include "db/store/people/accounts.hpp"
#include "db/store/people/sign_ins.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

struct OwnerProof {
  const char* field;  ///< of the body, that holds the password
  std::string password, code;
};

/// The attempt that the throttle counts: the caller's, in this session.
store::Attempt own_attempt_of(const Call& call);
/// The caller's account, outside a change.
core::Result<store::Account> own_account(store::Reading& tx, const Call& call);
/// The caller's account, if the caller's session is still valid: a password reset by an
/// administrator ends the session. Errors: unauthorised.
core::Result<store::Account> account_of_session(store::Writing& tx, const Call& call);
/// The refusal if the password is wrong, or if a required one-time code is missing; else nothing.
core::Result<std::optional<http::Response>> refusal_of(const Call& call, const OwnerProof& proof);
/// Checks the one-time code and marks it as used, within the transaction of the change.
/// @param wrong  gets whether it is wrong: the caller then counts a failed attempt
core::Result<void> take_code(const Call& call, store::Account& account, const std::string& code,
                             bool& wrong);

}  // namespace tractus::api
