/// What a learning platform says in a launch (1EdTech LTI 1.3 Core, section 5; LTI AGS 2.0, section 3.1).
#pragma once

#include "core/json.hpp"
#include "db/store/learning/platforms.hpp"

namespace tractus::api {

struct Launch {
  std::string subject;     ///< the platform's identifier of the person
  std::string email;       ///< only if the platform says that it verified the address; else empty
  std::string assignment;  ///< custom parameter `assignment`: id of what is opened; may be empty
  std::string line_item;   ///< where a score may be sent; empty: nowhere
};
/// @param claims  of an id_token that was checked (id_token.hpp)
/// Errors: unauthorised for another message than a launch of a resource in LTI 1.3, and for a
/// deployment that the platform was not registered with.
core::Result<Launch> launch_in(const core::Json& claims, const store::Platform& platform);

/// Permission to send scores: a scope of OAuth 2.
inline constexpr const char* kScoreScope = "https://purl.imsglobal.org/spec/lti-ags/scope/score";

}  // namespace tractus::api
