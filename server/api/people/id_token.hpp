/// Validates the ID token of an OpenID Connect provider (OpenID Connect Core 1.0, section 3.1.3.7;
/// RFC 7515, 7517, 7518, 8725).
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"

namespace tractus::api {

/// The expected values of an ID token's claims.
struct Expected {
  std::string issuer, client_id, nonce;
  std::int64_t now_s = 0;
};

struct Identity {
  std::string subject;  ///< the provider's unique and permanent identifier of the person
  std::string sid;      ///< id of the provider's session; may be empty
  std::string name;     ///< claim name, else preferred_username; may be empty
  std::vector<std::string> groups;  ///< claim groups; empty if there is none
};

/// Largest allowed difference of the clocks.
inline constexpr std::int64_t kSkew_s = 60;
/// Largest age of a token; an older token does not belong to the current sign-in.
inline constexpr std::int64_t kMostAge_s = 600;

/// Checks the signature (only RS256 or ES256, with the key that the token names), issuer, audience,
/// authorised party, expiry, age, nonce and subject; returns all claims.
/// @param keys  a JSON Web Key Set
/// Errors: unauthorised, naming the failed check; not_found if the set lacks the named key (the
/// provider may have replaced its keys: fetch the set again).
core::Result<core::Json> claims_of(std::string_view id_token, const core::Json& keys,
                                   const Expected& expected);
Identity identity_in(const core::Json& claims);
/// Both.
core::Result<Identity> identity_of(std::string_view id_token, const core::Json& keys,
                                   const Expected& expected);

/// The key set, at most so many seconds old.
using KeysOfAge = std::function<core::Result<core::Json>(std::int64_t age_s)>;
/// claims_of by keys of up to an hour; for an unknown key the set is asked for once more, at most
/// every ten seconds. Errors: unauthorised; those of `keys`.
core::Result<core::Json> claims_by(const KeysOfAge& keys, std::string_view id_token,
                                   const Expected& expected);

}  // namespace tractus::api
