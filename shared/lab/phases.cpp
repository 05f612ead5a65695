#include "lab/phases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lab {
namespace {

constexpr double kNearReversal_s = 0.1, kSlowShare = 1.0 / 30.0, kLeastSpeed_m_s = 2e-5;
enum Phase { hold, advance, retract, reversal, crossing_layer };
enum Way { in, out, still };

double brisk(std::span<const double> v_m_s) {
  std::vector<double> speeds;
  for (const double v : v_m_s) speeds.push_back(std::abs(v));
  const auto at = speeds.begin() + std::ptrdiff_t(0.95 * double(speeds.size() - 1));
  std::ranges::nth_element(speeds, at);
  return *at;
}

}  // namespace

Courses courses(std::span<const double> t_s, std::span<const double> v_m_s,
                std::span<const double> crossing) {
  const std::size_t n = t_s.size();
  Courses out{std::vector<float>(n), std::vector<float>(n), std::vector<float>(n)};
  if (n == 0) return out;
  const double slow = std::max(kSlowShare * brisk(v_m_s), kLeastSpeed_m_s);
  std::vector<double> reversals_s;
  int last = 0;
  double since = t_s[0];
  for (std::size_t k = 0; k < n; ++k) {
    const int way = v_m_s[k] > slow ? 1 : v_m_s[k] < -slow ? -1 : 0;
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
    if (std::abs(reversals_s[next] - t_s[k]) <= kNearReversal_s) out.phase[k] = Phase::reversal;
  }
  for (std::size_t k = 0; k < crossing.size(); ++k)
    if (crossing[k] > 0.5) out.phase[k] = Phase::crossing_layer;
  return out;
}

}  // namespace lab
