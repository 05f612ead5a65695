/// From a patient's CT to what a case holds: the tract with its walls' names, the breach, the
/// drilled volume.
#pragma once

#include <array>
#include <optional>

#include "cases/case.hpp"
#include "volume/anatomy.hpp"
#include "volume/carve.hpp"

namespace tractus::cases {

/// What a person asks for. Points in V (the patient's LPS), m.
struct CarvingPlan {
  math::Vec3 entry_m = math::Vec3::Zero();
  math::Vec3 target_m = math::Vec3::Zero();
  std::optional<double> length_m = {};  ///< to the target if not given
  double radius_m = 0.0015;             ///< the 3 mm drill of [Zoller2020]
  std::optional<volume::BreachPlan> breach = {};
  std::optional<double> midline_x_m = {};  ///< stated by a person; estimated if not given
  double spacing_m = 0.00035;              ///< of the drilled volume, where the CT is coarser
  double margin_m = 0.020;                 ///< of the drilled volume about tract and breach
  bool drilled = true;  ///< else the tract is a plan: the bone stays whole, and has no breach
};

/// Where tract, walls and breach come to lie, before anything is drilled.
struct Placed {
  volume::Tract tract;
  volume::Midline midline;
  bool drilled = true;       ///< else a plan alone
  double mouth_m = 0.0;      ///< how far behind the entry the channel was opened
  double empty_value = 0.0;  ///< CT value of what was removed
  std::optional<volume::Breach> breach;
  /// In the order of volume::kWalls, before the drill: where each wall is thinnest, or why that is
  /// not known.
  std::vector<core::Result<volume::WallFound>> walls;

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

/// Finds the anatomy and places the breach. Errors: bad_input and out_of_range with one line for
/// the person who asked (a point or the tract's end outside the volume, a tract that meets no bone,
/// numbers that are none; those of midline_about, tract_between and place_breach).
core::Result<Placed> place(const volume::Volume& ct, const volume::TransferFunction& transfer,
                           const CarvingPlan& plan);

/// Places it, cuts the part about the tract out on a finer grid and drills it (or does not:
/// CarvingPlan::drilled). Errors: those of
/// `place`; too_large; cancelled.
core::Result<Carved> carve(const volume::Volume& ct, const volume::TransferFunction& transfer,
                           const CarvingPlan& plan, const core::Progress& progress = {});

/// A wider, coarser part of the CT (40 mm about the tract, at most 0.5 mm voxels where the CT is
/// coarser), drilled in the same way: for the picture. Errors: too_large.
core::Result<volume::Volume> drilled_surroundings(const volume::Volume& ct, const Carved& carved);

}  // namespace tractus::cases
