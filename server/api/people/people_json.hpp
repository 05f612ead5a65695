/// Accounts as the routes show and take them.
#pragma once

#include "db/store/people/people.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// At least so long; longer is better than odder (NIST SP 800-63B section 5.1.1).
inline constexpr std::size_t kMinPassword = 12;
inline constexpr std::size_t kMinPin = 4, kMaxPin = 12, kMaxBadge = 64;

/// Never a hash, a secret or the pseudonym: that one is for the export's key alone.
core::Json account_json(const store::Account& account);
core::Json account_schema();

/// Fields of a body, checked; what is wrong is noted in `fields`.
std::string password_field(core::Fields& fields, const char* key, bool needed);
std::string pin_field(core::Fields& fields);
std::string badge_field(core::Fields& fields);

/// The account of the path's id. Errors: not_found.
core::Result<store::Account> account_of_call(store::Reading& tx, const Call& call);

/// A password of 16 characters that nobody chose: 80 bits, without letters that look alike.
std::string made_password();
/// "P" and eight characters: an account's name in research.
std::string new_pseudonym();

}  // namespace tractus::api
