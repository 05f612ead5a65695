/// Bone worn away by a burr, sample by sample: an exact function of the bone, the burr and what was
/// recorded, so that a trial replays to the same voxels.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/result.hpp"
#include "drilling/burr.hpp"
#include "trial/signals.hpp"
#include "volume/transfer_function.hpp"
#include "volume/volume.hpp"

namespace tractus::drilling {

/// So many ticks, by their number, wear the bone together: 5 ms at 4 kHz.
inline constexpr std::uint32_t kChunkTicks = 20;
/// The most floats that one change of the field needs (volume::FieldPatch): what a loop may copy
/// between two ticks.
inline constexpr std::size_t kMostPatchFloats = std::size_t(1) << 16;

/// Voxels that were written together.
struct Change {
  volume::Box box;
  std::uint32_t number = 0;  ///< from 1
  double t_s = 0.0;          ///< of the last sample that wore them
};

/// The state of a drilling. A sample wears when the device's first button was held
/// (trial::kPressed) and the sample was fresh: between the sample before and this one the ball is
/// swept along a straight line at the rate of this sample's force; after a stall of more than
/// 20 ms, or a jump of more than 20 mm, it only starts there. A voxel's count moves from the bone's
/// own to that of the empty value (volume::empty_value) by the share it has lost, whole at last:
///
///     c = c₀ − round(m (c₀ − c_empty)),   m = min(1, ∫ρ (1 − d²/r²) dt),   c₀ > c_empty
///
/// The model's field pushes back in proportion to opacity, and not at all where there is none. So
/// the push that counts is taken per opacity (own): ρ(F/ᾱ), with ᾱ the mean opacity in the ball as
/// it is now, weighed by 1 − d²/r²; where ᾱ is 0 nothing resists, and ρ = ρ₁ without a push.
///
/// The integral is a sum over balls no farther apart than half a voxel. Changes are told at the
/// end of each chunk, and within one where the box would outgrow kMostPatchFloats.
class Erosion {
 public:
  using Take = std::function<void(const Change&)>;

  /// `bone` is copied once (what is drilled) and must outlive this (what it was). Errors:
  /// out_of_range (nothing can be drilled away, or the burr is too many voxels wide for a change to
  /// fit kMostPatchFloats).
  static core::Result<Erosion> make(const volume::Volume& bone,
                                    const volume::TransferFunction& transfer, const Burr& burr,
                                    const trial::ProbeShape& probe);

  /// The next sample, in order of tick. `changed` is called before this returns.
  void add(const trial::Sample& sample, const Take& changed);
  /// The last chunk, as far as it came.
  void finish(const Take& changed);

  const volume::Volume& volume() const noexcept { return drilled_; }  ///< as it is now
  const volume::Volume& bone() const noexcept { return *bone_; }      ///< as it was
  /// Share that a voxel has lost, 0 … 1; also where there was no more than the empty value.
  double lost(int i, int j, int k) const noexcept { return lost_[bone_->offset(i, j, k)]; }
  /// The voxels that lost anything; empty (begin = end) when none did.
  const volume::Box& worn() const noexcept { return worn_; }
  /// The voxels whose counts changed; empty (begin = end) when none did.
  const volume::Box& box() const noexcept { return box_; }
  /// Of voxels whose CT value has opacity, m³.
  double removed_m3() const noexcept { return removed_m3_; }
  std::uint32_t changes() const noexcept { return changes_; }

 private:
  struct Free {
    void operator()(float* memory) const noexcept { std::free(memory); }
  };
  struct Last {
    math::Vec3 centre_m;
    double t_s;
  };
  /// A ball that was held (nearly) in place: one placement for all of it.
  struct Dose {
    math::Vec3 at_m = math::Vec3::Zero();      ///< where it began
    math::Vec3 moment_m = math::Vec3::Zero();  ///< Σ dose · centre
    double sum = 0.0;                          ///< ∫ρ dt
  };
  Erosion(const volume::Volume& bone, const Burr& burr, const trial::ProbeShape& probe,
          std::uint16_t empty);
  double mean_opacity(const math::Vec3& centre_m) const noexcept;
  void sweep(const math::Vec3& from_m, const math::Vec3& to_m, double dose, const Take& changed);
  void place(const math::Vec3& centre_m, double dose, const Take& changed);
  void wear(const Take& changed);
  void wear_voxel(std::size_t at, int i, int j, int k, double share) noexcept;
  void flush(const Take& changed);
  void tell(const Take& changed);

  const volume::Volume* bone_;
  volume::Volume drilled_;
  std::unique_ptr<float[], Free> lost_;  // zero pages until they are touched
  std::vector<float> opacity_;           // [count]
  Burr burr_;
  trial::ProbeShape probe_;
  std::uint16_t empty_;
  double finest_m_;
  std::optional<Last> last_;
  std::uint32_t chunk_ = 0;
  Dose dose_;
  volume::Box changing_, box_, worn_;
  double removed_m3_ = 0.0;
  std::uint32_t changes_ = 0;
};

/// What is shown of a drilling: the share that each voxel of a box has lost.
struct ErodedShares {
  volume::Box box;          ///< empty (begin = end): nothing was worn
  std::vector<float> lost;  ///< [k][j][i] of the box, Erosion::lost
  double removed_m3 = 0.0;  ///< Erosion::removed_m3
};

ErodedShares worn_of(const Erosion& erosion);

/// The smallest box that holds both; an empty one adds nothing.
volume::Box united(const volume::Box& a, const volume::Box& b) noexcept;

}  // namespace tractus::drilling
