/// Drilling the channel of a pedicle screw into a volume, and breaking out of it on purpose.
///
///            mouth        entry                    breach hole        end (flat)
///     . . . ===============|======================[   ]===============|
///      open air            depth 0                 ^ at depth          length
///                                        beyond the wall's outer face by breach depth, rounded tip
#pragma once

#include <optional>
#include <vector>

#include "core/result.hpp"
#include "volume/tract.hpp"
#include "volume/transfer_function.hpp"
#include "volume/volume.hpp"

namespace tractus::volume {

/// What is asked for.
struct BreachPlan {
  Wall wall = Wall::medial;
  double depth_m = 0.003;  ///< how far the tool goes beyond the bone's outer face, > 0
  std::optional<double> at_m = std::nullopt;  ///< depth along the tract; without it, where that
                                              ///< wall is thinnest in the pedicle
};

/// A wall of bone met by a ray from the tract's surface outwards. Distances from the tract's axis
/// (for `anterior`: from its end), m.
struct WallFound {
  Wall wall = Wall::medial;
  double at_m = 0.0;     ///< depth along the tract of the ray
  double inner_m = 0.0;  ///< where the bone begins
  double outer_m = 0.0;  ///< where it has ended
  double thickness_m() const { return outer_m - inner_m; }
};

/// A breach with its place.
struct Breach {
  WallFound wall;
  double depth_m = 0.0;
  Vec3 from_m = Vec3::Zero();    ///< where the tool leaves the tract's axis, in V
  Vec3 tip_m = Vec3::Zero();     ///< the farthest point it reaches, in V
  Vec3 centre_m = Vec3::Zero();  ///< middle of the hole in the wall, in V
};

/// The walls of the bone about a tract, seen through the transfer function.
///
/// The rays are bundles of seven (axis and a hexagon at 0.7 of the tract's radius), averaged, so
/// that the noise of single voxels does not pass for bone; a side ray starts at the tract's
/// surface, the anterior one at its end. Along a bundle bone is a run with opacity of 0.03 or more
/// and a peak of at least 0.06, ended by 2 mm without (5 mm where the peak is under 0.2, as the
/// front of a porous body; less is a gap within bone); its faces are where the opacity crosses half
/// of its peak. The first run is the wall.
class WallFinder {
 public:
  static constexpr double kReach_m = 0.025;  ///< no farther is a wall looked for

  /// Both must outlive it.
  WallFinder(const Volume& volume, const TransferFunction& transfer)
      : volume_(volume), transfer_(transfer) {}

  /// The wall at one depth. Errors: out_of_range (no bone within reach in that direction, bone
  /// never left within reach, or the volume ends first).
  core::Result<WallFound> wall_at(const Tract& tract, Wall wall, double at_m) const;
  /// The same in any direction across the tract: 0 is medial, a quarter turn superior.
  core::Result<WallFound> wall_towards(const Tract& tract, double angle_rad, double at_m) const;

  /// The thinnest place of a side wall along the pedicle: of the depths (every 0.5 mm, from 5 mm
  /// behind the first) where all four side walls begin within 12 mm of the axis, those that are at
  /// most 1.15 times as wide, medial to lateral, as the narrowest, the isthmus; of places that
  /// differ by less than 0.3 mm the one nearest to the isthmus. For `anterior`, the wall ahead of
  /// the end. Errors: as `wall_at`; out_of_range where no part of the tract is so enclosed.
  core::Result<WallFound> thinnest(const Tract& tract, Wall wall) const;
  /// The same of every wall, in the order of kWalls, in the time of one.
  std::vector<core::Result<WallFound>> thinnest(const Tract& tract) const;

  /// How far behind the entry the bone reaches on the tract's line, m: the drill came through that.
  /// Bone is followed over gaps of up to 5 mm, for at most 40 mm.
  double behind_entry_m(const Tract& tract) const;

  /// Is there bone on the tract's axis or to a side of it within 12 mm, anywhere along it?
  bool bone_about(const Tract& tract) const;

 private:
  struct Bundle;
  using Section = std::array<WallFound, 4>;  // medial, lateral, superior, inferior, as in kWalls
  std::optional<Section> section_at(const Tract& tract, double at_m) const;
  std::vector<Section> sections_of(const Tract& tract) const;
  static core::Result<WallFound> thinnest_of(std::vector<Section> sections, Wall wall);
  core::Result<WallFound> first_run(const Bundle& bundle, WallFound found, double from_m) const;
  std::optional<double> opacity_at(const Bundle& bundle, double distance_m) const;
  const Volume& volume_;
  const TransferFunction& transfer_;
};

/// Finds where a breach goes. Errors: those of WallFinder; bad_input for a depth or place that is
/// no number, not positive or not along the tract.
core::Result<Breach> place_breach(const Volume& volume, const TransferFunction& transfer,
                                  const Tract& tract, const BreachPlan& plan);

/// The CT value of an emptied voxel: 0 HU (water, blood) where the transfer function gives it and
/// all below it no opacity, else the transfer function's first point. Errors: out_of_range if even
/// that has opacity, or the volume's counts cannot hold a value without opacity.
core::Result<double> empty_value(const Volume& volume, const TransferFunction& transfer);

/// Removes the channel (a cylinder with a flat end at the tract's length, open for `mouth_m` behind
/// the entry) and the breach (a capsule of the tract's radius from the axis to its tip; anterior:
/// along the axis from the end). Where a voxel is cut by the wall its value moves by the share
/// removed, so the wall is smooth: v + share · (min(v, empty) − v). Returns the box of the voxels
/// that may have changed.
Box drill(Volume& volume, const Tract& tract, double mouth_m, const std::optional<Breach>& breach,
          double empty);

/// Of a volume that was drilled without a breach makes what `drill` of the whole bone with `breach`
/// gives, to the same bits: only what lies about the breach comes back from `bone` and is drilled
/// anew. Without `breached` it goes back. Returns the box of the voxels that may have changed.
Box redrill(Volume& drilled, const Volume& bone, const Tract& tract, double mouth_m,
            const Breach& breach, bool breached, double empty);

}  // namespace tractus::volume
