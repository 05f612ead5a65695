#pragma once
/// How much of a hidden effect the base cannot imitate: linear algebra at the true parameters.
#include <vector>

#include "probing/draw.hpp"

namespace blind {

/// One instant of a set: where, how fast, and the force that each hidden effect adds (last: all
/// together).
struct JudgedPoint {
  double x_m, v_m_s;
  std::vector<double> added_N;
};

/// RMS of each added force after projection on the base parameters that the supplied model leaves
/// free. One per effect, and last for all together.
std::vector<double> projected_rms(const std::vector<JudgedPoint>& points, const SetPlan& plan);

}  // namespace blind
