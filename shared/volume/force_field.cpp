#include "volume/force_field.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/require.hpp"
#include "volume/blur.hpp"
#include "volume/force_field_grid.hpp"

namespace volume {
namespace {

constexpr std::size_t kMostVoxels = std::size_t(1) << 31;

/// The voxels whose blurred opacity depends on voxels of `changed`. Empty (begin ≥ end) when none
/// does.
Box reached_from(const Box& changed, const std::array<int, 3>& dims) {
  Box out;
  for (std::size_t a = 0; a < 3; ++a) {
    const int begin = std::max(changed.begin[a], 0), end = std::min(changed.end[a], dims[a]);
    if (begin >= end) return {};
    out.begin[a] = std::max(begin - kBlurReach, 0);
    out.end[a] = std::min(end + kBlurReach, dims[a]);
  }
  return out;
}

}  // namespace

ForceField::Grid::Grid(const Volume& volume, const TransferFunction& transfer,
                       FieldKind kind_of_field, ScalarGrid scalars)
    : geometry(volume.geometry),
      kind(kind_of_field),
      ramps(transfer, volume.slope, volume.intercept),
      blurred(std::move(scalars)),
      V_from_index(geometry.directions * geometry.spacing_m.cwiseInverse().asDiagonal()) {
  const Vec3 at_origin = -(V_from_index.transpose() * geometry.origin_m);
  for (int c = 0; c < 3; ++c) {
    const Vec3 g = -V_from_index.col(c), index = V_from_index.row(c);
    g_of[c] = {{g.x(), g.y(), g.z(), 0.0}};
    index_of[c] = {{index.x(), index.y(), index.z(), 0.0}};
  }
  index_at_origin = {{at_origin.x(), at_origin.y(), at_origin.z(), 0.0}};
}

ForceField::ForceField(std::unique_ptr<Grid> grid) : grid_(std::move(grid)) {}
ForceField::~ForceField() = default;
ForceField::ForceField(ForceField&&) noexcept = default;
ForceField& ForceField::operator=(ForceField&&) noexcept = default;

core::Result<ForceField> ForceField::make(const Volume& volume, const TransferFunction& transfer,
                                          FieldKind kind, const core::Progress& progress) {
  const auto& dims = volume.geometry.dims;
  core::require(dims[0] > 0 && dims[1] > 0 && dims[2] > 0 &&
                    volume.counts.size() == volume.geometry.voxel_count(),
                "a volume holds as many counts as its dimensions say, and at least one");
  if (volume.geometry.voxel_count() > kMostVoxels)
    return core::Error{core::Errc::too_large,
                       fmt::format("force field: a volume of {} voxels, at most {} are allowed",
                                   volume.geometry.voxel_count(), kMostVoxels)};
  auto scalars = ScalarGrid::make(dims);
  if (!scalars)
    return core::Error{
        core::Errc::too_large,
        fmt::format(
            "force field: {} bytes of memory are needed for a volume of {} × {} × {} voxels",
            ScalarGrid::bytes_for(dims), dims[0], dims[1], dims[2])};
  auto grid = std::make_unique<Grid>(volume, transfer, kind, std::move(*scalars));
  if (!blur(volume, grid->ramps, {{0, 0, 0}, dims}, progress, grid->blurred))
    return core::Error{core::Errc::cancelled, "force field: stopped"};
  return ForceField(std::move(grid));
}

void ForceField::update(const Volume& volume, const Box& changed) noexcept {
  core::require(volume.geometry.dims == grid_->geometry.dims,
                "a field is updated from the volume it was made of");
  const Box reached = reached_from(changed, grid_->geometry.dims);
  if (reached.begin[0] < reached.end[0]) blur(volume, grid_->ramps, reached, {}, grid_->blurred);
}

FieldKind ForceField::kind() const noexcept { return grid_->kind; }
const Geometry& ForceField::geometry() const noexcept { return grid_->geometry; }

}  // namespace volume
