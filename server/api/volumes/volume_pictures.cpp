#include "server/api/volumes/volume_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/try.hpp"

namespace tractus {
namespace api {
namespace {

using volume::Vec3;

char grey(double value, const Window& window) {
  const double share = (value - window.low) / (window.high - window.low);
  return static_cast<char>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

struct Axes {
  int normal;
  Vec3 along_row, along_column;
};

Axes axes_of(Plane plane) {
  if (plane == Plane::axial) return {2, Vec3::UnitX(), Vec3::UnitY()};
  if (plane == Plane::coronal) return {1, Vec3::UnitX(), -Vec3::UnitZ()};
  return {0, Vec3::UnitY(), -Vec3::UnitZ()};
}

/// Where the picture's pixels lie.
SlicePicture frame_of(const Bounds& bounds, const Axes& axes, double at_m, double finest_m,
                      int max_side) {
  const Vec3 extent = bounds.high_m - bounds.low_m;
  const double wide = std::abs(extent.dot(axes.along_row)),
               high = std::abs(extent.dot(axes.along_column));
  SlicePicture out;
  out.spacing_m = std::max(finest_m, std::max(wide, high) / std::max(1, max_side - 1));
  out.dims = {static_cast<int>(wide / out.spacing_m + 1e-9) + 1,
              static_cast<int>(high / out.spacing_m + 1e-9) + 1};
  out.along_row = axes.along_row;
  out.along_column = axes.along_column;
  for (int a = 0; a < 3; ++a)
    out.origin_m[a] =
        axes.along_row[a] + axes.along_column[a] < 0.0 ? bounds.high_m[a] : bounds.low_m[a];
  out.origin_m[axes.normal] = at_m;
  return out;
}

/// The box of voxels that a picture's pixels lie between; nothing when they miss the volume.
std::optional<volume::Box> box_under(const SlicePicture& picture, const volume::Geometry& g) {
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (const int row : {0, picture.dims[1] - 1})
    for (const int column : {0, picture.dims[0] - 1}) {
      const Vec3 at =
          g.index_of(picture.origin_m +
                     picture.spacing_m * (column * picture.along_row + row * picture.along_column));
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
  volume::Box box;
  constexpr double kSlack = 1e-6;  // of a voxel: rounding of the bounds
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double top = g.dims[a] - 1;
    if (high[axis] < -kSlack || low[axis] > top + kSlack) return std::nullopt;
    box.begin[a] = static_cast<int>(std::clamp(std::floor(low[axis]), 0.0, top));
    box.end[a] = static_cast<int>(std::clamp(std::ceil(high[axis]), 0.0, top)) + 1;
  }
  return box;
}

}  // namespace

Bounds bounds_of(const volume::Geometry& g) {
  Bounds out{Vec3::Constant(INFINITY), Vec3::Constant(-INFINITY)};
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at =
        g.position_of(Vec3((corner & 1) ? g.dims[0] - 1 : 0, (corner & 2) ? g.dims[1] - 1 : 0,
                           (corner & 4) ? g.dims[2] - 1 : 0));
    out.low_m = out.low_m.cwiseMin(at);
    out.high_m = out.high_m.cwiseMax(at);
  }
  return out;
}

core::Result<SlicePicture> slice_picture(const volume::VolumeFile& file, Plane plane, double at_m,
                                         int max_side, const Window& window) {
  const volume::Geometry& g = file.geometry();
  const Axes axes = axes_of(plane);
  const Bounds bounds = bounds_of(g);
  SlicePicture out = frame_of(bounds, axes, at_m, g.spacing_m.minCoeff(), max_side);
  const auto box = box_under(out, g);
  if (!box)
    return core::Error{core::Errc::out_of_range,
                       fmt::format("at_m: {} is outside the volume, from {} to {}", at_m,
                                   bounds.low_m[axes.normal], bounds.high_m[axes.normal])};
  auto slab = TRY(file.read_box(*box));
  out.pixels.reserve(std::size_t(out.dims[0]) * std::size_t(out.dims[1]));
  constexpr double kSlack = 1e-6;
  for (int row = 0; row < out.dims[1]; ++row)
    for (int column = 0; column < out.dims[0]; ++column) {
      const Vec3 at =
          out.origin_m + out.spacing_m * (column * out.along_row + row * out.along_column);
      const Vec3 index = g.index_of(at);
      bool inside = true;
      for (std::size_t a = 0; a < 3; ++a) {
        const double i = index[static_cast<Eigen::Index>(a)];
        inside = inside && i >= -kSlack && i <= g.dims[a] - 1 + kSlack;
      }
      out.pixels.push_back(inside ? grey(slab.value_at(at), window) : '\0');
    }
  return out;
}

core::Result<Preview> whole_preview(const volume::VolumeFile& file, int max_side,
                                    const Window& window) {
  const volume::Geometry& g = file.geometry();
  const int longest = *std::ranges::max_element(g.dims);
  const int step = (longest + max_side - 1) / max_side;
  const int thick = std::max(1, volume::kBrickEdge / step) * step;  // whole blocks
  Preview out;
  out.geometry = g;
  for (std::size_t a = 0; a < 3; ++a) out.geometry.dims[a] = (g.dims[a] + step - 1) / step;
  out.geometry.spacing_m = g.spacing_m * step;
  out.geometry.origin_m = g.position_of(Vec3::Constant(0.5 * (step - 1)));
  for (int k = 0; k < g.dims[2]; k += thick) {
    auto slab =
        TRY(file.read_box({{0, 0, k}, {g.dims[0], g.dims[1], std::min(k + thick, g.dims[2])}}));
    std::vector<float> shares(slab.counts.size());
    std::ranges::transform(slab.counts, shares.begin(), [&](std::uint16_t count) {
      const double value = slab.intercept + slab.slope * count;
      return static_cast<float>(
          std::clamp((value - window.low) / (window.high - window.low), 0.0, 1.0));
    });
    out.opacity += averaged(slab, shares, step).opacity;
  }
  return out;
}

}  // namespace api
}  // namespace tractus
