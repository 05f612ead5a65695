#include "core/bytes.hpp"

#include <fmt/format.h>
#include <nmmintrin.h>
#include <sodium.h>

#include <algorithm>
#include <cstring>

#include "core/clock.hpp"
#include "core/require.hpp"

namespace tractus {
namespace core {
namespace {
const unsigned char* raw_bytes(ByteView bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

bool all_hex(std::string_view text) noexcept {
  return std::ranges::all_of(
      text, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

std::string base64(ByteView bytes, int variant) {
  std::string out(sodium_base64_encoded_len(bytes.size(), variant), '\0');
  sodium_bin2base64(out.data(), out.size(), raw_bytes(bytes), bytes.size(), variant);
  out.pop_back();
  return out;
}

std::optional<Bytes> base64_decoded(std::string_view text, int variant) {
  Bytes out(text.size() / 4 * 3 + 3);
  std::size_t size = 0;
  if (sodium_base642bin(reinterpret_cast<unsigned char*>(out.data()), out.size(), text.data(),
                        text.size(), nullptr, &size, nullptr, variant) != 0)
    return std::nullopt;
  out.resize(size);
  return out;
}
}  // namespace

std::uint32_t crc32c(ByteView bytes, std::uint32_t seed) noexcept {
  std::uint64_t crc = ~seed;
  while (bytes.size() >= 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), 8);
    crc = _mm_crc32_u64(crc, word);
    bytes = bytes.subspan(8);
  }
  for (const std::byte b : bytes)
    crc = _mm_crc32_u8(static_cast<std::uint32_t>(crc), std::to_integer<std::uint8_t>(b));
  return ~static_cast<std::uint32_t>(crc);
}

bool is_sha256(std::string_view text) noexcept { return text.size() == 64 && all_hex(text); }

std::string hex(ByteView bytes) {
  std::string out(bytes.size() * 2 + 1, '\0');
  sodium_bin2hex(out.data(), out.size(), raw_bytes(bytes), bytes.size());
  out.pop_back();
  return out;
}

std::optional<Bytes> hex_decoded(std::string_view text) {
  Bytes out(text.size() / 2);
  std::size_t size = 0;
  if (sodium_hex2bin(reinterpret_cast<unsigned char*>(out.data()), out.size(), text.data(),
                     text.size(), nullptr, &size, nullptr) != 0)
    return std::nullopt;
  return out;
}

std::string base64(ByteView bytes) { return base64(bytes, sodium_base64_VARIANT_ORIGINAL); }
std::string base64url(ByteView bytes) {
  return base64(bytes, sodium_base64_VARIANT_URLSAFE_NO_PADDING);
}
std::optional<Bytes> base64_decoded(std::string_view text) {
  return base64_decoded(text, sodium_base64_VARIANT_ORIGINAL);
}
std::optional<Bytes> base64url_decoded(std::string_view text) {
  return base64_decoded(text, sodium_base64_VARIANT_URLSAFE_NO_PADDING);
}

Bytes random_bytes(std::size_t length) {
  require(sodium_init() >= 0, "libsodium starts");
  Bytes out(length);
  randombytes_buf(out.data(), out.size());
  return out;
}

std::string new_id() { return fmt::format("{:012x}{}", utc_us() / 1000, hex(random_bytes(10))); }

bool is_id(std::string_view text) noexcept { return text.size() == 32 && all_hex(text); }

std::string sha256(ByteView bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.hex();
}

}  // namespace core
}  // namespace tractus
