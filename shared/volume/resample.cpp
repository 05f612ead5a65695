#include "volume/resample.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace volume {
namespace {

using Dims = std::array<int, 3>;

/// Four source voxels and their weights for one voxel of the result, along one axis.
struct Tap {
  std::array<int, 4> at;
  std::array<float, 4> weight;
};

/// Catmull–Rom, t in 0 … 1 between the second and the third voxel.
std::array<float, 4> catmull_rom(double t) {
  return {float(t * (-0.5 + t * (1.0 - 0.5 * t))), float(1.0 + t * t * (-2.5 + 1.5 * t)),
          float(t * (0.5 + t * (2.0 - 1.5 * t))), float(t * t * (-0.5 + 0.5 * t))};
}

/// One axis of the new grid: its taps count from the first voxel that any of them reads.
struct Axis {
  double spacing_m;
  int first, count;  // source voxels read
  std::vector<Tap> taps;
};

Axis axis_of(int begin, int end, int dim, double source_m, double spacing_m) {
  Axis axis{.spacing_m = std::min(source_m, spacing_m),
            .first = std::max(begin - 1, 0),
            .count = 0,
            .taps = {}};
  axis.count = std::min(end + 1, dim) - axis.first;
  const int n = 1 + int(std::floor((end - 1 - begin) * source_m / axis.spacing_m + 1e-9));
  for (int m = 0; m < n; ++m) {
    const double at = begin + m * (axis.spacing_m / source_m);
    const int low = std::min(int(std::floor(at + 1e-9)), dim - 1);
    Tap tap{.at = {}, .weight = catmull_rom(std::max(at - low, 0.0))};
    for (int q = 0; q < 4; ++q)
      tap.at[std::size_t(q)] =
          std::clamp(std::clamp(low - 1 + q, 0, dim - 1) - axis.first, 0, axis.count - 1);
    axis.taps.push_back(tap);
  }
  return axis;
}

float blend(const Tap& tap, const float* from, std::size_t stride) {
  float sum = 0.0f;
  for (std::size_t q = 0; q < 4; ++q) sum += tap.weight[q] * from[std::size_t(tap.at[q]) * stride];
  return sum;
}

/// One source slice k, resampled along i and j. [j][i], counts.
std::vector<float> slice_of(const Volume& volume, const Axis& i_axis, const Axis& j_axis, int k) {
  const std::size_t ni = i_axis.taps.size();
  std::vector<float> rows(std::size_t(j_axis.count) * ni), out(j_axis.taps.size() * ni);
  tbb::parallel_for(0, j_axis.count, [&](int j) {
    const std::uint16_t* from = &volume.counts[volume.offset(i_axis.first, j_axis.first + j, k)];
    const std::vector<float> row(from, from + i_axis.count);
    for (std::size_t i = 0; i < ni; ++i)
      rows[std::size_t(j) * ni + i] = blend(i_axis.taps[i], row.data(), 1);
  });
  tbb::parallel_for(std::size_t(0), j_axis.taps.size(), [&](std::size_t j) {
    for (std::size_t i = 0; i < ni; ++i)
      out[j * ni + i] = blend(j_axis.taps[j], rows.data() + i, ni);
  });
  return out;
}

/// One slice of the result, counts to the nearest.
void blend_slices(const Tap& tap, const std::vector<std::vector<float>>& slices,
                  std::span<std::uint16_t> out) {
  std::array<const float*, 4> from{};
  for (std::size_t q = 0; q < 4; ++q) from[q] = slices[std::size_t(tap.at[q])].data();
  tbb::parallel_for(tbb::blocked_range(std::size_t(0), out.size()), [&](const auto& part) {
    for (std::size_t m = part.begin(); m < part.end(); ++m) {
      float sum = 0.0f;
      for (std::size_t q = 0; q < 4; ++q) sum += tap.weight[q] * from[q][m];
      out[m] = std::uint16_t(int(std::clamp(sum, 0.0f, 65535.0f) + 0.5f));
    }
  });
}

core::Result<void> check(const Volume& volume, const Box& box, double spacing_m) {
  for (std::size_t a = 0; a < 3; ++a)
    if (box.begin[a] < 0 || box.end[a] <= box.begin[a] || box.end[a] > volume.geometry.dims[a])
      return core::Error{core::Errc::bad_input,
                         fmt::format("the part {} … {} along axis {} is not within {} voxels",
                                     box.begin[a], box.end[a], a, volume.geometry.dims[a])};
  if (!(spacing_m >= 1e-5 && spacing_m <= 1e-2))
    return core::Error{core::Errc::bad_input,
                       fmt::format("a spacing of {} mm is outside 0.01 … 10 mm", spacing_m * 1e3)};
  double voxels = 1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double source_m = volume.geometry.spacing_m[int(a)];
    voxels *= (box.end[a] - box.begin[a]) * source_m / std::min(source_m, spacing_m) + 1.0;
  }
  if (voxels > double(kMaxResampledVoxels))
    return core::Error{
        core::Errc::too_large,
        fmt::format(
            "{:.0f} voxels at a spacing of {} mm, at most {} are made: choose a wider spacing or a "
            "smaller part",
            voxels, spacing_m * 1e3, kMaxResampledVoxels)};
  return {};
}

}  // namespace

