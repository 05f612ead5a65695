#include "server/api/learning/launch.hpp"

#include <algorithm>

#include "core/try.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;

std::string claim(const char* name) {
  return std::string("https://purl.imsglobal.org/spec/lti/claim/") + name;
}

/// The object of this claim; empty if there is none.
Json object_claim(const Json& claims, const std::string& name) {
  const auto found = claims.find(name);
  return found != claims.end() && found->is_object() ? *found : Json::object();
}

std::string line_item_in(const Json& claims) {
  const Json endpoint =
      object_claim(claims, "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint");
  const Json scopes = endpoint.value("scope", Json::array());
  const bool allowed = scopes.is_array() && std::ranges::count(scopes, Json(kScoreScope)) > 0;
  return allowed ? core::text_member(endpoint, "lineitem") : std::string();
}

}  // namespace

core::Result<Launch> launch_in(const Json& claims, const store::Platform& platform) {
  if (core::text_member(claims, claim("message_type").c_str()) != "LtiResourceLinkRequest")
    return Error{Errc::unauthorised, "the platform sent another message than a launch"};
  if (core::text_member(claims, claim("version").c_str()) != "1.3.0")
    return Error{Errc::unauthorised, "the platform sent another version than LTI 1.3.0"};
  const std::string deployment = core::text_member(claims, claim("deployment_id").c_str());
  if (std::ranges::count(platform.deployments, deployment) == 0)
    return Error{Errc::unauthorised,
                 "the platform has another deployment (deployment_id) than it was registered with"};
  Launch out{.subject = core::text_member(claims, "sub"),
             .email = {},
             .assignment = core::text_member(object_claim(claims, claim("custom")), "assignment"),
             .line_item = line_item_in(claims)};
  if (claims.value("email_verified", Json()) == Json(true))
    out.email = core::text_member(claims, "email");
  return out;
}

}  // namespace api
}  // namespace tractus
