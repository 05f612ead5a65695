/// Sampling of a scalar grid between its voxels, in units of the grid: the arithmetic under
/// ForceField.
#pragma once

#include <Eigen/Core>

#include "volume/scalar_grid.hpp"

namespace volume {

/// b = ω∗α and what follows from it at one point, per voxel index instead of per metre.
struct IndexSample {
  Eigen::Vector3d gradient;  ///< +∇b (the field is its negative)
  Eigen::Matrix3d jacobian;  ///< of `gradient`, row a: its component a
};

/// Catmull–Rom [Catmull1974; Zoller2020, "Haptic rendering"] between four neighbours at −1, 0, 1,
/// 2, t of the way from 0 to 1:  w(t) = ½ (−t³ + 2t² − t,  3t³ − 5t² + 2,  −3t³ + 4t² + t,  t³ −
/// t²). `u` is the continuous voxel index; beyond the grid the edge voxels of b repeat outward. NaN
/// counts as 0.
double interpolated(const ScalarGrid& grid, const Eigen::Vector3d& u) noexcept;

/// The analytic gradient of the interpolant of b.
Eigen::Vector3d potential_gradient(const ScalarGrid& grid, const Eigen::Vector3d& u) noexcept;
IndexSample potential_sample(const ScalarGrid& grid, const Eigen::Vector3d& u) noexcept;

/// The interpolant of the central differences of b at the voxels: the published field. The
/// differences are folded into the weights, so that along the differentiated axis b is weighed over
/// six neighbours, −2 … 3:
///
///     Σ_i w_i (b_{i+1} − b_{i−1})/2 = Σ_m d_m b_m,   d_m = (w_{m−1} − w_{m+1})/2
Eigen::Vector3d paper_gradient(const ScalarGrid& grid, const Eigen::Vector3d& u) noexcept;
IndexSample paper_sample(const ScalarGrid& grid, const Eigen::Vector3d& u) noexcept;

}  // namespace volume
