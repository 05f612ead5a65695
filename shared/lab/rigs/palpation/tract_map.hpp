/// The error of a palpation on the wall of its tract: depth against the side that was touched.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/compare/samples.hpp"

namespace tractus::lab {

/// The wall unrolled. Cells that nothing touched are NaN.
struct TractMap {
  std::vector<double> depth_m;    ///< edges, rising from the mouth inwards
  std::vector<double> angle_rad;  ///< edges, 0 to 2π about the tract's axis
  std::vector<double> rmse;       // [depth][angle], of what is judged
  std::vector<double> share;      // [depth][angle], of the squared error
};

/// Made from the features "depth" and "wall angle" of samples that touch (phase not "free");
/// nothing without these features.
std::optional<TractMap> tract_map(const Samples& samples);

}  // namespace tractus::lab
