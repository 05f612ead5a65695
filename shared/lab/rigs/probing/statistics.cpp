#include "lab/rigs/probing/statistics.hpp"

#include <algorithm>
#include <cmath>

#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kStatistics = kSettings.probing_statistics;

/// Speeds of the moving samples.
std::vector<double> speeds(std::span<const ProbingRecording> trials) {
  std::vector<double> out;
  for (const auto& r : trials)
    for (std::size_t k = 0; k < r.size(); k += kStatistics.every_samples)
      if (const double v = std::abs(r.motion.v_m_s[k]); v > r.motion.rest_m_s) out.push_back(v);
  return out;
}

/// The speed that a share of them stays under.
double speed(std::vector<double>& all, double share) {
  if (all.empty()) return kStatistics.never_moved_m_s;
  const auto at = all.begin() + std::ptrdiff_t(share * double(all.size() - 1));
  std::ranges::nth_element(all, at);
  return *at;
}

double depth_range(std::span<const ProbingRecording> trials) {
  double least = 1e9, most = -1e9;
  for (const auto& r : trials) {
    const auto [a, b] = std::ranges::minmax(r.motion.x_m);
    least = std::min(least, a);
    most = std::max(most, b);
  }
  return most - least;
}

}  // namespace

effects::ProbingStatistics statistics_of(std::span<const ProbingRecording> trials,
                                         const Eigen::VectorXd& residual) {
  effects::ProbingStatistics out;
  std::vector<double> moving = speeds(trials);
  out.slow_m_s = speed(moving, kStatistics.slow_quantile);
  out.fast_m_s = speed(moving, kStatistics.fast_quantile);
  out.depth_range_m = depth_range(trials);
  for (const auto& r : trials) {
    out.longest_s = std::max(out.longest_s, r.seconds());
    for (std::size_t j = 0; j < r.measured_thin.size(); ++j) {
      out.depth_m.push_back(r.motion.x_m[r.decimator.middle(j)]);
      out.residual_sd_N.push_back(r.sd_thin[j]);
    }
  }
  out.residual.assign(residual.begin(), residual.end());
  return out;
}

}  // namespace lab
}  // namespace tractus
