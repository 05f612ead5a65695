#include "statistics/power/sequential_looks.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

constexpr int kPoints = 401;  // of Simpson's rule: odd
constexpr double kFar = 8.0;  // standard deviations: beyond it a normal density is nothing
constexpr double kMostBound = 8.0;

double spent_at(double t, Spending how, double alpha) {
  if (how == Spending::pocock) return alpha * std::log(1.0 + (std::numbers::e - 1.0) * t);
  return 4.0 * normal_upper(normal_quantile(1.0 - 0.25 * alpha) / std::sqrt(t));
}

/// The density of S_k where no look stopped the study, on a grid with Simpson's weights.
struct Density {
  std::vector<double> at, mass;  // mass: density times weight
};

/// P(|S| ≥ bound at the next look), `step` later in t, with a drift.
double beyond(const Density& before, double step, double bound, double drift) {
  const double sd = std::sqrt(step);
  double out = 0.0;
  for (std::size_t i = 0; i < before.at.size(); ++i) {
    const double centre = before.at[i] + drift * step;
    out +=
        before.mass[i] * (normal_upper((bound - centre) / sd) + normal_cdf((-bound - centre) / sd));
  }
  return out;
}

Density next(const Density& before, double step, double bound, double drift) {
  const double sd = std::sqrt(step);
  Density out;
  const double width = 2.0 * bound / (kPoints - 1);
  for (int i = 0; i < kPoints; ++i) {
    const double at = -bound + i * width;
    double density = 0.0;
    for (std::size_t j = 0; j < before.at.size(); ++j) {
      const double z = (at - before.at[j] - drift * step) / sd;
      if (std::abs(z) < kFar) density += before.mass[j] * std::exp(-0.5 * z * z);
    }
    const double weight = i == 0 || i == kPoints - 1 ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    out.at.push_back(at);
    out.mass.push_back(density / (sd * std::sqrt(2.0 * std::numbers::pi)) * weight * width / 3.0);
  }
  return out;
}

/// P(stopped at look k or before) for each k.
std::vector<double> stopped_by(const Looks& looks, double drift) {
  std::vector<double> out;
  Density density{{0.0}, {1.0}};
  double t = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < looks.shares.size(); ++k) {
    const double step = looks.shares[k] - t, bound = looks.bounds[k] * std::sqrt(looks.shares[k]);
    sum += beyond(density, step, bound, drift);
    out.push_back(sum);
    if (k + 1 < looks.shares.size()) density = next(density, step, bound, drift);
    t = looks.shares[k];
  }
  return out;
}

/// The x from low to high where an increasing function reaches `target`; the end next to it where it does so beyond.
template <class Function>
double root(Function f, double target, double low, double high) {
  const double at_low = f(low) - target, at_high = f(high) - target;
  if (at_low >= 0.0) return low;
  if (at_high <= 0.0) return high;
  std::uintmax_t rounds = 60;
  const auto [below, above] = boost::math::tools::toms748_solve(
      [&](double x) { return f(x) - target; }, low, high, at_low, at_high,
      boost::math::tools::eps_tolerance<double>(46), rounds);
  return 0.5 * (below + above);
}

core::Result<void> check_shares(const std::vector<double>& shares) {
  const auto wrong = [](const char* what) {
    return core::bad_input(std::string("looks: ") + what);
  };
  if (shares.empty() || shares.size() > 50) return wrong("1 to 50 looks are expected");
  double before = 0.0;
  for (const double share : shares) {
    if (!(share > before + 1e-6)) return wrong("the shares of the data should increase");
    before = share;
  }
  if (std::abs(before - 1.0) > 1e-9) return wrong("the last share of the data should be 1");
  return {};
}

}  // namespace

core::Result<Looks> sequential_looks(const std::vector<double>& shares, Spending spending,
                                     double alpha, double power) {
  TRY(check_shares(shares));
  core::require(alpha > 0.0 && alpha < 1.0 && power > alpha && power < 1.0,
                "looks have a level and a power above it");
  Looks out;
  out.shares = shares;
  Density density{{0.0}, {1.0}};
  double t = 0.0;
  for (const double share : shares) {
    const double before = out.spent.empty() ? 0.0 : out.spent.back(), step = share - t;
    out.spent.push_back(share == shares.back() ? alpha : spent_at(share, spending, alpha));
    const double scale = std::sqrt(share), spend = out.spent.back() - before;
    out.bounds.push_back(-root([&](double c) { return beyond(density, step, -c * scale, 0.0); },
                               spend, -kMostBound, 0.0));
    out.nominal_p.push_back(2.0 * normal_upper(out.bounds.back()));
    density = next(density, step, out.bounds.back() * scale, 0.0);
    t = share;
  }
  const double drift = root([&](double d) { return stopped_by(out, d).back(); }, power, 0.0, 20.0);
  const double one_look = root(
      [&](double d) {
        const double c = normal_quantile(1.0 - 0.5 * alpha);
        return normal_upper(c - d) + normal_cdf(-c - d);
      },
      power, 0.0, 20.0);
  out.inflation = drift * drift / (one_look * one_look);
  out.stopped_by = stopped_by(out, drift);
  out.mean_share = 0.0;
  for (std::size_t k = 0; k < shares.size(); ++k)
    out.mean_share +=
        (k + 1 == shares.size() ? 1.0 - (k == 0 ? 0.0 : out.stopped_by[k - 1])
                                : out.stopped_by[k] - (k == 0 ? 0.0 : out.stopped_by[k - 1])) *
        shares[k];
  return out;
}

}  // namespace statistics
}  // namespace tractus
