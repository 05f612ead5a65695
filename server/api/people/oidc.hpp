/// Signing in by a provider of identities: OpenID Connect, authorization code with PKCE (RFC 7636,
/// RFC 9700).
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
  std::chrono::milliseconds patience{5000};  ///< with one answer of the provider, whole
};
/// Errors: those of reading; bad_input naming file and field.
core::Result<OidcSettings> read_oidc_settings(const std::filesystem::path& path);

/// What one sign-in takes with it, in the browser's sealed cookie.
struct OidcAttempt {
  std::string state, nonce, verifier;
};
OidcAttempt new_attempt();

/// One provider. Its description and keys are fetched when needed and kept for an hour; unknown
/// keys are asked for again, at most every ten seconds. A provider that fails is left alone for a
/// while (Breaker): each call takes a few `patience` at most. Safe from several threads.
class Oidc {
 public:
  explicit Oidc(OidcSettings settings, SteadyClock_s now_s = steady_now_s)
      : settings_(std::move(settings)),
        breaker_(now_s),
        description_(breaker_, now_s),
        keys_(breaker_, now_s) {}
  const OidcSettings& settings() const { return settings_; }

  /// Where the browser is sent to. Errors: unavailable, corrupt (the provider's description).
  core::Result<std::string> sign_in_address(const OidcAttempt& attempt) const;
  /// The code for an identity. Errors: unauthorised; those above.
  core::Result<Identity> redeemed(const std::string& code, const OidcAttempt& attempt,
                                  std::int64_t now_s) const;
  /// Where a browser ends the provider's own session; empty when it offers none.
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
