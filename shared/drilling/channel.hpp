/// What a burr made of a plan: the channel's place, direction and depth, and where it left the
/// bone.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/json.hpp"
#include "drilling/erosion.hpp"
#include "volume/tract.hpp"

namespace tractus::drilling {

/// The bone and the channel across the tract at one depth: offsets from the planned axis towards
/// medial and towards superior, m.
struct CrossSection {
  double depth_m = 0.0;  ///< along the tract
  /// From the nearest point of the cortex's outer face to the farthest voxel of the channel;
  /// negative where that lies within.
  double beyond_m = 0.0;
  math::Vec2 cortex_m = math::Vec2::Zero(), farthest_m = math::Vec2::Zero();  ///< both points
  std::vector<math::Vec2> outline_m;  ///< the cortex's outer face, once round the axis
  /// The circle as large as the channel in this section.
  math::Vec2 centre_m = math::Vec2::Zero();
  double radius_m = 0.0;

  core::Json to_json() const;
};

/// A channel held against a planned tract. A voxel is of it when it has lost half of itself or
/// more.
///
/// The axis is the principal axis of the voxels' shares lost between the first and the last of them
/// along the tract. Whether the channel left the bone is asked of the bone as it was
/// (volume::WallFinder): at every millimetre of the tract that bone encloses, as `thinnest` means
/// it, the outer face of each side wall, and the anterior one ahead of its end; a wall is seen as
/// its finder sees it, over the width of the tract. Where no wall is found, nothing is said.
struct PilotHole {
  std::size_t voxels = 0;
  /// Of the axis at the plane of the planned entry: towards medial, towards superior, m. As the
  /// angle, absent for a channel not three times as long as wide.
  std::optional<math::Vec2> entry_offset_m;
  std::optional<double> angle_rad;  ///< between its axis and the tract's
  std::optional<double> depth_m;    ///< of its deepest voxel along the tract; absent without any
  /// In the order of volume::kWalls: how far it reaches beyond the wall's outer face, m; negative
  /// within. Absent where it never came to a place with a known wall.
  std::array<std::optional<double>, volume::kWalls.size()> beyond_m;
  /// Where it reaches farthest beyond the cortex, or nearest to it, in any direction across the
  /// tract, of the depths with four known side walls.
  std::optional<CrossSection> worst;

  /// {"voxels", "entry_offset_m": [2]|null, "angle_rad"|null, "depth_m"|null,
  /// "beyond_m": {wall: m|null}, "worst": {"depth_m", "beyond_m", "cortex_m", "farthest_m",
  /// "outline_m", "centre_m", "radius_m"}|null}.
  core::Json to_json() const;
};

PilotHole channel_of(const Erosion& erosion, const volume::TransferFunction& transfer,
                     const volume::Tract& tract);

}  // namespace tractus::drilling
