/// Keys of the server that are not in its database: what is stolen with the database alone stays
/// shut.
#pragma once

#include <array>
#include <string>

#include "core/bytes.hpp"
#include "core/result.hpp"
#include "core/signing.hpp"

namespace tractus::api {

/// One master key of 32 bytes; each purpose has a key of its own derived from it (BLAKE2b,
/// libsodium's crypto_kdf).
class Secrets {
 public:
  using Key = std::array<std::byte, 32>;
  explicit Secrets(const Key& master) : master_(master) {}
  /// Of this process alone: what it seals no other opens.
  static Secrets random();

  Key audit_key() const;
  /// What the server signs the cases with that are made on it.
  core::KeyPair case_key() const;
  Key uid_key() const;  ///< of the identifiers that replace a scan's own
  /// Authenticated encryption (XSalsa20-Poly1305) as hexadecimal text.
  std::string sealed(std::string_view text) const;
  /// Errors: corrupt when it was not sealed by this key, or was changed.
  core::Result<std::string> opened(const std::string& sealed_text) const;

 private:
  Key derived(std::uint64_t purpose) const;
  Key master_;
};

}  // namespace tractus::api
