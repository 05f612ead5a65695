/// Where medial, lateral, superior and inferior are: from the patient's axes and the vertebra's own
/// symmetry.
#pragma once

#include <optional>

#include "core/result.hpp"
#include "volume/tract.hpp"
#include "volume/transfer_function.hpp"
#include "volume/volume.hpp"

namespace tractus::volume {

/// The plane that halves the vertebra. It contains the patient's z; seen from above it may be
/// turned a little, as patients do not lie straight.
struct Midline {
  Vec3 at_m = Vec3::Zero();  ///< a point of the plane, in V: at the entry's y and z
  double turn_rad = 0.0;     ///< about z, from the patient's sagittal plane
  std::optional<double>
      symmetry;  ///< 0 … 1, how well the halves agree; absent when a person stated the plane

  /// Unit normal in V, to the patient's left.
  Vec3 left() const { return {std::cos(turn_rad), std::sin(turn_rad), 0.0}; }
  /// Distance of a point from the plane, m, positive to the patient's left.
  double left_of_plane_m(const Vec3& p_V_m) const { return (p_V_m - at_m).dot(left()); }
};

/// The midline a person states: the sagittal plane at x.
Midline stated_midline(double x_m, const Vec3& entry_m);

/// Finds the midline about a tract: of all planes within 35 mm of the entry and turned by up to
/// 12°, the one whose halves agree best in opacity, in a box from 5 mm before the target to 30 mm
/// behind the entry, 35 mm to each side and 15 mm up and down. The measure is Σ 2αα′ / Σ (α² +
/// α′²), times the same sum not normalised, so that a plane with little bone beside it cannot win.
/// Found to about 1 mm and 1°. Errors: out_of_range where no plane agrees well (under 0.5) or there
/// is no bone: state the midline then.
core::Result<Midline> midline_about(const Volume& volume, const TransferFunction& transfer,
                                    const Vec3& entry_m, const Vec3& target_m);

/// The tract from `entry_m` towards `target_m`. Medial is towards the midline and perpendicular to
/// the axis, superior perpendicular to both, on the side of the patient's z. Errors: bad_input
/// (numbers not finite, entry and target the same, length or radius not positive), out_of_range
/// (the entry lies within 2 mm of the midline, so that its side is not known; the axis runs along
/// left-right or up-down to within 20°, where the walls' names lose their meaning).
core::Result<Tract> tract_between(const Vec3& entry_m, const Vec3& target_m, double length_m,
                                  double radius_m, const Midline& midline);

}  // namespace tractus::volume
