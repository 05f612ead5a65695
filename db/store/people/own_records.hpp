/// What the server notes of a person besides the account and the trials: for the person's own copy of it.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct SessionTimes {
  std::int64_t made_utc_us = 0, seen_utc_us = 0;
};
core::Result<std::vector<SessionTimes>> session_times(Reading& tx, const std::string& account_id);

/// Where a person signed in from: a network address or the id of a station.
struct SignInOrigin {
  std::string kind;  ///< of the secret: "account_password", "badge_pin"
  std::string origin;
  std::int64_t seen_utc_us = 0;
};
core::Result<std::vector<SignInOrigin>> sign_in_origins(Reading& tx, const std::string& account_id);

/// A row of the audit trail whose actor is this person.
struct OwnAct {
  std::int64_t at_utc_us = 0;
  std::string what, peer;
};
/// Oldest first.
core::Result<std::vector<OwnAct>> own_acts(Reading& tx, const std::string& name);

}  // namespace tractus::store
