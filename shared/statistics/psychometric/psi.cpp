#include "statistics/psychometric/psi.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

constexpr std::size_t kLevels = 31, kThresholds = 81, kSlopes = 11;
constexpr double kLeastSlope = 0.5, kGreatestSlope = 4.0;

std::vector<double> spaced(double least, double greatest, std::size_t count) {
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i)
    out[i] = least * std::pow(greatest / least, double(i) / double(count - 1));
  return out;
}

double times_log(double p) { return p > 0.0 ? p * std::log(p) : 0.0; }

/// Where `weights` (their sum 1) have reached `share`, between the values.
double quantile_of(const std::vector<double>& values, const std::vector<double>& weights,
                   double share) {
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (sum + weights[i] >= share) {
      const double step = i + 1 < values.size() ? std::log(values[i + 1] / values[i])
                                                : std::log(values[i] / values[i - 1]);
      const double within = weights[i] > 0.0 ? (share - sum) / weights[i] - 0.5 : 0.0;
      return std::clamp(values[i] * std::exp(within * step), values.front(), values.back());
    }
    sum += weights[i];
  }
  return values.back();
}

}  // namespace

double share_right(double level, double threshold, double slope) {
  static const double z = normal_quantile(0.75);
  return Psi::kLapse / 2 + (1.0 - Psi::kLapse) * normal_cdf(z * std::pow(level / threshold, slope));
}

Psi::Psi(double least, double greatest)
    : levels_(spaced(least, greatest, kLevels)),
      thresholds_(spaced(least, greatest, kThresholds)),
      slopes_(spaced(kLeastSlope, kGreatestSlope, kSlopes)),
      posterior_(kThresholds * kSlopes, 1.0 / double(kThresholds * kSlopes)) {
  core::require(least > 0.0 && least < greatest, "levels rise from above nothing");
  for (const double level : levels_)
    for (const double threshold : thresholds_)
      for (const double slope : slopes_) {
        const double p = share_right(level, threshold, slope);
        right_.push_back(p);
        information_.push_back(times_log(p) + times_log(1.0 - p));
      }
}

// Steps 1 to 5: p(right), both posteriors and their entropies. The expected entropy is
// −Σ_r p(r) Σ (joint/p(r)) ln(joint/p(r)) with joint = posterior · p(r | α, β). Written out, what does
// not depend on the level (Σ posterior ln posterior) drops out of the comparison.
double Psi::level() const {
  double best = 1e300, at = levels_.back();
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const double* right = &right_[l * posterior_.size()];
    const double* information = &information_[l * posterior_.size()];
    double p_right = 0.0, known = 0.0;
    for (std::size_t i = 0; i < posterior_.size(); ++i) {
      p_right += posterior_[i] * right[i];
      known += posterior_[i] * information[i];
    }
    const double entropy = times_log(p_right) + times_log(1.0 - p_right) - known;
    if (entropy < best) best = entropy, at = levels_[l];
  }
  return at;
}

void Psi::answered(double level, bool right) {
  double sum = 0.0;
  for (std::size_t t = 0, i = 0; t < thresholds_.size(); ++t)
    for (std::size_t s = 0; s < slopes_.size(); ++s, ++i) {
      const double p = share_right(level, thresholds_[t], slopes_[s]);
      sum += posterior_[i] *= right ? p : 1.0 - p;
    }
  for (double& p : posterior_) p /= sum;
  ++answers_;
}

Threshold Psi::threshold() const {
  std::vector<double> over_thresholds(thresholds_.size()), over_slopes(slopes_.size());
  for (std::size_t i = 0; i < posterior_.size(); ++i) {
    over_thresholds[i / slopes_.size()] += posterior_[i];
    over_slopes[i % slopes_.size()] += posterior_[i];
  }
  return {.median = quantile_of(thresholds_, over_thresholds, 0.5),
          .interval_95 = {quantile_of(thresholds_, over_thresholds, 0.025),
                          quantile_of(thresholds_, over_thresholds, 0.975)},
          .slope = quantile_of(slopes_, over_slopes, 0.5)};
}

}  // namespace statistics
}  // namespace tractus
