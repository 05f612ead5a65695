/// Learning platforms (LTI 1.3) that may open the pages of this server, their used nonces, and the key of the tool.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct Platform {
  std::string id, issuer;
  std::string client_id;  ///< of this server at the platform
  std::vector<std::string> deployments;
  std::string authorization_url, token_url, keys_url;
  bool match_email = false;  ///< a verified e-mail address finds the account of a trainee
  std::int64_t made_utc_us = 0;
  std::string made_by;
};
inline constexpr std::int64_t kMaxPlatforms = 50;
/// Errors: conflict if there are kMaxPlatforms, or one with this issuer and client_id.
core::Result<void> add_platform(Writing& tx, const Platform& platform);
/// By issuer and client_id.
core::Result<std::vector<Platform>> all_platforms(Reading& tx);
core::Result<std::optional<Platform>> platform_of(Reading& tx, const std::string& id);
/// Also removes its line items, and the links of people to its issuer if no other platform has the
/// issuer; waiting deliveries are withdrawn. @param kept_issuer  links to this issuer stay: the
/// provider of sign-in. Errors: not_found.
core::Result<void> remove_platform(Writing& tx, const std::string& id,
                                   const std::string& kept_issuer, std::int64_t now_utc_us);

/// Errors: unauthorised if the nonce was used before. @param until_utc_us  later, a launch with this
/// nonce is too old; then the nonce is forgotten.
core::Result<void> use_nonce(Writing& tx, const std::string& nonce, std::int64_t until_utc_us,
                             std::int64_t now_utc_us);

struct ToolKeyRow {
  std::string kid;
  std::string private_key;  ///< encrypted PEM
  std::string public_key;   ///< JSON Web Key
  std::int64_t made_utc_us = 0;
};
/// The oldest.
core::Result<std::optional<ToolKeyRow>> tool_key_row(Reading& tx);
core::Result<void> add_tool_key(Writing& tx, const ToolKeyRow& key);

/// The only active trainee with this e-mail address for notifications; none if there are several.
core::Result<std::string> trainee_with_address(Reading& tx, const std::string& address);

}  // namespace tractus::store
