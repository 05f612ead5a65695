/// Slows down who guesses passwords, PINs and codes, without shutting anybody out.
///
/// Failures are added up for each pair of name and origin, for each name, and for each origin
/// (store::Total). Each sum shrinks steadily with time:
///
///     sum(t) = max(0, sum(t0) - (t - t0) / refill)
///
/// An attempt is taken while sum + 1 does not exceed the budget. Once the budget of a name is
/// spent, an origin may try that name once in the refill time of its pair: the first attempt from a
/// new origin is always taken. An origin from which the account got in before is held to the budget
/// of its pair alone, so that failures of strangers elsewhere do not concern it.
#pragma once

#include "db/store/people/sign_ins.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

inline constexpr std::int64_t kOriginKept_us = 90ll * 24 * 3600 * 1'000'000;

/// The network that an address counts as: an IPv4 address itself, the first 64 bits of an IPv6
/// address (what one household is given), as text.
std::string network_of(const std::string& address);

/// An answer 429 with Retry-After (s) while it is too early for this attempt; nothing when it may
/// be made. Errors: those of the database.
core::Result<std::optional<http::Response>> too_early(Backend& backend,
                                                      const store::Attempt& attempt);
/// The same of an origin alone, before the name is known.
core::Result<std::optional<http::Response>> too_early_from(Backend& backend, store::Secret secret,
                                                           const std::string& origin);
/// Adds a failure to the sums, in a transaction of its own.
core::Result<void> note_failure(Backend& backend, const store::Attempt& attempt);
/// Clears the pair's failures and notes the origin as known to the account.
core::Result<void> note_success(store::Writing& tx, const std::string& account_id,
                                const store::Attempt& attempt, std::int64_t now_utc_us);
/// Clears what was counted against a name, from everywhere; its known origins are known no more.
core::Result<void> start_afresh(store::Writing& tx, const std::string& account_id,
                                store::Secret secret, const std::string& name);

}  // namespace tractus::api
