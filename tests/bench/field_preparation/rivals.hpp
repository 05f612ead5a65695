/// What field_preparation is measured against. Each returns seconds of processor time, on one
/// thread.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "volume/volume.hpp"

namespace tractus::bench {

/// The bound: counts read, as many floats written past the caches, nothing computed. Least of
/// `times`.
double copy_bound_s(std::span<const std::uint16_t> counts, int times);

/// Opacities [k][j][i], made beforehand and not counted: the rivals have no transfer function in
/// this task.
struct Opacities {
  std::array<int, 3> dims;
  std::vector<float> alpha;
};

/// What a rival made: its time, and its blurred opacity at a voxel.
struct Prepared {
  double time_s;
  std::function<double(int i, int j, int k)> blurred;
};

/// vtkImageGaussianSmooth (σ = 1, seven voxels each side), then vtkImageGradient.
Prepared vtk_rival(const Opacities& opacities);
/// itk::DiscreteGaussianImageFilter (variance 1), then itk::GradientImageFilter. Its kernel is a
/// discrete one of Bessel functions, not the sampled exponential: it differs by some hundredths of
/// opacity where opacity jumps.
Prepared itk_rival(const Opacities& opacities);

}  // namespace tractus::bench