Box box_about(const Geometry& geometry, std::span<const Vec3> points_V_m, double margin_m) {
  core::require(!points_V_m.empty(), "a box is about at least one point");
  Box box;
  for (int a = 0; a < 3; ++a) {
    double low = 1e30, high = -1e30;
    for (const Vec3& p : points_V_m) {
      low = std::min(low, geometry.index_of(p)[a] - margin_m / geometry.spacing_m[a]);
      high = std::max(high, geometry.index_of(p)[a] + margin_m / geometry.spacing_m[a]);
    }
    const int last = geometry.dims[std::size_t(a)] - 1;
    box.begin[std::size_t(a)] = int(std::clamp(std::floor(low), 0.0, double(last)));
    box.end[std::size_t(a)] =
        1 + int(std::clamp(std::ceil(high), double(box.begin[std::size_t(a)]), double(last)));
  }
  return box;
}

core::Result<Volume> resample_finer(const Volume& volume, const Box& box, double spacing_m,
                                    const core::Progress& progress) {
  TRY(check(volume, box, spacing_m));
  const Geometry& source = volume.geometry;
  std::vector<Axis> axes;
  for (std::size_t a = 0; a < 3; ++a)
    axes.push_back(
        axis_of(box.begin[a], box.end[a], source.dims[a], source.spacing_m[int(a)], spacing_m));
  Volume out;
  out.slope = volume.slope;
  out.intercept = volume.intercept;
  out.geometry = source;
  out.geometry.origin_m = source.position_of(Vec3(box.begin[0], box.begin[1], box.begin[2]));
  for (std::size_t a = 0; a < 3; ++a) {
    out.geometry.dims[a] = int(axes[a].taps.size());
    out.geometry.spacing_m[int(a)] = axes[a].spacing_m;
  }
  const std::size_t area = axes[0].taps.size() * axes[1].taps.size();
  std::vector<std::vector<float>> slices(
      std::size_t(axes[2].count));  // made when first read, let go when passed
  out.counts.resize(out.geometry.voxel_count());
  for (std::size_t k = 0; k < axes[2].taps.size(); ++k) {
    const Tap& tap = axes[2].taps[k];
    for (const int at : tap.at)
      if (auto& slice = slices[std::size_t(at)]; slice.empty())
        slice = slice_of(volume, axes[0], axes[1], axes[2].first + at);
    const int oldest = *std::ranges::min_element(tap.at);
    for (int at = oldest - 1; at >= 0 && !slices[std::size_t(at)].empty(); --at)
      std::vector<float>().swap(slices[std::size_t(at)]);
    blend_slices(tap, slices, {&out.counts[k * area], area});
    if (progress && !progress(double(k + 1) / double(axes[2].taps.size())))
      return core::Error{core::Errc::cancelled, "resampling was stopped"};
  }
  return out;
}

}  // namespace volume
}  // namespace tractus
