/// Bytes, checksums and content addresses.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tractus::core {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<const std::byte>;

inline ByteView bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }
inline std::string_view text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// CRC-32C (Castagnoli), as in RFC 3720; `seed` is the value so far, so that parts may be chained.
std::uint32_t crc32c(ByteView bytes, std::uint32_t seed = 0) noexcept;

/// Lower-case hexadecimal SHA-256: the name of content.
std::string sha256(ByteView bytes);

/// SHA-256 of what comes in parts.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  void add(ByteView part) noexcept;
  /// Ends it: add nothing afterwards.
  std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// 64 characters 0-9a-f?
bool is_sha256(std::string_view text) noexcept;

/// Text forms of bytes, by libsodium: lower-case hexadecimal, base64 of RFC 4648 section 4 (padded)
/// and of section 5 (not padded). Decoded is only what is whole: no blanks, no digits left over, of
/// base64 only the one text that encoding gives.
std::string hex(ByteView bytes);
std::string base64(ByteView bytes);
std::string base64url(ByteView bytes);
std::optional<Bytes> hex_decoded(std::string_view text);  ///< of either case
std::optional<Bytes> base64_decoded(std::string_view text);
std::optional<Bytes> base64url_decoded(std::string_view text);

/// `length` random bytes of the system's generator: keys, tokens, salts.
Bytes random_bytes(std::size_t length);
/// A new name nobody has: 32 hexadecimal characters, the first 12 the UTC milliseconds, so that
/// names sort by time.
std::string new_id();
/// Is `text` such a name?
bool is_id(std::string_view text) noexcept;

}  // namespace tractus::core
