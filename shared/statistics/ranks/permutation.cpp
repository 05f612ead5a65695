#include "statistics/ranks/permutation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/try.hpp"

namespace tractus {
namespace statistics {
namespace {

/// n! / Π (multiplicity)!
double arrangements_of(std::vector<double> sorted) {
  double out = 1.0;
  std::size_t run = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    run = i > 0 && sorted[i] == sorted[i - 1] ? run + 1 : 1;
    out *= static_cast<double>(i + 1) / static_cast<double>(run);
  }
  return std::round(out);
}

}  // namespace

core::Result<PermutationSlope> permutation_slope(const Vector& x, const Vector& y, double most) {
  core::require(x.size() == y.size(), "a slope is of pairs");
  if (x.size() < 2 || !x.allFinite() || !y.allFinite())
    return core::bad_input("a slope needs two pairs of finite numbers");
  TRY(check_range(x, "x"));
  TRY(check_range(y, "the response"));
  if (x.maxCoeff() == x.minCoeff() || y.maxCoeff() == y.minCoeff())
    return core::bad_input("x or y is the same everywhere: there is no slope to test");
  std::vector<double> order(y.begin(), y.end());
  std::ranges::sort(order);
  if (const double count = arrangements_of(order); count > most)
    return core::Error{core::Errc::too_large,
                       fmt::format("{:.3g} arrangements are too many to count", count)};
  const Vector centred = x.array() - x.mean();
  const double observed = centred.dot(y);
  const double margin = 1e-12 * centred.cwiseAbs().dot(y.cwiseAbs());
  PermutationSlope out;
  do {
    const double here = centred.dot(Eigen::Map<const Vector>(order.data(), x.size()));
    ++out.arrangements;
    out.as_high += here >= observed - margin;
    out.as_low += here <= observed + margin;
    out.as_extreme += std::abs(here) >= std::abs(observed) - margin;
  } while (std::next_permutation(order.begin(), order.end()));
  const double total = static_cast<double>(out.arrangements);
  out.p = static_cast<double>(out.as_extreme) / total;
  out.p_greater = static_cast<double>(out.as_high) / total;
  out.p_less = static_cast<double>(out.as_low) / total;
  return out;
}

core::Result<SignFlip> sign_flip(const Vector& differences) {
  if (differences.size() < 1 || !differences.allFinite())
    return core::bad_input("a sign-flip test needs finite differences");
  TRY(check_range(differences, "the difference"));
  if (differences.size() > 28)
    return core::Error{core::Errc::too_large,
                       "over 28 differences: 2ⁿ signs are too many to count"};
  const double observed = std::abs(differences.sum());
  const double margin = 1e-12 * differences.cwiseAbs().sum();
  SignFlip out;
  out.flips = 1ull << differences.size();
  // Gray code: one sign turns at a time.
  Vector signs = Vector::Ones(differences.size());
  double sum = differences.sum();
  for (std::uint64_t i = 1;; ++i) {
    out.as_extreme += std::abs(sum) >= observed - margin;
    if (i == out.flips) break;
    const auto turned = static_cast<Eigen::Index>(__builtin_ctzll(i));
    signs[turned] = -signs[turned];
    sum += 2.0 * signs[turned] * differences[turned];
  }
  out.p = static_cast<double>(out.as_extreme) / static_cast<double>(out.flips);
  return out;
}

}  // namespace statistics
}  // namespace tractus
