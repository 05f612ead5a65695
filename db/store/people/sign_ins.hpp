/// Failed sign-in attempts, and the origins from which each account signed in before: the data of
/// the throttle (server/api/people/throttle.hpp).
#pragma once

#include "db/store/store.hpp"

namespace tractus::store {

/// The kind of secret that an attempt contains. Each kind has separate names: an account "102" is
/// not badge 102.
enum class Secret { account_password, badge_pin, enrolment_code, own_password, api_token };

/// One sign-in attempt.
struct Attempt {
  Secret secret;
  std::string name;    ///< account or badge; empty if this kind of secret has no names
  std::string origin;  ///< network address, station or session, depending on the kind
};

/// Which attempts share one sum of failures.
enum class Total {
  pair,    ///< of one name from one origin
  name,    ///< of one name from all origins
  origin,  ///< of all names from one origin
};

struct Failures {
  double count = 0.0;          ///< sum at the time `at_utc_us`; it decreases afterwards
  std::int64_t at_utc_us = 0;  ///< time of the last failure; 0: there was none
};
core::Result<Failures> failures_of(Reading& tx, const Attempt& attempt, Total total);
core::Result<void> set_failures(Writing& tx, const Attempt& attempt, Total total,
                                const Failures& failures);
/// Of this pair.
core::Result<void> clear_failures(Writing& tx, const Attempt& attempt);
/// Of this name, from everywhere.
core::Result<void> clear_failures_of_name(Writing& tx, Secret secret, const std::string& name);
/// Those whose last failure is older.
core::Result<void> remove_old_failures(Writing& tx, std::int64_t before_utc_us);

/// Did the account or the badge with this name sign in from this origin before?
core::Result<bool> is_known_origin(Reading& tx, const Attempt& attempt);
/// Did any account sign in from this origin before?
core::Result<bool> is_known_origin(Reading& tx, Secret secret, const std::string& origin);
/// Records that the account signed in, and forgets origins that were not used since a time.
core::Result<void> note_origin(Writing& tx, const std::string& account_id, const Attempt& from,
                               std::int64_t now_utc_us, std::int64_t forget_before_utc_us);
/// Forgets all origins from which the account signed in with this kind of secret.
core::Result<void> forget_origins(Writing& tx, const std::string& account_id, Secret secret);

}  // namespace tractus::store
