/// A coarse volume of a case, for a web page.
#pragma once

#include <string>

#include "core/result.hpp"
#include "volume/volume.hpp"

namespace tractus::api {

struct Backend;

struct Preview {
  volume::Geometry geometry;  ///< of the coarse voxels
  std::string opacity;        ///< 0 … 255 for 0 … 1, [k][j][i]
};

/// The opacity in the box around the tract with the margin kMargin_m on each side, by the case's
/// transfer function, averaged over equal blocks so that no side has more than `max_side` voxels.
/// Reads only the necessary bricks. Errors: not_found (no such case, or a case without a volume),
/// too_large, those of reading.
core::Result<Preview> case_preview(Backend& backend, const std::string& case_id, int max_side);

inline constexpr double kMargin_m = 0.012;

/// Only the averaging. @pre step ≥ 1
Preview averaged(const volume::Volume& box, const std::vector<float>& opacity, int step);

}  // namespace tractus::api
