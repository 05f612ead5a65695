/// What a provider of identities says of who signed in, checked (OpenID Connect Core 1.0, section
/// 3.1.3.7; RFC 7515, 7517, 7518, 8725).
#pragma once

#include <string>
#include <string_view>

#include "core/json.hpp"

namespace tractus::api {

/// What an id_token must be of and for.
struct Expected {
  std::string issuer, client_id, nonce;
  std::int64_t now_s = 0;
};

struct Identity {
  std::string subject;  ///< the provider's name for the person, never another's
  std::string sid;      ///< of the provider's session; may be empty
};

/// Clocks may differ by so much.
inline constexpr std::int64_t kSkew_s = 60;
/// A token older than this is not of the sign-in at hand.
inline constexpr std::int64_t kMostAge_s = 600;

/// Checks signature (RS256 or ES256 alone, by the key of the set that the token names and that is
/// of its kind), issuer, audience, authorised party, expiry, age, nonce and subject.
/// @param keys  a JSON Web Key Set
/// Errors: unauthorised, naming what does not hold; not_found when no key of the set is the one
/// named (it may have been replaced: fetch the set again).
core::Result<Identity> identity_of(std::string_view id_token, const core::Json& keys,
                                   const Expected& expected);

/// RFC 4648 section 5, without padding.
std::string base64url(std::string_view bytes);
/// Errors: bad_input.
core::Result<std::string> base64url_decoded(std::string_view text);

}  // namespace tractus::api
