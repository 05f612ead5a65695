/// Where the device stands in the patient: X_VD.
#pragma once

#include "math/geometry.hpp"
#include "volume/carve.hpp"
#include "volume/tract.hpp"

namespace tractus::loop {

/// D's origin is the centre of the device's workspace. With the handle there and the probe straight
/// along the tract, the tip lies in the middle of the tract's mouth:
///
///     x_D = −axis (towards the operator),  z_D = superior (up),  y_D = z_D × x_D
///     p_VD = entry − L · axis − offset
///
/// `pose_offset_m` is the model's, which is added to every pose (in V) before the law sees it;
/// taken off here so that a model that was fitted with one starts at the mouth like any other.
math::Pose place_device(const volume::Tract& tract, double probe_length_m,
                        const math::Vec3& pose_offset_m);

/// The tract as the device's user sees it, in D.
volume::Tract tract_in_device(const volume::Tract& tract_V, const math::Pose& X_VD,
                              const math::Vec3& pose_offset_m);

/// Depth from which all four side walls are found with their outer faces within 14 mm, as a surgeon
/// sees it in the planning images, m; 0 where that is nowhere in the first 20 mm.
double enclosed_from_m(const volume::Volume& volume, const volume::TransferFunction& transfer,
                       const volume::Tract& tract);

}  // namespace tractus::loop
