/// The rival: the law as its authors describe it, written straight.
#pragma once

#include <vector>

#include "laws/palpation_law.hpp"
#include "volume/volume.hpp"

namespace tractus::bench {

/// g at every voxel as three floats, Catmull–Rom over 64 neighbours in plain loops, and relaxation
/// of the bending with a fixed gain [Zoller2020, "Iterative pedicle probe bending"], i_max = 1000.
/// The paper prints no gain.
class PublishedRelaxation {
 public:
  /// @param field  where g at the voxels is taken from, which is exact there.
  PublishedRelaxation(const volume::Volume& volume, const volume::ForceField& field,
                      const laws::PalpationParameters& parameters, double gain_m_per_N);
  laws::PalpationStep step(const math::Pose& X_VH, laws::PalpationState& state) const;
  math::Vec3 gradient_per_m(const math::Vec3& p_V_m) const;

 private:
  struct Vector {
    float x, y, z;
  };
  volume::Geometry geometry_;
  laws::PalpationParameters parameters_;
  double gain_m_per_N_;
  std::vector<Vector> g_;  // [k][j][i], 1/m
};

}  // namespace tractus::bench
