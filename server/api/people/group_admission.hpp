/// Lets people in by the groups that the identity provider vouches for: accounts are made, changed
/// and disabled by the newest rule, at each sign-in.
#pragma once

#include "db/store/people/accounts.hpp"
#include "server/api/people/group_rule.hpp"
#include "server/api/people/id_token.hpp"

namespace tractus::api {

struct Admission {
  std::string issuer;
  Identity identity;
  std::int64_t now_utc_us = 0;
};

/// The newest rule; nothing: none was ever written. Errors: corrupt.
core::Result<std::optional<GroupRule>> current_group_rule(store::Reading& tx);

/// Applies the newest rule to this person. An account that an administrator made or disabled by
/// hand is left as it is, and so is an administrator's; another account of the person's name is not
/// taken over (conflict). Whom no line fits gets no account; whose account a rule made, loses it:
/// it is disabled and its sessions end.
core::Result<void> admit_by_groups(store::Writing& tx, const Admission& admission);

/// Whether a rule made the account and the provider has not vouched for the person for longer than
/// the rule allows.
core::Result<bool> is_absent(store::Reading& tx, const store::Account& account,
                             std::int64_t now_utc_us);
/// Disables such an account, as one whom no line fits.
core::Result<void> disable_absent(store::Writing& tx, const store::Account& account,
                                  std::int64_t now_utc_us);

}  // namespace tractus::api
