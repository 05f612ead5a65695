#include "server/api/people/throttle.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "core/try.hpp"
#include "server/api/backend.hpp"

namespace tractus {
namespace api {
namespace {

using core::Result;
using store::Attempt;
using store::Failures;
using store::Secret;
using store::Total;

constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::size_t kMaxOrigin = 64;

/// So many failures at once, then one in `refill_us`.
struct Budget {
  double failures;
  std::int64_t refill_us;
};

/// Without a name's or an origin's budget, that sum is not kept.
struct Budgets {
  Budget pair;
  std::optional<Budget> name = {}, origin = {};

  const std::optional<Budget> of(Total total) const {
    return total == Total::pair ? std::optional(pair) : total == Total::name ? name : origin;
  }
};

constexpr std::array kTotals{Total::pair, Total::name, Total::origin};
/// After this every sum is 0 again: longer than failures * refill_us of any budget below.
constexpr std::int64_t kForgotten_us = 20 * 60 * kSecond_us;

Budgets budgets_of(Secret secret) {
  switch (secret) {
    case Secret::account_password:
      return {.pair = {10, 90 * kSecond_us},
              .name = Budget{100, 9 * kSecond_us},
              .origin = Budget{50, 20 * kSecond_us}};
    case Secret::badge_pin:  // four digits
      return {.pair = {5, 180 * kSecond_us},
              .name = Budget{20, 45 * kSecond_us},
              .origin = Budget{30, 20 * kSecond_us}};
    case Secret::enrolment_code:
    case Secret::own_password:
      return {.pair = {10, 90 * kSecond_us}};
    case Secret::api_token:  // without names: the pair is the origin
      return {.pair = {50, 20 * kSecond_us}};
  }
  return {.pair = {1, kForgotten_us}};
}

double count_at(const Failures& failures, const Budget& budget, std::int64_t now_utc_us) {
  const double past = double(std::max<std::int64_t>(0, now_utc_us - failures.at_utc_us));
  return std::max(0.0, failures.count - past / double(budget.refill_us));
}

/// Until the budget has room for one more failure, us; 0: it has.
std::int64_t wait_us(const Failures& failures, const Budget& budget, std::int64_t now_utc_us) {
  const double over = count_at(failures, budget, now_utc_us) + 1.0 - budget.failures;
  return over <= 1e-9 ? 0 : static_cast<std::int64_t>(over * double(budget.refill_us));
}

Result<std::int64_t> wait_for(store::Reading& tx, const Attempt& attempt, Total total,
                              std::int64_t now_utc_us) {
  const auto budget = budgets_of(attempt.secret).of(total);
  if (!budget) return std::int64_t{0};
  auto failures = TRY(store::failures_of(tx, attempt, total));
  return wait_us(failures, *budget, now_utc_us);
}

/// How long a name whose budget is spent keeps this origin waiting after its last failure, us.
Result<std::int64_t> slowed_wait(store::Reading& tx, const Attempt& attempt,
                                 std::int64_t now_utc_us) {
  auto spent = wait_for(tx, attempt, Total::name, now_utc_us);
  if (!spent || *spent == 0) return spent;
  auto last = TRY(store::failures_of(tx, attempt, Total::pair));
  const std::int64_t next = last.at_utc_us + budgets_of(attempt.secret).pair.refill_us;
  return last.at_utc_us == 0 ? 0 : std::max<std::int64_t>(0, next - now_utc_us);
}

Result<std::int64_t> wait_of(store::Reading& tx, const Attempt& attempt, std::int64_t now_utc_us) {
  auto pair = wait_for(tx, attempt, Total::pair, now_utc_us);
  if (!pair) return pair;
  auto known = TRY(store::is_known_origin(tx, attempt));
  if (known) return pair;
  auto name = TRY(slowed_wait(tx, attempt, now_utc_us));
  auto origin = TRY(wait_for(tx, attempt, Total::origin, now_utc_us));
  return std::max({*pair, name, origin});
}

std::optional<http::Response> answer_of(std::int64_t wait_us) {
  if (wait_us <= 0) return std::nullopt;
  const std::int64_t wait_s = (wait_us + kSecond_us - 1) / kSecond_us;
  auto response = http::error_response(
      429, "too_many", fmt::format("too many failed attempts: try again in {} s", wait_s));
  return response.with("Retry-After", std::to_string(wait_s)), response;
}

Result<void> add_failure(store::Writing& tx, const Attempt& attempt, Total total,
                         std::int64_t now_utc_us) {
  const auto budget = budgets_of(attempt.secret).of(total);
  if (!budget) return {};
  auto before = TRY(store::failures_of(tx, attempt, total));
  const double count = count_at(before, *budget, now_utc_us) + 1.0;
  return store::set_failures(tx, attempt, total, {std::min(count, budget->failures), now_utc_us});
}

}  // namespace

std::string network_of(const std::string& address) {
  in6_addr six{};
  if (::inet_pton(AF_INET6, address.c_str(), &six) != 1) return address.substr(0, kMaxOrigin);
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (IN6_IS_ADDR_V4MAPPED(&six)) {
    ::inet_ntop(AF_INET, &six.s6_addr[12], text.data(), text.size());
    return text.data();
  }
  std::memset(&six.s6_addr[8], 0, 8);
  ::inet_ntop(AF_INET6, &six, text.data(), text.size());
  return std::string(text.data()) + "/64";
}

Result<std::optional<http::Response>> too_early(Backend& backend, const Attempt& attempt) {
  auto wait = TRY(backend.store.read(
      [&](store::Reading& tx) { return wait_of(tx, attempt, backend.now_utc_us()); }));
  return answer_of(wait);
}

Result<std::optional<http::Response>> too_early_from(Backend& backend, Secret secret,
                                                     const std::string& origin) {
  auto wait = TRY(backend.store.read([&](store::Reading& tx) {
    return wait_for(tx, {secret, "", origin}, Total::origin, backend.now_utc_us());
  }));
  return answer_of(wait);
}

Result<void> note_failure(Backend& backend, const Attempt& attempt) {
  const std::int64_t now = backend.now_utc_us();
  return backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(store::remove_old_failures(tx, now - kForgotten_us));
    auto known = TRY(store::is_known_origin(tx, attempt));
    for (const Total total : kTotals)
      if (total == Total::pair || !known) TRY(add_failure(tx, attempt, total, now));
    return {};
  });
}

Result<void> note_success(store::Writing& tx, const std::string& account_id, const Attempt& attempt,
                          std::int64_t now_utc_us) {
  TRY(store::clear_failures(tx, attempt));
  return store::note_origin(tx, account_id, attempt, now_utc_us, now_utc_us - kOriginKept_us);
}

Result<void> start_afresh(store::Writing& tx, const std::string& account_id, Secret secret,
                          const std::string& name) {
  TRY(store::clear_failures_of_name(tx, secret, name));
  return store::forget_origins(tx, account_id, secret);
}

}  // namespace api
}  // namespace tractus
