/// From a patient's CT to what a case holds: the tract with its walls' names, the breach, the
/// drilled volume.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "cases/case.hpp"
#include "volume/anatomy.hpp"
#include "volume/calibration.hpp"
#include "volume/carve.hpp"
#include "volume/fill.hpp"

namespace tractus::cases {

/// What a person asks for. Points in V (the patient's LPS), m.
struct CarvingPlan {
  math::Vec3 entry_m = math::Vec3::Zero();
  math::Vec3 target_m = math::Vec3::Zero();
  /// If not given: to the target; in filled bone to kBehindFront_m before its anterior face, so
  /// that every wall's breach goes with one length and the length tells nothing.
  std::optional<double> length_m = {};
  double radius_m = 0.0015;  ///< the 3 mm drill of [Zoller2020]
  std::optional<volume::BreachPlan> breach = {};
  /// In filled bone, for a breach without a stated place: where it is as hard to tell as those of
  /// the other walls (cases::make_five), not where it is told best.
  bool even = false;
  /// Where a certificate does not pass, entry and target may be moved together across the axis by
  /// at most this, in steps of 1 mm, to where it does.
  double may_move_m = 0.0;
  std::optional<double> midline_x_m = {};  ///< stated by a person; estimated if not given
  double spacing_m = 0.00035;              ///< of the drilled volume, where the CT is coarser
  double margin_m = 0.020;                 ///< of the drilled volume about tract and breach
  bool drilled = true;  ///< else the tract is a plan: the bone stays whole, and has no breach
  volume::Preparation preparation = volume::Preparation::published;
  /// Of filled bone; found in the CT (volume::envelope_about) if not given.
  std::shared_ptr<const volume::Envelope> envelope = {};
  /// Where a person says that there is bone of this vertebra or none, while it is looked for.
  std::vector<volume::EnvelopeMark> envelope_marks = {};
};

/// Where a tract ends behind the anterior face of filled bone: its cortex, some 0.5 to 1 mm, and at
/// most 2 mm behind that, so that a tap reaches it.
inline constexpr double kBehindFront_m = 0.0025;

/// Where tract, walls and breach come to lie, before anything is drilled.
struct Placed {
  volume::Tract tract;
  volume::Midline midline;
  bool drilled = true;       ///< else a plan alone
  double mouth_m = 0.0;      ///< how far behind the entry the channel was opened
  double empty_value = 0.0;  ///< CT value of what was removed
  std::optional<volume::Breach> breach;
  std::shared_ptr<const volume::Envelope> envelope;  ///< none of published bone
  /// In the order of volume::kWalls, before the drill: where each wall is thinnest, or why that is
  /// not known.
  std::vector<core::Result<volume::WallFound>> walls;
  volume::Calibration calibration = {};  ///< of filled bone

  Truth truth() const;
  bool left_side() const { return midline.left_of_plane_m(tract.entry_m) > 0; }
};

struct Carved : Placed {
  volume::Volume volume;  ///< the part about the tract, drilled
};

/// The voxels that `place` and `carve` look at, at the default margin: whatever lies outside may be
/// missing from `ct` and the answer is the same. Errors: out_of_range for an entry or a target
/// outside the volume, bad_input for numbers that are none.
core::Result<volume::Box> box_that_matters(const volume::Geometry& geometry,
                                           const math::Vec3& entry_m, const math::Vec3& target_m);

/// The tract of a plan as long as asked for, whether or not its bone can be filled. Errors: those of
/// `place` but for the envelope's, the breach's and the end's.
core::Result<volume::Tract> planned_tract(const volume::Volume& ct,
                                          const volume::TransferFunction& transfer,
                                          const CarvingPlan& plan);

/// Finds the anatomy and places the breach. Errors: bad_input and out_of_range with one line for
/// the person who asked (a point or the tract's end outside the volume, a tract that meets no bone,
/// numbers that are none; those of midline_about, tract_between and place_breach).
core::Result<Placed> place(const volume::Volume& ct, const volume::TransferFunction& transfer,
                           const CarvingPlan& plan);

/// What was placed, and what its walls were found in: the CT about the tract at its own spacing,
/// prepared.
struct PlacedInBone {
  Placed placed;
  volume::Volume bone;
};
/// `place`, with the bone. Errors: those of `place`.
core::Result<PlacedInBone> place_in_bone(const volume::Volume& ct,
                                         const volume::TransferFunction& transfer,
                                         const CarvingPlan& plan);

/// The bone about what was placed on its finer grid, prepared, before the drill. Errors: too_large,
/// cancelled, out_of_range (Filling).
core::Result<volume::Volume> bone_about(const volume::Volume& ct,
                                        const volume::TransferFunction& transfer,
                                        const CarvingPlan& plan, const Placed& placed,
                                        const core::Progress& progress = {});

/// Places it, cuts the part about the tract out on a finer grid and drills it (or does not:
/// CarvingPlan::drilled). Errors: those of
/// `place`; too_large; cancelled.
core::Result<Carved> carve(const volume::Volume& ct, const volume::TransferFunction& transfer,
                           const CarvingPlan& plan, const core::Progress& progress = {});

/// A wider, coarser part of the CT (40 mm about the tract, at most 0.5 mm voxels where the CT is
/// coarser), drilled in the same way: for the picture. Errors: too_large.
core::Result<volume::Volume> drilled_surroundings(const volume::Volume& ct, const Carved& carved);

}  // namespace tractus::cases
