#include "drilling/channel.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "volume/carve.hpp"

namespace tractus {
namespace drilling {
namespace {

using core::Json;
using math::Mat3;
using math::Vec2;
using math::Vec3;
using volume::Wall;

constexpr double kOfIt = 0.5;      // share lost
constexpr double kEach_m = 0.001;  // along the tract, where walls are looked for
constexpr double kEnclosed_m = 0.012, kPastEntry_m = 0.005;  // as WallFinder::thinnest has it
constexpr int kDirections = 48;                              // of an outline
constexpr std::size_t kLeastOutline = 36;  // of them with a wall, else there is no outline
constexpr double kSlender = 3.0;           // length over width from which there is a direction

struct Lost {
  Vec3 at_m;
  double share;
};

std::vector<Lost> lost_voxels(const Erosion& erosion) {
  std::vector<Lost> out;
  const auto& box = erosion.worn();
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j)
      for (int i = box.begin[0]; i < box.end[0]; ++i)
        if (const double share = erosion.lost(i, j, k); share >= kOfIt)
          out.push_back({erosion.bone().geometry.position_of(Vec3(i, j, k)), share});
  return out;
}

void set_axis(const std::vector<Lost>& voxels, const volume::Tract& tract, PilotHole& out) {
  double sum = 0.0;
  Vec3 mean = Vec3::Zero();
  for (const Lost& v : voxels) sum += v.share, mean += v.share * v.at_m;
  mean /= sum;
  Mat3 spread = Mat3::Zero();
  for (const Lost& v : voxels)
    spread += v.share / sum * (v.at_m - mean) * (v.at_m - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(spread);  // ascending
  if (!(std::sqrt(axes.eigenvalues()[2]) > kSlender * std::sqrt(axes.eigenvalues()[1]))) return;
  Vec3 axis = axes.eigenvectors().col(2);
  if (axis.dot(tract.axis) < 0.0) axis = -axis;
  const double along = axis.dot(tract.axis);
  if (along < 0.5) return;  // across the tract: it has no entry there
  out.angle_rad = std::atan2(axis.cross(tract.axis).norm(), along);
  out.entry_offset_m = tract.offset_of(mean - tract.depth_of(mean) / along * axis);
}

/// Outer faces of the side walls by depth, and of the anterior wall. Side walls hold where the bone
/// encloses the tract: all four begin within kEnclosed_m, from kPastEntry_m behind the first such
/// place.
class Faces {
 public:
  Faces(const volume::Volume& bone, const volume::TransferFunction& transfer,
        const volume::Tract& tract)
      : tract_(tract) {
    const volume::WallFinder finder(bone, transfer);
    std::optional<double> enclosed_from_m;
    for (double at_m = 0.0; at_m <= tract.length_m; at_m += kEach_m) {
      auto section = section_at(finder, at_m);
      if (section && !enclosed_from_m) enclosed_from_m = at_m;
      if (section && at_m < *enclosed_from_m + kPastEntry_m) section.reset();
      sections_.push_back(section);
    }
    if (const auto found = finder.wall_at(tract, Wall::anterior, tract.length_m); found)
      anterior_m_ = found->outer_m;
  }

  /// Depths with four known side walls.
  std::vector<double> known_m() const {
    std::vector<double> out;
    for (std::size_t i = 0; i < sections_.size(); ++i)
      if (sections_[i]) out.push_back(double(i) * kEach_m);
    return out;
  }

  void meet(const Vec3& at_m, PilotHole& out) const {
    const double depth_m = tract_.depth_of(at_m);
    const Vec2 offset = tract_.offset_of(at_m);
    if (depth_m < 0.0) return;
    if (depth_m > tract_.length_m) {
      if (anterior_m_ && offset.norm() <= tract_.radius_m)
        note(Wall::anterior, depth_m - tract_.length_m - *anterior_m_, out);
      return;
    }
    const Wall wall = volume::Tract::side_of(offset);
    const bool across = wall == Wall::medial || wall == Wall::lateral;
    if (std::abs(across ? offset.y() : offset.x()) > tract_.radius_m) return;  // no ray went there
    const auto slice = std::min(std::size_t(std::lround(depth_m / kEach_m)), sections_.size() - 1);
    if (const auto& section = sections_[slice])
      note(wall, std::abs(across ? offset.x() : offset.y()) - (*section)[std::size_t(wall)], out);
  }

 private:
  using Section = std::array<double, 4>;  // outer faces in the order of volume::kWalls
  std::optional<Section> section_at(const volume::WallFinder& finder, double at_m) const {
    Section section{};
    for (std::size_t side = 0; side < section.size(); ++side) {
      const auto found = finder.wall_at(tract_, volume::kWalls[side], at_m);
      if (!found || found->inner_m > kEnclosed_m) return std::nullopt;
      section[side] = found->outer_m;
    }
    return section;
  }
  static void note(Wall wall, double beyond_m, PilotHole& out) {
    auto& most = out.beyond_m[std::size_t(wall)];
    most = std::max(most.value_or(beyond_m), beyond_m);
  }
  const volume::Tract& tract_;
  std::vector<std::optional<Section>> sections_;
  std::optional<double> anterior_m_;
};

/// The cortex's outer face about the tract at a depth; empty where too much of it is not known.
std::vector<Vec2> outline_at(const volume::WallFinder& finder, const volume::Tract& tract,
                             double depth_m) {
  std::vector<Vec2> out;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kDirections;
    const auto found = finder.wall_towards(tract, angle, depth_m);
    if (found && found->inner_m <= kEnclosed_m)
      out.push_back(found->outer_m * Vec2(std::cos(angle), std::sin(angle)));
  }
  return out.size() < kLeastOutline ? std::vector<Vec2>() : out;
}

Vec2 nearest_on(const Vec2& from, const Vec2& to, const Vec2& point) {
  const Vec2 side = to - from;
  const double length2 = side.squaredNorm();
  const double along =
      length2 > 0.0 ? std::clamp((point - from).dot(side) / length2, 0.0, 1.0) : 0.0;
  return from + along * side;
}

struct Beyond {
  double by_m;    ///< negative within
  Vec2 cortex_m;  ///< the nearest point of the outline
};

Beyond beyond(const std::vector<Vec2>& outline, const Vec2& point) {
  double nearest_m = std::numeric_limits<double>::infinity();
  Vec2 cortex = point;
  bool within = false;  // by the sides that a line from the point towards medial crosses
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const Vec2 on = nearest_on(a, b, point);
    if ((on - point).norm() < nearest_m) nearest_m = (on - point).norm(), cortex = on;
    if ((a.y() > point.y()) != (b.y() > point.y()) &&
        point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      within = !within;
  }
  return {within ? -nearest_m : nearest_m, cortex};
}

/// The channel's voxels within half a step of a depth against the outline there.
std::optional<CrossSection> section_of(const std::vector<Vec2>& channel, std::vector<Vec2> outline,
                                       double depth_m, double voxel_m3) {
  if (channel.empty() || outline.empty()) return std::nullopt;
  CrossSection out;
  out.depth_m = depth_m;
  out.beyond_m = -std::numeric_limits<double>::infinity();
  for (const Vec2& point : channel) {
    out.centre_m += point / double(channel.size());
    const Beyond found = beyond(outline, point);
    if (found.by_m <= out.beyond_m) continue;
    out.beyond_m = found.by_m, out.cortex_m = found.cortex_m, out.farthest_m = point;
  }
  out.radius_m = std::sqrt(double(channel.size()) * voxel_m3 / kEach_m / std::numbers::pi);
  out.outline_m = std::move(outline);
  return out;
}

std::optional<CrossSection> worst_section(const std::vector<Lost>& voxels, const Erosion& erosion,
                                          const volume::TransferFunction& transfer,
                                          const volume::Tract& tract,
                                          const std::vector<double>& depths_m) {
  const volume::WallFinder finder(erosion.bone(), transfer);
  std::optional<CrossSection> out;
  for (const double depth_m : depths_m) {
    std::vector<Vec2> channel;
    for (const Lost& voxel : voxels)
      if (std::abs(tract.depth_of(voxel.at_m) - depth_m) <= kEach_m / 2.0)
        channel.push_back(tract.offset_of(voxel.at_m));
    if (channel.empty()) continue;
    auto section = section_of(channel, outline_at(finder, tract, depth_m), depth_m,
                              erosion.bone().geometry.spacing_m.prod());
    if (section && (!out || section->beyond_m > out->beyond_m)) out = std::move(section);
  }
  return out;
}

/// To the micrometre.
Json rounded(double value_m) { return std::round(value_m * 1e6) / 1e6; }
Json rounded(const Vec2& at_m) { return Json::array({rounded(at_m.x()), rounded(at_m.y())}); }

Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

}  // namespace

Json CrossSection::to_json() const {
  Json outline = Json::array();
  for (const Vec2& point : outline_m) outline.push_back(rounded(point));
  return {{"depth_m", rounded(depth_m)},     {"beyond_m", rounded(beyond_m)},
          {"cortex_m", rounded(cortex_m)},   {"farthest_m", rounded(farthest_m)},
          {"outline_m", std::move(outline)}, {"centre_m", rounded(centre_m)},
          {"radius_m", rounded(radius_m)}};
}

Json PilotHole::to_json() const {
  Json walls = Json::object();
  for (const Wall wall : volume::kWalls)
    walls[std::string(volume::name(wall))] = json_of(beyond_m[std::size_t(wall)]);
  return {{"voxels", voxels},
          {"entry_offset_m",
           entry_offset_m ? Json::array({entry_offset_m->x(), entry_offset_m->y()}) : Json()},
          {"angle_rad", json_of(angle_rad)},
          {"depth_m", json_of(depth_m)},
          {"beyond_m", std::move(walls)},
          {"worst", worst ? worst->to_json() : Json()}};
}

PilotHole channel_of(const Erosion& erosion, const volume::TransferFunction& transfer,
                     const volume::Tract& tract) {
  PilotHole out;
  const std::vector<Lost> voxels = lost_voxels(erosion);
  out.voxels = voxels.size();
  if (voxels.empty()) return out;
  set_axis(voxels, tract, out);
  const Faces faces(erosion.bone(), transfer, tract);
  for (const Lost& voxel : voxels) {
    const double depth_m = tract.depth_of(voxel.at_m);
    out.depth_m = std::max(out.depth_m.value_or(depth_m), depth_m);
    faces.meet(voxel.at_m, out);
  }
  out.worst = worst_section(voxels, erosion, transfer, tract, faces.known_m());
  return out;
}

}  // namespace drilling
}  // namespace tractus
