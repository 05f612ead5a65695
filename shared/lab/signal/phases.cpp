#include "lab/signal/phases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kPhases = kSettings.phases;
enum Phase { hold, advance, retract, reversal, crossing_layer };
enum Way { in, out, still };

double brisk(std::span<const double> velocity) {
  std::vector<double> speeds;
  for (const double v : velocity) speeds.push_back(std::abs(v));
  const auto at = speeds.begin() + std::ptrdiff_t(0.95 * double(speeds.size() - 1));
  std::ranges::nth_element(speeds, at);
  return *at;
}

}  // namespace

Courses courses(std::span<const double> t_s, std::span<const double> velocity,
                std::span<const double> crossing) {
  const std::size_t n = t_s.size();
  Courses out{std::vector<float>(n), std::vector<float>(n), std::vector<float>(n)};
  if (n == 0) return out;
  const double slow = std::max(kPhases.slow_share * brisk(velocity), kPhases.least_speed);
  std::vector<double> reversals_s;
  int last = 0;
  double since = t_s[0];
  for (std::size_t k = 0; k < n; ++k) {
    const int way = velocity[k] > slow ? 1 : velocity[k] < -slow ? -1 : 0;
    if (way != 0 && last != 0 && way != last) reversals_s.push_back(since = t_s[k]);
    if (way != 0) last = way;
    out.direction[k] = way > 0 ? Way::in : way < 0 ? Way::out : Way::still;
    out.phase[k] = way > 0 ? Phase::advance : way < 0 ? Phase::retract : Phase::hold;
    out.since_reversal_s[k] = float(t_s[k] - since);
  }
  std::size_t next = 0;
  for (std::size_t k = 0; k < n && !reversals_s.empty(); ++k) {
    while (next + 1 < reversals_s.size() &&
           std::abs(reversals_s[next + 1] - t_s[k]) <= std::abs(reversals_s[next] - t_s[k]))
      ++next;
    if (std::abs(reversals_s[next] - t_s[k]) <= kPhases.near_reversal_s)
      out.phase[k] = Phase::reversal;
  }
  for (std::size_t k = 0; k < crossing.size(); ++k)
    if (crossing[k] > 0.5) out.phase[k] = Phase::crossing_layer;
  return out;
}

std::vector<float> palpation_phases(std::span<const double> force_N,
                                    std::span<const double> speed_m_s,
                                    std::span<const double> along_m_s, double noise_N) {
  enum { free, contact, sliding, pressing };
  std::vector<float> out(force_N.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    const bool touching = force_N[k] >= std::max(kPhases.least_force_N, 4.0 * noise_N);
    const bool still = speed_m_s[k] < kPhases.still_m_s;
    const bool along = std::abs(along_m_s[k]) > std::sqrt(0.5) * speed_m_s[k];
    out[k] = float(!touching ? free : still ? contact : along ? pressing : sliding);
  }
  return out;
}

}  // namespace lab
}  // namespace tractus
