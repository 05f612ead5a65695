/// Time-based one-time codes: RFC 6238 (HMAC-SHA-1, 30 s, 6 digits), which every authenticator
/// supports. By liboath; that a code is accepted only once is ours.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/bytes.hpp"

namespace tractus::api {

inline constexpr std::int64_t kTotpStep_s = 30;

/// RFC 4226 section 5.3: the last six decimal digits of the truncated HMAC of the counter.
std::string hotp(core::ByteView secret, std::uint64_t counter);

/// The time step of `code`: the current, the previous or the next step, but later than `last_used`
/// (RFC 6238 section 5.2: a code is accepted only once).
std::optional<std::int64_t> totp_step(core::ByteView secret, const std::string& code,
                                      std::int64_t now_utc_us, std::int64_t last_used);

/// Base32 of RFC 4648 section 6, without padding, which a person can type.
std::string base32(core::ByteView bytes);
/// The address "otpauth://totp/…" for an authenticator, shown as a QR code.
std::string totp_uri(core::ByteView secret, const std::string& account);

}  // namespace tractus::api
