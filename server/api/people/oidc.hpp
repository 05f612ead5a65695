/// Sign-in with an OpenID Connect provider: authorization code flow with PKCE (RFC 7636, RFC 9700).
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "server/api/people/id_token.hpp"
#include "server/api/people/kept_document.hpp"

namespace tractus::api {

/// "tractus-oidc/1": {"format","issuer","client_id","client_secret_file" (relative to the
/// settings), "base" (how browsers reach this server, "https://host:8480"),"label","authority"?
/// (PEM file)}.
struct OidcSettings {
  std::string issuer, client_id, client_secret, base, label;
  std::filesystem::path authority;
  std::chrono::milliseconds patience{5000};  ///< time limit for one complete answer of the provider
};
/// Errors: those of reading; bad_input naming file and field.
core::Result<OidcSettings> read_oidc_settings(const std::filesystem::path& path);

/// The state of one sign-in attempt, which the browser keeps in an encrypted cookie.
struct OidcAttempt {
  std::string state, nonce, verifier;
};
OidcAttempt new_attempt();

/// One provider. Its metadata and keys are fetched when needed and cached for an hour; for an
/// unknown key they are fetched again, at most every ten seconds. After a failure no requests are
/// sent for a while (Breaker), so that each call takes at most a few times `patience`. Thread-safe.
class Oidc {
 public:
  explicit Oidc(OidcSettings settings, SteadyClock_s now_s = steady_now_s)
      : settings_(std::move(settings)),
        breaker_(now_s),
        description_(breaker_, now_s),
        keys_(breaker_, now_s) {}
  const OidcSettings& settings() const { return settings_; }

  /// The address to which the browser is redirected. Errors: unavailable, corrupt (invalid metadata
  /// of the provider).
  core::Result<std::string> sign_in_address(const OidcAttempt& attempt) const;
  /// Exchanges the authorization code for an identity. Errors: unauthorised; those above.
  core::Result<Identity> redeemed(const std::string& code, const OidcAttempt& attempt,
                                  std::int64_t now_s) const;
  /// The address at which a browser ends the provider's session; empty if the provider has none.
  core::Result<std::string> sign_out_address() const;

 private:
  core::Result<core::Json> described() const;
  core::Result<core::Json> fetched_description() const;
  core::Result<core::Json> keys(std::int64_t age_s) const;
  core::Result<core::Json> tokens(const std::string& code, const OidcAttempt& attempt) const;

  OidcSettings settings_;
  mutable Breaker breaker_;
  mutable KeptDocument description_, keys_;
};

}  // namespace tractus::api
