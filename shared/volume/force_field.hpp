/// The force field of a volume: position → negative gradient of blurred opacity.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "volume/transfer_function.hpp"
#include "volume/volume.hpp"

namespace tractus::volume {

/// How the field is had between voxels (design: "The palpation law, made precise").
enum class FieldKind {
  paper,  ///< vectors −∇(ω∗α) by central differences at the voxels, interpolated by Catmull–Rom;
          ///< not conservative
  potential,  ///< −∇ of the Catmull–Rom interpolant of ω∗α; conservative
};

/// g and how it changes, at one point.
struct FieldSample {
  Vec3 g_per_m;          ///< −∇(ω∗α), 1/m, in V
  Mat3 jacobian_per_m2;  ///< ∂g_a/∂p_b, 1/m², in V
};

/// The blurred opacity of a part of a volume, to be kept in a file and made a field again.
struct StoredOpacity {
  Geometry geometry;           ///< of the whole volume
  Box box;                     ///< the voxels that are stored, not empty
  std::vector<float> opacity;  ///< ω∗α, [k][j][i] of the box
};

/// The blurred opacity of a part of a volume, computed beside a field and put into it later. Its
/// memory is taken once, at construction.
class FieldPatch {
 public:
  /// @param most_voxels  room for a patch whose `floats_for` is at most this
  explicit FieldPatch(std::size_t most_voxels);
  ~FieldPatch();
  FieldPatch(FieldPatch&&) noexcept;
  FieldPatch& operator=(FieldPatch&&) noexcept;

  /// What would be written again: the voxels that `changed` reaches. Empty (begin ≥ end) for none.
  static Box reached(const Box& changed, const std::array<int, 3>& dims) noexcept;
  /// The room that a change needs, in floats.
  static std::size_t floats_for(const Box& changed, const std::array<int, 3>& dims) noexcept;

 private:
  friend class ForceField;
  std::size_t room_ = 0;
  std::unique_ptr<float[]> memory_;
  float* first_ = nullptr;      // aligned, for voxel begin_
  std::array<int, 3> begin_{};  // of the memory: a multiple of eight along i
  std::ptrdiff_t row_pitch_ = 0;
  Box box_{};
};

/// The field of [Zoller2020, eq. (1)]:
///
///     g = −∇(ω ∗ α)                                                         (1)
///
/// α by the transfer function at the voxels; ω the 15-tap Gaussian exp(−k²/2), normalised, per axis
/// (σ = 1 voxel); ∇ per metre; edge voxels repeat outward: of the opacities under ω, of the blurred
/// ones beyond the volume. Holds the blurred opacity alone (4 bytes a voxel); the paper's vectors
/// are formed where they are needed, to the same value. Immutable but for `update`; sampling is
/// free of allocation and safe from several threads.
class ForceField {
 public:
  /// Errors: too_large (over 2^31 voxels), cancelled.
  static core::Result<ForceField> make(const Volume& volume, const TransferFunction& transfer,
                                       FieldKind kind, const core::Progress& progress = {});
  /// A field of which a part alone is known: where a sample reads the part alone, it is that of the
  /// whole field to the last bit; elsewhere it means nothing, and `left_part` says so. Address space is
  /// reserved for the whole volume, memory is used for the part's rows. It is never updated.
  /// Errors: bad_input (a box that is not in the volume, another number of opacities), too_large.
  static core::Result<ForceField> make(const StoredOpacity& part, FieldKind kind);
  ~ForceField();
  ForceField(ForceField&&) noexcept;
  ForceField& operator=(ForceField&&) noexcept;

  /// g at a point of V, 1/m.
  Vec3 gradient_per_m(const Vec3& p_V_m) const noexcept;
  /// g and its Jacobian.
  FieldSample sample(const Vec3& p_V_m) const noexcept;
  /// (ω∗α)(p), Catmull–Rom between voxels.
  double opacity(const Vec3& p_V_m) const noexcept;

  /// A copy of the opacities of a box within the volume.
  StoredOpacity stored(const Box& box) const;
  /// Did a sample since the last call read voxels beyond the part that is known? Never of a whole field.
  bool left_part() const noexcept;

  /// Makes the field that of `volume` again after voxels within `changed` were written. Not beside
  /// samplers.
  void update(const Volume& volume, const Box& changed) noexcept;

  /// What `update` would write, into `out`; the field stays as it is. Beside samplers and `apply`:
  /// it reads nothing that they write. `out` must have room: FieldPatch::floats_for.
  void compute(const Volume& volume, const Box& changed, FieldPatch& out) const noexcept;
  /// Puts a patch in place: with `compute` before, `update` to the last bit. Copies rows, nothing
  /// else: no allocation, real-time safe. Not beside samplers.
  void apply(const FieldPatch& patch) noexcept;

  FieldKind kind() const noexcept;
  const Geometry& geometry() const noexcept;

 private:
  struct Grid;
  explicit ForceField(std::unique_ptr<Grid> grid);
  std::unique_ptr<Grid> grid_;
};

}  // namespace tractus::volume
