/// Slows down attackers who guess passwords, PINs and codes, without locking accounts.
///
/// Failures are added up for each pair of name and origin, for each name, and for each origin
/// (store::Total). Each sum shrinks steadily with time:
///
///     sum(t) = max(0, sum(t0) - (t - t0) / refill)
///
/// An attempt is allowed while sum + 1 does not exceed the budget. Once the budget of a name is
/// used up, an origin may try this name once in the refill time of its pair: the first attempt from
/// a new origin is always allowed. For an origin from which the account signed in before, only the
/// budget of its pair counts, so that failures from other origins do not affect it.
#pragma once

#include "db/store/people/sign_ins.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

inline constexpr std::int64_t kOriginKept_us = 90ll * 24 * 3600 * 1'000'000;

/// The network of an address for the throttle, as text: the IPv4 address itself, or the first 64
/// bits of an IPv6 address (the size of a household's network).
std::string network_of(const std::string& address);

/// An answer 429 with Retry-After (s) if it is too early for this attempt; nothing if the attempt
/// is allowed. Errors: those of the database.
core::Result<std::optional<http::Response>> too_early(Backend& backend,
                                                      const store::Attempt& attempt);
/// The same for an origin alone, before the name is known.
core::Result<std::optional<http::Response>> too_early_from(Backend& backend, store::Secret secret,
                                                           const std::string& origin);
/// Adds a failure to the sums, in a separate transaction.
core::Result<void> note_failure(Backend& backend, const store::Attempt& attempt);
/// Clears the failures of the pair and records the origin as known for the account.
core::Result<void> note_success(store::Writing& tx, const std::string& account_id,
                                const store::Attempt& attempt, std::int64_t now_utc_us);
/// Clears the failures of a name from all origins, and forgets its known origins.
core::Result<void> start_afresh(store::Writing& tx, const std::string& account_id,
                                store::Secret secret, const std::string& name);

}  // namespace tractus::api
