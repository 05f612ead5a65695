/// Resistance of a scenario against depth, as a figure.
#pragma once

#include <span>

#include "core/result.hpp"
#include "plot/figure.hpp"
#include "scenarios/scenario.hpp"

namespace tractus::commands {

/// A curve per speed (m/s); layers, resistance intervals and breaches shaded, walls named. Errors:
/// those of `Scenario::expanded`.
core::Result<plot::Figure> scenario_picture(const scenarios::Scenario& scenario,
                                            std::span<const double> speeds_m_s);

}  // namespace tractus::commands
