/// Whom a provider of identities vouches for, where an administrator said which account that is.
#pragma once

#include "db/store/people/accounts.hpp"

namespace tractus::store {

struct Subject {
  std::string issuer, subject;
  std::string account_id;
  std::int64_t linked_utc_us = 0;
  std::string linked_by;
};

/// One subject of an issuer for an account at a time: an older link of the account's is gone. An
/// empty subject ends it. An account whose password was another's choice has none from now on.
/// Errors: not_found (account); conflict when the subject is another account's.
core::Result<void> link_subject(Writing& tx, const Subject& link);
core::Result<std::optional<Account>> account_of_subject(Reading& tx, const std::string& issuer,
                                                        const std::string& subject);
/// Of the account; empty: none.
core::Result<std::string> subject_of(Reading& tx, const std::string& issuer,
                                     const std::string& account_id);

}  // namespace tractus::store
