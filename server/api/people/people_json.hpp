/// Accounts in the JSON form of the routes.
#pragma once

#include "db/store/people/people.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// Smallest length of a password; length matters more than special characters (NIST SP 800-63B,
/// section 5.1.1).
inline constexpr std::size_t kMinPassword = 12;
inline constexpr std::size_t kMinPin = 4, kMaxPin = 12, kMaxBadge = 64;

/// The account without hashes, secrets and the pseudonym, which only the key table of the exports
/// shows.
core::Json account_json(const store::Account& account);
core::Json account_schema();

/// Reads and checks fields of a body; errors are added to `fields`.
std::string password_field(core::Fields& fields, const char* key, bool needed);
std::string pin_field(core::Fields& fields);
std::string badge_field(core::Fields& fields);
/// Level of training, at most 64 bytes; empty if there is none.
std::string level_field(core::Fields& fields);

/// The account of the path's id. Errors: not_found.
core::Result<store::Account> account_of_call(store::Reading& tx, const Call& call);

/// Refuses a change of this account that would leave no active administrator. Errors: conflict.
core::Result<void> check_an_admin_stays(store::Reading& tx, const store::Account& changing);

/// A random password of 16 characters: 80 bits, without letters that look alike.
std::string made_password();
/// A pseudonym of an account for research: "P" and eight characters.
std::string new_pseudonym();

}  // namespace tractus::api
