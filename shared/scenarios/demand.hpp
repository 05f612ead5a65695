/// What a scenario asks of the surgeon and of the actuator.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "scenarios/scenario.hpp"

namespace tractus::scenarios {

inline constexpr double kSurgeon_N = 150.0;  ///< "typical force" of a surgeon [Probing, section 3]
inline constexpr double kTopSpeed_m_s = 0.23;  ///< of the actuator [Probing, section 3]
inline constexpr double kSlow_m_s = 0.005;     ///< speeds of cannulation that a scenario is
inline constexpr double kFast_m_s = 0.010;     ///< judged at; our choice

/// Thrust that the actuator has at a speed: 667 N at rest, 180 N at 0.15 m/s [Probing, section 3],
/// straight between them; from there, our assumption, straight to none at 0.23 m/s.
double thrust_N(double speed_m_s) noexcept;

/// Push at one speed, over the bone outside of resistance intervals and breaches.
struct Push {
  double speed_m_s = 0.0, mean_N = 0.0, peak_N = 0.0;
};
/// A wall at `kSlow_m_s`.
struct WallDemand {
  double position_m = 0.0;
  double threshold_N = 0.0;  ///< largest push before it gives way
  double behind_N = 0.0;     ///< push just behind it
  double speed_m_s = 0.0;    ///< behind it, the threshold's push still there: eq. (3)
  double thrust_N = 0.0;     ///< that the actuator has at that speed
};
struct Demand {
  std::vector<Push> pushes;  ///< at kSlow_m_s and kFast_m_s
  std::vector<WallDemand> walls;
  /// A sentence for each thing that a surgeon or the actuator cannot do; none: it can be played.
  std::vector<std::string> excessive;
};

/// Errors: those of `Scenario::expanded`.
core::Result<Demand> demand(const Scenario& scenario);

/// Depths of a curve of force against depth, ends of layers and walls from both sides included.
std::vector<double> depths_m(const laws::ProbingParameters& parameters);

/// The push that the law asks for at steady speeds, over depth: what a plot of a scenario shows.
struct Resistance {
  std::vector<double> depth_m;
  std::vector<double> speeds_m_s;
  std::vector<std::vector<double>> force_N;  ///< [speed][depth]
  laws::ProbingParameters parameters;        ///< layers and walls that it is of
};

/// Errors: those of `Scenario::expanded` and of the law.
core::Result<Resistance> resistance(const Scenario& scenario, std::span<const double> speeds_m_s);

}  // namespace tractus::scenarios
