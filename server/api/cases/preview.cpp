#include "server/api/cases/preview.hpp"

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "server/api/backend.hpp"
#include "server/jobs/case_facts.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::size_t kMaxVoxels = 64u << 20;

/// Voxels whose centres may lie within the margin of the tract's axis, as a box that is not empty.
volume::Box box_round(const volume::Tract& tract, const volume::Geometry& geometry) {
  const double reach = tract.radius_m + kMargin_m;
  volume::Box box;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double first = geometry.index_of(tract.entry_m)[axis];
    const double last = geometry.index_of(tract.end_m())[axis];
    const double slack = reach / geometry.spacing_m[axis];
    const double top = geometry.dims[a] - 1;
    box.begin[a] =
        static_cast<int>(std::clamp(std::floor(std::min(first, last) - slack), 0.0, top));
    box.end[a] =
        static_cast<int>(std::clamp(std::ceil(std::max(first, last) + slack), 0.0, top)) + 1;
  }
  return box;
}

std::vector<float> opacity_of(const volume::Volume& box, const volume::TransferFunction& transfer) {
  std::vector<float> table(65536);
  for (std::size_t count = 0; count < table.size(); ++count)
    table[count] = static_cast<float>(
        transfer.opacity(box.intercept + box.slope * static_cast<double>(count)));
  std::vector<float> out(box.counts.size());
  std::ranges::transform(box.counts, out.begin(),
                         [&](std::uint16_t count) { return table[count]; });
  return out;
}

/// Mean over one block, cut at the box's edge.
double block_mean(const volume::Volume& box, const std::vector<float>& opacity,
                  std::array<int, 3> at, int step) {
  std::array<int, 3> end{};
  for (std::size_t a = 0; a < 3; ++a) end[a] = std::min(at[a] + step, box.geometry.dims[a]);
  double sum = 0.0;
  for (int k = at[2]; k < end[2]; ++k)
    for (int j = at[1]; j < end[1]; ++j)
      for (int i = at[0]; i < end[0]; ++i) sum += static_cast<double>(opacity[box.offset(i, j, k)]);
  return sum / ((end[0] - at[0]) * (end[1] - at[1]) * (end[2] - at[2]));
}

core::Result<volume::VolumeFile> volume_of(Backend& backend, const std::string& case_id,
                                           const cases::Case& definition) {
  const auto is_volume = [](const cases::Part& part) { return part.name.ends_with(".tvol"); };
  const auto part = std::ranges::find_if(definition.parts, is_volume);
  if (part == definition.parts.end())
    return core::Error{core::Errc::not_found, "case " + case_id + " has no volume"};
  return volume::VolumeFile::open(TRY(backend.objects.file(part->sha256)));
}

}  // namespace

Preview averaged(const volume::Volume& box, const std::vector<float>& opacity, int step) {
  Preview out;
  const auto& fine = box.geometry;
  auto& coarse = out.geometry;
  coarse = fine;
  for (std::size_t a = 0; a < 3; ++a) coarse.dims[a] = (fine.dims[a] + step - 1) / step;
  coarse.spacing_m = fine.spacing_m * step;
  coarse.origin_m =
      fine.position_of(math::Vec3::Constant(0.5 * (step - 1)));  // centre of the first block
  out.opacity.reserve(coarse.voxel_count());
  for (int k = 0; k < fine.dims[2]; k += step)
    for (int j = 0; j < fine.dims[1]; j += step)
      for (int i = 0; i < fine.dims[0]; i += step)
        out.opacity.push_back(
            static_cast<char>(std::lround(255.0 * block_mean(box, opacity, {i, j, k}, step))));
  return out;
}

core::Result<Preview> case_preview(Backend& backend, const std::string& case_id, int max_side) {
  auto facts = TRY(jobs::case_facts(backend.store, backend.objects, case_id));
  auto file = TRY(volume_of(backend, case_id, facts.definition));
  const volume::Box box = box_round(facts.definition.tract, file.geometry());
  std::size_t voxels = 1;
  int longest = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    voxels *= static_cast<std::size_t>(box.end[a] - box.begin[a]);
    longest = std::max(longest, box.end[a] - box.begin[a]);
  }
  if (voxels > kMaxVoxels)
    return core::Error{core::Errc::too_large,
                       "the volume has too many voxels around its tract for a preview"};
  auto read = TRY(file.read_box(box));
  const int step = (longest + max_side - 1) / max_side;
  return averaged(read, opacity_of(read, facts.definition.model.transfer), step);
}

}  // namespace api
}  // namespace tractus
