/// Length of a way that was sampled with noise.
#pragma once

#include <optional>
#include <span>

#include "math/geometry.hpp"

namespace tractus::metrics {

/// ∫ |v| dt by the trapezoid rule over v from a Savitzky–Golay fit (21 samples, order 3) of each
/// coordinate, polynomials evaluated up to the ends. Adding up raw steps would count the noise.
/// @param points_m  positions `dt_s` apart, m. Nothing for fewer than 21.
std::optional<double> smoothed_length_m(std::span<const math::Vec3> points_m, double dt_s);

}  // namespace tractus::metrics
