/// Links between accounts and persons of an OpenID Connect provider, which an administrator makes.
#pragma once

#include "db/store/people/accounts.hpp"

namespace tractus::store {

struct Subject {
  std::string issuer, subject;
  std::string account_id;
  std::int64_t linked_utc_us = 0;
  std::string linked_by;
};

/// Links an account with one subject of an issuer, and removes an older link of the account. An
/// empty subject only removes the link. A password that another person set for the account is
/// removed. Errors: not_found (account); conflict if another account has the subject.
core::Result<void> link_subject(Writing& tx, const Subject& link);
core::Result<std::optional<Account>> account_of_subject(Reading& tx, const std::string& issuer,
                                                        const std::string& subject);
/// Of the account; empty: none.
core::Result<std::string> subject_of(Reading& tx, const std::string& issuer,
                                     const std::string& account_id);

}  // namespace tractus::store
