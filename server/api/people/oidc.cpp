#include "server/api/people/oidc.hpp"

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "server/api/web_fetch.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::int64_t kKept_s = 3600;

std::string random_text() { return core::base64url(core::random_bytes(32)); }

/// RFC 7636 section 4.2, S256.
std::string challenge_of(const std::string& verifier) {
  return core::base64url(*core::hex_decoded(core::sha256(core::bytes_of(verifier))));
}

Result<Json> json_at(const std::string& url, const OidcSettings& settings) {
  return fetched_json({.url = url, .authority = settings.authority, .patience = settings.patience});
}

}  // namespace

Result<OidcSettings> read_oidc_settings(const std::filesystem::path& path) {
  const auto json = TRY(core::read_json(path));
  core::Fields fields(json, path.string());
  const std::string format = fields.text("format");
  if (!format.empty() && format != "tractus-oidc/1")
    fields.wrong("format", "tractus-oidc/1 is expected");
  OidcSettings out;
  out.issuer = fields.text("issuer");
  out.client_id = fields.text("client_id");
  const std::string secret = fields.text("client_secret_file");
  out.base = fields.text_or("base", "");
  out.label = fields.text_or("label", "Sign in with your institution", 80);
  out.authority = fields.text_or("authority", "");
  while (out.base.ends_with('/')) out.base.pop_back();
  if (!is_safe_address(out.issuer)) fields.wrong("issuer", "an https address is expected");
  if (!out.base.empty() && !is_safe_address(out.base))
    fields.wrong("base", "an https address is expected");
  TRY(fields.done());
  const auto folder = path.parent_path();
  if (!out.authority.empty()) out.authority = folder / out.authority;
  out.client_secret = TRY(secret_in(folder / secret));
  return out;
}

OidcAttempt new_attempt() { return {random_text(), random_text(), random_text()}; }

Result<Json> Oidc::described() const {
  return description_.at_most(kKept_s, [this] { return fetched_description(); });
}

Result<Json> Oidc::fetched_description() const {
  std::string at = settings_.issuer;
  while (at.ends_with('/')) at.pop_back();
  auto json = json_at(at + "/.well-known/openid-configuration", settings_);
  if (!json) return json.error();
  const auto unfit = [](const std::string& what) {
    return Error{Errc::corrupt, "the provider's description " + what};
  };
  if (core::text_member(*json, "issuer") != settings_.issuer) return unfit("has another issuer");
  for (const char* key : {"authorization_endpoint", "token_endpoint", "jwks_uri"})
    if (!is_safe_address(core::text_member(*json, key)))
      return unfit(std::string("has no https address: ") + key);
  return json;
}

Result<Json> Oidc::keys(std::int64_t age_s) const {
  const auto description = TRY(described());
  return keys_.at_most(
      age_s, [&] { return json_at(core::text_member(description, "jwks_uri"), settings_); });
}

/// The token endpoint's answer to a code. A refusal is no failure of the provider: who sends it
/// wrong codes does not keep others from signing in.
Result<Json> Oidc::tokens(const std::string& code, const OidcAttempt& attempt) const {
  const auto description = TRY(described());
  TRY(breaker_.check());
  auto answer = fetch({.url = core::text_member(description, "token_endpoint"),
                       .form = {{{"grant_type", "authorization_code"},
                                 {"code", code},
                                 {"redirect_uri", settings_.base + "/api/v1/session/oidc/callback"},
                                 {"code_verifier", attempt.verifier}}},
                       .user = percent_encoded(settings_.client_id),
                       .password = percent_encoded(settings_.client_secret),
                       .authority = settings_.authority,
                       .patience = settings_.patience});
  if (!answer) return breaker_.failed(answer.error()), answer.error();
  breaker_.succeeded();
  auto json = core::parse_json(answer->body, "the provider's answer");
  if (answer->status == 200 && json && json->is_object()) return json;
  return Error{Errc::unauthorised, "the provider did not accept its authorization code"};
}

Result<std::string> Oidc::sign_in_address(const OidcAttempt& attempt) const {
  const auto description = TRY(described());
  return with_query(core::text_member(description, "authorization_endpoint"),
                    {{"response_type", "code"},
                     {"client_id", settings_.client_id},
                     {"redirect_uri", settings_.base + "/api/v1/session/oidc/callback"},
                     {"scope", "openid"},
                     {"state", attempt.state},
                     {"nonce", attempt.nonce},
                     {"code_challenge", challenge_of(attempt.verifier)},
                     {"code_challenge_method", "S256"}});
}

Result<Identity> Oidc::redeemed(const std::string& code, const OidcAttempt& attempt,
                                std::int64_t utc_s) const {
  const auto json = TRY(tokens(code, attempt));
  const std::string token = core::text_member(json, "id_token");
  const Expected expected{settings_.issuer, settings_.client_id, attempt.nonce, utc_s};
  const auto claims =
      TRY(claims_by([this](std::int64_t age_s) { return keys(age_s); }, token, expected));
  return identity_in(claims);
}

Result<std::string> Oidc::sign_out_address() const {
  const auto description = TRY(described());
  const std::string endpoint = core::text_member(description, "end_session_endpoint");
  if (!is_safe_address(endpoint)) return std::string();
  return with_query(endpoint, {{"client_id", settings_.client_id},
                               {"post_logout_redirect_uri", settings_.base + "/"}});
}

}  // namespace api
}  // namespace tractus
