/// One-time codes by time: RFC 6238 (HMAC-SHA-1, 30 s, 6 digits), as every authenticator knows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/bytes.hpp"

namespace tractus::api {

enum class TotpHash { sha1, sha256, sha512 };
inline constexpr std::int64_t kTotpStep_s = 30;

/// RFC 4226 section 5.3: the last `digits` decimal digits of the truncated HMAC of the counter.
std::string hotp(core::ByteView secret, std::uint64_t counter, int digits = 6,
                 TotpHash hash = TotpHash::sha1);

/// The step that `code` is of: this one, the one before or the one after, but none up to
/// `last_used` (RFC 6238 section 5.2: a code is taken once).
std::optional<std::int64_t> totp_step(core::ByteView secret, const std::string& code,
                                      std::int64_t now_utc_us, std::int64_t last_used);

/// RFC 4648 section 6, without padding: what a person types.
std::string base32(core::ByteView bytes);
/// "otpauth://totp/…": what an authenticator scans.
std::string totp_uri(core::ByteView secret, const std::string& account);

}  // namespace tractus::api
