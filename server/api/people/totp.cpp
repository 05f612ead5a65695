#include "server/api/people/totp.hpp"

#include <fmt/format.h>
#include <liboath/oath.h>
#include <sodium.h>

#include <array>
#include <cstdlib>
#include <memory>

#include "core/require.hpp"
#include "server/api/web_fetch.hpp"

namespace tractus {
namespace api {
namespace {
constexpr unsigned kDigits = 6;

struct FreesCode {
  void operator()(char* text) const { std::free(text); }
};
}  // namespace

std::string hotp(core::ByteView secret, std::uint64_t counter) {
  std::array<char, kDigits + 1> code{};
  const int made =
      oath_hotp_generate(core::text_of(secret).data(), secret.size(), counter, kDigits,
                         /*add_checksum=*/false, OATH_HOTP_DYNAMIC_TRUNCATION, code.data());
  core::require(made == OATH_OK, "liboath makes a code");
  return code.data();
}

/// Not by oath_totp_validate: it compares with strcmp, and does not know the last code used.
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
  char* text = nullptr;
  std::size_t size = 0;
  const int made = oath_base32_encode(core::text_of(bytes).data(), bytes.size(), &text, &size);
  const std::unique_ptr<char, FreesCode> held(text);
  core::require(made == OATH_OK, "memory for a secret's text");
  const std::string padded(text, size);
  return padded.substr(0, padded.find('='));
}

std::string totp_uri(core::ByteView secret, const std::string& account) {
  return fmt::format("otpauth://totp/Tractus:{}?secret={}&issuer=Tractus&digits={}&period={}",
                     percent_encoded(account), base32(secret), kDigits, kTotpStep_s);
}

}  // namespace api
}  // namespace tractus
