/// Correction of a gantry tilt: slices are shifted back over one another.
#pragma once

#include "core/result.hpp"
#include "volume/volume.hpp"

namespace tractus::volume_io {

/// A volume whose slice k lies shifted by k · `shear_m` (within its plane) from where its geometry
/// says, resampled onto that geometry: linear within each slice, none across slices. The grid grows
/// so that nothing is cut off; what no slice covers gets count 0, the least value. Errors:
/// bad_input (the grown grid is over the limits), led by `where`.
core::Result<volume::Volume> correct_gantry_tilt(const volume::Volume& tilted,
                                                 const volume::Vec3& shear_m,
                                                 const std::string& where);

}  // namespace tractus::volume_io
