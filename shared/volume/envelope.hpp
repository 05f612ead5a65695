/// The vertebra's outer face about a tract: which places are inside the bone, marrow among them.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "core/result.hpp"
#include "volume/tract.hpp"
#include "volume/volume.hpp"

namespace tractus::volume {

/// The outer face as points in V, a row after the other; none where it is known by no rows.
struct OuterFace {
  int around = 0;  ///< points of a row; the last joins the first; first and last row are poles
  std::vector<Vec3> points_m;
};

/// What is inside the vertebra. Immutable; safe from several threads.
class Envelope {
 public:
  static constexpr double kReach_m = 0.022;  ///< from the tract: no farther is the face looked for

  static constexpr double kCortex_m = 0.001;

  virtual ~Envelope() = default;
  /// How far a place lies inside the outer face, m, along the line from the tract; negative
  /// outside.
  virtual double inside_m(const Vec3& p_V_m) const noexcept = 0;
  /// With how thick the cortex is on that line, m: kCortex_m where nothing measures it.
  struct Depth {
    double inside_m, cortex_m;
  };
  virtual Depth depth(const Vec3& p_V_m) const noexcept { return {inside_m(p_V_m), kCortex_m}; }
  virtual OuterFace outer_face() const { return {}; }
  /// Share of a voxel there that is inside, 0 … 1: a half on the outer face, all and none within a
  /// voxel of the CT.
  double share(const Vec3& p_V_m) const noexcept { return share_at(inside_m(p_V_m)); }
  double share_at(double inside_m) const noexcept {
    return std::clamp(0.5 + inside_m / voxel_m_, 0.0, 1.0);
  }

 protected:
  explicit Envelope(double voxel_m) : voxel_m_(voxel_m) {}

 private:
  double voxel_m_;
};

/// A ball in which a person says that there is bone of this vertebra, or none.
struct EnvelopeMark {
  static constexpr double kLeast_m = 0.001, kMost_m = 0.010;  ///< radii
  static constexpr std::size_t kMostMarks = 200;

  Vec3 at_m = Vec3::Zero();  ///< its centre, in V
  double radius_m = 0.003;
  bool bone = true;
};

/// Finds the envelope in the CT itself. Rays leave the tract, to all sides along it and as a
/// hemisphere at each of its ends; on each the outer face is where the CT value falls most, and no
/// other fall lies before it. The cost of a face at r of one ray:
///
///     C(r) = −e(r) + μ ∫₀ʳ max(0, e − e₀) dt / w,   e(r) = (mean of v over r − w … r) −
///                                                           (mean of v over r … r + w)
///
/// v is the CT value within 0 … 600, e in units of 300. The faces of all rays are chosen together:
/// a step between neighbours costs in proportion to its length, up to a limit. Solved along four
/// directions as in [Hirschmueller2008] (there: a disparity per pixel). So the envelope is what is
/// seen from the tract: processes behind a corner are not in it, nor is what lies beyond kReach_m.
/// No face is looked for on this side of a mark of bone, nor beyond one of no bone. The cortex's
/// thickness on each ray is fitted (cortex.hpp), the median of each ray and its neighbours taken.
/// Known limit: about an entry that lies behind the vertebra a facet of the neighbour may be in it.
///
/// Errors: out_of_range with one line for the person who asked: slices thicker than 3.5 mm, metal
/// or a contrast agent in the tract, a tract that no closed ring of bone surrounds, bone that goes on
/// beyond reach to lateral, superior or inferior.
core::Result<std::unique_ptr<Envelope>> envelope_about(const Volume& ct, const Tract& tract,
                                                       std::span<const EnvelopeMark> marks = {});

/// The same face, to be looked at: also where it is refused as an envelope. Errors: slices that are
/// too thick.
core::Result<OuterFace> outer_face_about(const Volume& ct, const Tract& tract,
                                         std::span<const EnvelopeMark> marks = {});

/// The voxels of a label map that carry `label`, as another program segmented them; between voxels
/// trilinear. It may have a grid of its own. Errors: out_of_range where no voxel carries the label.
core::Result<std::unique_ptr<Envelope>> envelope_of_labels(const Volume& labels, int label);

}  // namespace tractus::volume
