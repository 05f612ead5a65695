/// Ed25519 signatures: who made a bundle, and that nobody changed it since.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "core/bytes.hpp"
#include "core/result.hpp"

namespace tractus::core {

struct KeyPair {
  std::string public_hex;  ///< 64 hexadecimal characters
  Bytes secret;            ///< 64 bytes; never leaves the maker's disk

  static KeyPair generate();
  /// The one key that belongs to these 32 bytes.
  static KeyPair from_seed(const std::array<std::byte, 32>& seed);
  /// Reads the key at `path`, or makes one there (mode 0600) when there is none.
  static Result<KeyPair> open_or_make(const std::filesystem::path& path);
};

/// 128 hexadecimal characters.
std::string sign(ByteView message, const KeyPair& key);
bool verify(ByteView message, std::string_view signature_hex, std::string_view public_hex) noexcept;

}  // namespace tractus::core
