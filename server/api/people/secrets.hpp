/// Keys of the server that are not in its database, so that secrets in a stolen database cannot be
/// decrypted.
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
  /// Random keys of this process; other processes cannot decrypt what it encrypts.
  static Secrets random();

  Key audit_key() const;
  /// The key with which the server signs the cases that are made on it.
  core::KeyPair case_key() const;
  Key uid_key() const;  ///< for the identifiers that replace those of a scan
  /// Authenticated encryption (XSalsa20-Poly1305) as hexadecimal text.
  std::string sealed(std::string_view text) const;
  /// Errors: corrupt if the text was not encrypted with this key, or was changed.
  core::Result<std::string> opened(const std::string& sealed_text) const;

 private:
  Key derived(std::uint64_t purpose) const;
  Key master_;
};

}  // namespace tractus::api
