#include "volume/force_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "core/require.hpp"
#include "core/try.hpp"
#include "volume/blur.hpp"
#include "volume/force_field_grid.hpp"

namespace tractus {
namespace volume {
namespace {

constexpr std::size_t kMostVoxels = std::size_t(1) << 31;
constexpr int kRow = 8;            // floats written together along a row
constexpr std::size_t kLine = 16;  // floats of a cache line

int down(int n) { return n / kRow * kRow; }
int up(int n) { return (n + kRow - 1) / kRow * kRow; }

std::size_t voxels_of(const Box& box) {
  std::size_t out = 1;
  for (std::size_t a = 0; a < 3; ++a) out *= std::size_t(std::max(box.end[a] - box.begin[a], 0));
  return out;
}

core::Result<ScalarGrid> room_for(const Geometry& geometry, ScalarGrid::Use use) {
  const auto& dims = geometry.dims;
  if (geometry.voxel_count() > kMostVoxels)
    return core::Error{core::Errc::too_large,
                       fmt::format("force field: a volume of {} voxels, at most {} are allowed",
                                   geometry.voxel_count(), kMostVoxels)};
  auto scalars = ScalarGrid::make(dims, use);
  if (!scalars)
    return core::Error{
        core::Errc::too_large,
        fmt::format(
            "force field: {} bytes of memory are needed for a volume of {} × {} × {} voxels",
            ScalarGrid::bytes_for(dims), dims[0], dims[1], dims[2])};
  return std::move(*scalars);
}

}  // namespace

ForceField::Grid::Grid(const Geometry& of_volume, FieldKind kind_of_field, const Box& part,
                       ScalarGrid scalars)
    : geometry(of_volume),
      kind(kind_of_field),
      blurred(std::move(scalars)),
      V_from_index(geometry.directions * geometry.spacing_m.cwiseInverse().asDiagonal()),
      known_begin{part.begin[0], part.begin[1], part.begin[2], 0},
      known_end{part.end[0], part.end[1], part.end[2], 1 << 20} {
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
  auto scalars = TRY(room_for(volume.geometry, ScalarGrid::Use::whole));
  const Box whole{{0, 0, 0}, dims};
  auto grid = std::make_unique<Grid>(volume.geometry, kind, whole, std::move(scalars));
  grid->ramps.emplace(transfer, volume.slope, volume.intercept);
  if (!blur(volume, *grid->ramps, whole, progress, grid->blurred))
    return core::Error{core::Errc::cancelled, "force field: stopped"};
  return ForceField(std::move(grid));
}

core::Result<ForceField> ForceField::make(const StoredOpacity& part, FieldKind kind) {
  const auto& [begin, end] = part.box;
  const auto& dims = part.geometry.dims;
  bool inside = true;
  for (std::size_t a = 0; a < 3; ++a)
    inside = inside && 0 <= begin[a] && begin[a] < end[a] && end[a] <= dims[a];
  if (!inside || part.opacity.size() != voxels_of(part.box))
    return core::Error{
        core::Errc::bad_input,
        fmt::format("force field: {} opacities of voxels ({}, {}, {}) to ({}, {}, {}) of a volume "
                    "of {} × {} × {}",
                    part.opacity.size(), begin[0], begin[1], begin[2], end[0], end[1], end[2],
                    dims[0], dims[1], dims[2])};
  auto scalars = TRY(room_for(part.geometry, ScalarGrid::Use::a_part));
  auto grid = std::make_unique<Grid>(part.geometry, kind, part.box, std::move(scalars));
  const float* from = part.opacity.data();
  const std::ptrdiff_t width = end[0] - begin[0];
  for (int k = begin[2]; k < end[2]; ++k)
    for (int j = begin[1]; j < end[1]; ++j, from += width)
      std::copy_n(from, width, grid->blurred.row(j, k) + begin[0]);
  return ForceField(std::move(grid));
}

StoredOpacity ForceField::stored(const Box& box) const {
  StoredOpacity out{grid_->geometry, box, {}};
  out.opacity.reserve(voxels_of(box));
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j) {
      const float* const row = grid_->blurred.row(j, k);
      out.opacity.insert(out.opacity.end(), row + box.begin[0], row + box.end[0]);
    }
  return out;
}

bool ForceField::left_part() const noexcept { return grid_->left_part.exchange(false); }

void ForceField::update(const Volume& volume, const Box& changed) noexcept {
  core::require(volume.geometry.dims == grid_->geometry.dims,
                "a field is updated from the volume it was made of");
  const Box reached = FieldPatch::reached(changed, grid_->geometry.dims);
  core::require(grid_->ramps.has_value(), "a field of a part is not updated");
  if (reached.begin[0] < reached.end[0]) blur(volume, *grid_->ramps, reached, {}, grid_->blurred);
}

FieldPatch::FieldPatch(std::size_t most_voxels)
    : room_(most_voxels), memory_(new float[most_voxels + kLine]()) {
  void* at = memory_.get();
  std::size_t space = (most_voxels + kLine) * sizeof(float);
  first_ = static_cast<float*>(
      std::align(kLine * sizeof(float), most_voxels * sizeof(float), at, space));
}
FieldPatch::~FieldPatch() = default;
FieldPatch::FieldPatch(FieldPatch&&) noexcept = default;
FieldPatch& FieldPatch::operator=(FieldPatch&&) noexcept = default;

Box FieldPatch::reached(const Box& changed, const std::array<int, 3>& dims) noexcept {
  Box out;
  for (std::size_t a = 0; a < 3; ++a) {
    const int begin = std::max(changed.begin[a], 0), end = std::min(changed.end[a], dims[a]);
    if (begin >= end) return {};
    out.begin[a] = std::max(begin - kBlurReach, 0);
    out.end[a] = std::min(end + kBlurReach, dims[a]);
  }
  return out;
}

std::size_t FieldPatch::floats_for(const Box& changed, const std::array<int, 3>& dims) noexcept {
  const Box box = reached(changed, dims);
  return std::size_t(up(box.end[0]) - down(box.begin[0])) * std::size_t(box.end[1] - box.begin[1]) *
         std::size_t(box.end[2] - box.begin[2]);
}

void ForceField::compute(const Volume& volume, const Box& changed, FieldPatch& out) const noexcept {
  const auto& dims = grid_->geometry.dims;
  core::require(volume.geometry.dims == dims, "a patch is computed from the field's own volume");
  core::require(grid_->ramps.has_value(), "a field of a part is not updated");
  core::require(FieldPatch::floats_for(changed, dims) <= out.room_,
                "a patch has room for what it is asked to hold");
  out.box_ = FieldPatch::reached(changed, dims);
  if (out.box_.begin[0] >= out.box_.end[0]) return;
  out.begin_ = {down(out.box_.begin[0]), out.box_.begin[1], out.box_.begin[2]};
  out.row_pitch_ = up(out.box_.end[0]) - out.begin_[0];
  const std::ptrdiff_t slice = out.row_pitch_ * (out.box_.end[1] - out.begin_[1]);
  blur(volume, *grid_->ramps, out.box_, {out.first_, out.begin_, out.row_pitch_, slice});
}

void ForceField::apply(const FieldPatch& patch) noexcept {
  const Box& box = patch.box_;
  const auto bytes = std::size_t(std::max(box.end[0] - box.begin[0], 0)) * sizeof(float);
  const float* from = patch.first_ + (box.begin[0] - patch.begin_[0]);
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j, from += patch.row_pitch_)
      std::memcpy(grid_->blurred.row(j, k) + box.begin[0], from, bytes);
}

FieldKind ForceField::kind() const noexcept { return grid_->kind; }
const Geometry& ForceField::geometry() const noexcept { return grid_->geometry; }

}  // namespace volume
}  // namespace tractus
