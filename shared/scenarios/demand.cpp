#include "scenarios/demand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace scenarios {
namespace {

constexpr double kBeside_m = 1e-9;  // "just before" and "just behind" a border
constexpr double kStep_m = 1e-4;

Push push_at(const laws::ProbingLaw& law, const std::vector<double>& depths, double speed_m_s) {
  Push push{.speed_m_s = speed_m_s};
  double sum_Nm = 0.0, length_m = 0.0;
  for (std::size_t k = 0; k + 1 < depths.size(); ++k) {
    const double from_m = depths[k], to_m = depths[k + 1], middle_m = 0.5 * (from_m + to_m);
    if (law.mode_at(middle_m) != laws::ProbingMode::bone) continue;
    const double at_from_N = law.force_N(from_m, speed_m_s), at_to_N = law.force_N(to_m, speed_m_s);
    push.peak_N = std::max({push.peak_N, at_from_N, at_to_N});
    if (to_m - from_m <= 2.0 * kBeside_m) continue;  // a border's two sides
    sum_Nm += law.force_N(middle_m, speed_m_s) * (to_m - from_m);
    length_m += to_m - from_m;
  }
  push.mean_N = length_m > 0.0 ? sum_Nm / length_m : 0.0;
  return push;
}

WallDemand wall_at(const laws::ProbingLaw& law, const laws::CorticalWall& wall) {
  WallDemand out{.position_m = wall.position_m};
  out.threshold_N = law.force_N(wall.position_m - kBeside_m, kSlow_m_s);
  out.behind_N = law.force_N(wall.position_m + kBeside_m, kSlow_m_s);
  out.speed_m_s = out.threshold_N / wall.breach_damping_Ns_per_m;
  out.thrust_N = thrust_N(out.speed_m_s);
  return out;
}

}  // namespace

double thrust_N(double speed_m_s) noexcept {
  constexpr double kRest_N = 667.0, kMiddle_N = 180.0, kMiddle_m_s = 0.15;
  const double speed = std::abs(speed_m_s);
  if (speed <= kMiddle_m_s) return std::lerp(kRest_N, kMiddle_N, speed / kMiddle_m_s);
  return std::max(0.0, kMiddle_N * (kTopSpeed_m_s - speed) / (kTopSpeed_m_s - kMiddle_m_s));
}

std::vector<double> depths_m(const laws::ProbingParameters& p) {
  std::vector<double> out;
  const auto beside = [&](double border_m) {
    out.push_back(std::max(0.0, border_m - kBeside_m));
    out.push_back(std::min(p.travel_m - kBeside_m, border_m + kBeside_m));
  };
  for (const laws::Layer& layer : p.layers) {
    beside(layer.start_m);
    beside(layer.start_m + layer.thickness_m);
  }
  for (const laws::CorticalWall& wall : p.walls) {
    beside(wall.position_m - wall.resistance_interval_m);
    beside(wall.position_m);
    beside(wall.position_m + wall.breach_interval_m);
  }
  const int steps = int(p.travel_m / kStep_m);
  for (int k = 0; k < steps; ++k) out.push_back(k * kStep_m);
  std::ranges::sort(out);
  return out;
}

core::Result<Demand> demand(const Scenario& scenario) {
  auto parameters = TRY(scenario.expanded());
  auto law = TRY(laws::ProbingLaw::make(parameters));
  Demand out;
  const auto depths = depths_m(parameters);
  for (const double speed_m_s : {kSlow_m_s, kFast_m_s})
    out.pushes.push_back(push_at(law, depths, speed_m_s));
  if (const Push& slow = out.pushes.front(); slow.peak_N > kSurgeon_N)
    out.excessive.push_back(fmt::format(
        "the bone takes up to {:.0f} N at {:.0f} mm/s; surgeons push with about {:.0f} N",
        slow.peak_N, 1e3 * slow.speed_m_s, kSurgeon_N));
  for (const laws::CorticalWall& wall : parameters.walls) {
    const WallDemand at = wall_at(law, wall);
    if (at.threshold_N > kSurgeon_N)
      out.excessive.push_back(fmt::format(
          "the wall at {:.4g} m breaks only at {:.0f} N; surgeons push with about {:.0f} N",
          at.position_m, at.threshold_N, kSurgeon_N));
    if (at.speed_m_s > kTopSpeed_m_s || at.thrust_N < at.threshold_N)
      out.excessive.push_back(fmt::format(
          "behind the wall at {:.4g} m the stage would move at {:.3f} m/s under {:.0f} N; the "
          "actuator has {:.0f} N there",
          at.position_m, at.speed_m_s, at.threshold_N, at.thrust_N));
    out.walls.push_back(at);
  }
  return out;
}

core::Result<Resistance> resistance(const Scenario& scenario, std::span<const double> speeds_m_s) {
  auto parameters = TRY(scenario.expanded());
  auto law = TRY(laws::ProbingLaw::make(parameters));
  Resistance out{depths_m(parameters), {speeds_m_s.begin(), speeds_m_s.end()}, {}, parameters};
  for (const double speed_m_s : speeds_m_s) {
    std::vector<double>& line = out.force_N.emplace_back();
    for (const double x_m : out.depth_m) line.push_back(law.force_N(x_m, speed_m_s));
  }
  return out;
}

}  // namespace scenarios
}  // namespace tractus
