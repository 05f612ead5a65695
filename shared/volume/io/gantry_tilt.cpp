#include "volume/io/gantry_tilt.hpp"

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace volume_io {
using volume::Vec3;
using volume::Volume;
namespace {

/// One axis of the plane: how far slices move along it, in voxels.
struct Axis {
  double per_slice;  ///< shift from slice to slice
  int grown;         ///< voxels added
  double first;      ///< shift of the new grid's first voxel
};

Axis axis_of(double shear_m, double spacing_m, int slices) {
  const double per_slice = shear_m / spacing_m;
  const double last = per_slice * (slices - 1);
  return {per_slice, static_cast<int>(std::ceil(std::abs(last) - 1e-9)), std::min(0.0, last)};
}

/// A slice's value between its pixels, or 0 outside of them.
double sample(const Volume& v, double x, double y, int k) {
  const auto& dims = v.geometry.dims;
  if (!(x > -0.5 && y > -0.5 && x < dims[0] - 0.5 && y < dims[1] - 0.5)) return 0.0;
  x = std::clamp(x, 0.0, dims[0] - 1.0);
  y = std::clamp(y, 0.0, dims[1] - 1.0);
  const int i = std::min(static_cast<int>(x), std::max(dims[0] - 2, 0)),
            j = std::min(static_cast<int>(y), std::max(dims[1] - 2, 0));
  const int i1 = std::min(i + 1, dims[0] - 1), j1 = std::min(j + 1, dims[1] - 1);
  const double u = x - i, w = y - j;
  return (1 - w) * ((1 - u) * v.counts[v.offset(i, j, k)] + u * v.counts[v.offset(i1, j, k)]) +
         w * ((1 - u) * v.counts[v.offset(i, j1, k)] + u * v.counts[v.offset(i1, j1, k)]);
}

}  // namespace

core::Result<Volume> correct_gantry_tilt(const Volume& tilted, const Vec3& shear_m,
                                         const std::string& where) {
  const auto& g = tilted.geometry;
  const Vec3 in_plane = g.directions.transpose() * shear_m;
  const Axis x = axis_of(in_plane.x(), g.spacing_m.x(), g.dims[2]);
  const Axis y = axis_of(in_plane.y(), g.spacing_m.y(), g.dims[2]);
  Volume out{g, tilted.slope, tilted.intercept, {}};
  out.geometry.dims[0] += x.grown;
  out.geometry.dims[1] += y.grown;
  out.geometry.origin_m = g.position_of({x.first, y.first, 0.0});
  TRY(volume::check_geometry(out.geometry, where));
  out.counts.reserve(out.geometry.voxel_count());
  for (int k = 0; k < g.dims[2]; ++k)
    for (int j = 0; j < out.geometry.dims[1]; ++j)
      for (int i = 0; i < out.geometry.dims[0]; ++i)
        out.counts.push_back(static_cast<std::uint16_t>(std::lround(
            sample(tilted, i + x.first - k * x.per_slice, j + y.first - k * y.per_slice, k))));
  return out;
}

}  // namespace volume_io
}  // namespace tractus
