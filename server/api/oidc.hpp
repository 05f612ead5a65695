/// Signing in by a provider of identities: OpenID Connect, authorization code with PKCE (RFC 7636,
/// RFC 9700).
#pragma once

#include <filesystem>
#include <mutex>
#include <string>

#include "server/api/id_token.hpp"

namespace api {

/// "tractus-oidc/1": {"format","issuer","client_id","client_secret_file" (relative to the
/// settings), "base" (how browsers reach this server, "https://host:8480"),"label","authority"?
/// (PEM file)}.
struct OidcSettings {
  std::string issuer, client_id, client_secret, base, label;
  std::filesystem::path authority;
};
/// Errors: those of reading; bad_input naming file and field.
core::Result<OidcSettings> read_oidc_settings(const std::filesystem::path& path);

/// What one sign-in takes with it, in the browser's sealed cookie.
struct OidcAttempt {
  std::string state, nonce, verifier;
};
OidcAttempt new_attempt();

/// One provider. Its description and keys are fetched when needed and kept for an hour; unknown
/// keys are asked for again, at most every ten seconds. Safe from several threads.
class Oidc {
 public:
  explicit Oidc(OidcSettings settings) : settings_(std::move(settings)) {}
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
  core::Result<core::Json> keys(bool again) const;

  OidcSettings settings_;
  mutable std::mutex mutex_;  ///< guards what was fetched
  mutable core::Json description_, keys_;
  mutable std::int64_t described_s_ = 0, keys_s_ = 0;
};

}  // namespace api
