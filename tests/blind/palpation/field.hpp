#pragma once
/// Opacity, its blur and the force field of a volume, in double precision.
///
///     g = −∇(ω ∗ α)       per metre; ω has 15 taps per axis, exp(−k²/2) normalised; edge voxels
///     repeat outward
#include <utility>

#include "palpation/volume.hpp"

namespace blind {

enum class FieldKind { kPaper, kPotential };

/// CT value to opacity, linear between points, constant beyond them.
using Transfer = std::vector<std::pair<double, double>>;

class Field {
 public:
  Field(const Volume& volume, const Transfer& transfer, FieldKind kind);
  /// g at a place in the volume's frame.
  Vec3 at(const Vec3& p_m) const;
  /// (ω ∗ α) there.
  double opacity(const Vec3& p_m) const;
  /// CT value there, three-linear: for effects that follow the density.
  double density(const Vec3& p_m) const;

 private:
  struct Taps {
    std::array<std::size_t, 4> x, y, z;
    std::array<std::array<double, 4>, 3> weight, slope;
  };
  Taps taps(const Vec3& p_m) const;
  void blur(int axis);
  void differentiate();

  Volume volume_;
  FieldKind kind_;
  std::vector<double> opacity_;
  std::array<std::vector<double>, 3> force_;
};

}  // namespace blind
