/// The key with which this server, as a tool of learning platforms, signs its requests (RS256).
#pragma once

#include "core/json.hpp"
#include "server/api/backend.hpp"

namespace tractus::api {

struct ToolKey {
  std::string kid;
  std::string pem;  ///< private key, PKCS #8
  core::Json jwk;   ///< public key, RFC 7517
};
/// A new RSA key of 2048 bits.
ToolKey new_tool_key();
/// The server's key, which is made at the first use and kept encrypted in the database. Errors:
/// those of the database; corrupt if the key does not open.
core::Result<ToolKey> tool_key(Backend& backend);

/// A JSON Web Token of these claims, signed by RS256. Errors: corrupt if the key is none.
core::Result<std::string> signed_token(const ToolKey& key, const core::Json& claims);

}  // namespace tractus::api
