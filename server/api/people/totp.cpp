#include "server/api/people/totp.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <sodium.h>

#include <array>
#include <cctype>

#include "core/require.hpp"

namespace tractus {
namespace api {
namespace {

const EVP_MD* digest(TotpHash hash) {
  switch (hash) {
    case TotpHash::sha1:
      return EVP_sha1();
    case TotpHash::sha256:
      return EVP_sha256();
    case TotpHash::sha512:
      return EVP_sha512();
  }
  return EVP_sha1();
}

}  // namespace

std::string hotp(core::ByteView secret, std::uint64_t counter, int digits, TotpHash hash) {
  std::array<unsigned char, 8> message{};
  for (std::size_t i = 0; i < 8; ++i)
    message[i] = static_cast<unsigned char>(counter >> (56 - 8 * i));
  std::array<unsigned char, EVP_MAX_MD_SIZE> mac{};
  unsigned size = 0;
  const auto* made = HMAC(digest(hash), secret.data(), static_cast<int>(secret.size()),
                          message.data(), message.size(), mac.data(), &size);
  core::require(made != nullptr && size >= 20, "an HMAC can be made");
  const std::size_t offset = mac[size - 1] & 15u;
  const std::uint32_t binary = (std::uint32_t{mac[offset]} & 0x7fu) << 24 |
                               std::uint32_t{mac[offset + 1]} << 16 |
                               std::uint32_t{mac[offset + 2]} << 8 | mac[offset + 3];
  std::uint32_t modulus = 1;
  for (int i = 0; i < digits; ++i) modulus *= 10;
  return fmt::format("{:0{}}", binary % modulus, digits);
}

std::optional<std::int64_t> totp_step(core::ByteView secret, const std::string& code,
                                      std::int64_t now_utc_us, std::int64_t last_used) {
  const std::int64_t now = now_utc_us / 1'000'000 / kTotpStep_s;
  for (const std::int64_t step : {now, now - 1, now + 1}) {
    const std::string right = hotp(secret, static_cast<std::uint64_t>(step));
    if (step > last_used && code.size() == right.size() &&
        sodium_memcmp(code.data(), right.data(), right.size()) == 0)
      return step;
  }
  return std::nullopt;
}

std::string base32(core::ByteView bytes) {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZ234567";
  std::string out;
  std::uint32_t held = 0;
  int bits = 0;
  for (const std::byte byte : bytes) {
    held = held << 8 | std::to_integer<std::uint32_t>(byte);
    for (bits += 8; bits >= 5; bits -= 5) out += kAlphabet[held >> (bits - 5) & 31u];
  }
  if (bits > 0) out += kAlphabet[held << (5 - bits) & 31u];
  return out;
}

std::string totp_uri(core::ByteView secret, const std::string& account) {
  std::string label;
  for (const char c : account) {
    const auto byte = static_cast<unsigned char>(c);
    label += std::isalnum(byte) ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return fmt::format("otpauth://totp/Tractus:{}?secret={}&issuer=Tractus&digits=6&period={}", label,
                     base32(secret), kTotpStep_s);
}

}  // namespace api
}  // namespace tractus
