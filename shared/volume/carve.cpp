#include "volume/carve.hpp"

#include <algorithm>
#include <cmath>

#include "volume/resample.hpp"

namespace tractus {
namespace volume {
namespace {

/// Signed distance to what the drill removes, m, negative inside; outside corners it is less than
/// the true distance.
class Shape {
 public:
  Shape(const Tract& tract, double mouth_m, const std::optional<Breach>& breach)
      : tract_(tract), mouth_m_(mouth_m) {
    if (!breach) return;
    const Vec3 reach = breach->tip_m - breach->from_m;
    const double straight_m = std::max(reach.norm() - tract.radius_m, 0.0);
    from_ = breach->from_m;
    to_ = breach->from_m + straight_m * reach.normalized();  // the rounded tip ends at tip_m
    breached_ = true;
  }

  double distance_m(const Vec3& p) const {
    const double depth = tract_.depth_of(p);
    const double off_axis = (p - tract_.entry_m - depth * tract_.axis).norm();
    const double channel =
        std::max({off_axis - tract_.radius_m, depth - tract_.length_m, -mouth_m_ - depth});
    return breached_ ? std::min(channel, capsule_m(p)) : channel;
  }

  /// Points whose surroundings (by the radius) hold the shape.
  std::vector<Vec3> spine() const {
    std::vector<Vec3> points{tract_.entry_m - mouth_m_ * tract_.axis, tract_.end_m()};
    if (breached_) points.insert(points.end(), {from_, to_});
    return points;
  }

 private:
  double capsule_m(const Vec3& p) const {
    const Vec3 line = to_ - from_;
    const double length2 = line.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp((p - from_).dot(line) / length2, 0.0, 1.0) : 0.0;
    return (p - from_ - t * line).norm() - tract_.radius_m;
  }
  const Tract& tract_;
  double mouth_m_;
  bool breached_ = false;
  Vec3 from_ = Vec3::Zero(), to_ = Vec3::Zero();
};

/// Which share of a voxel about `centre` lies in the shape: the mean over 3³ parts, each cut by its
/// nearest face.
double share_inside(const Shape& shape, const Geometry& geometry, const Vec3& centre) {
  const double d = shape.distance_m(centre), reach = geometry.spacing_m.norm() / 2;
  if (d <= -reach) return 1.0;
  if (d >= reach) return 0.0;
  const double part_m = geometry.spacing_m.mean() / 3.0;
  double sum = 0.0;
  for (int part = 0; part < 27; ++part) {
    const Vec3 offset(part % 3 - 1, part / 3 % 3 - 1, part / 9 - 1);
    const Vec3 p = centre + geometry.directions * offset.cwiseProduct(geometry.spacing_m) / 3.0;
    sum += std::clamp(0.5 - shape.distance_m(p) / part_m, 0.0, 1.0);
  }
  return sum / 27.0;
}

Box box_of(const Geometry& geometry, const Tract& tract, const std::vector<Vec3>& spine) {
  return box_about(geometry, spine, tract.radius_m + geometry.spacing_m.norm());
}

void drill_within(const Box& box, const Shape& shape, double empty, Volume& volume) {
  const Geometry& geometry = volume.geometry;
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j)
      for (int i = box.begin[0]; i < box.end[0]; ++i) {
        const double share = share_inside(shape, geometry, geometry.position_of(Vec3(i, j, k)));
        const double before = volume.value(i, j, k);
        if (share == 0.0 || before <= empty) continue;
        volume.counts[volume.offset(i, j, k)] = volume.count_of(before + share * (empty - before));
      }
}

}  // namespace

core::Result<double> empty_value(const Volume& volume, const TransferFunction& transfer) {
  const auto& points = transfer.points();
  const bool water =
      transfer.opacity(0.0) == 0.0 && std::ranges::all_of(points, [](const auto& point) {
        return point.value > 0.0 || point.opacity == 0.0;
      });
  const double value = water ? 0.0 : points.front().value;
  const double held = volume.intercept + volume.slope * volume.count_of(value);
  if (points.front().opacity != 0.0 || transfer.opacity(held) != 0.0)
    return core::Error{
        core::Errc::out_of_range,
        "no CT value of this volume is without opacity: nothing can be drilled away"};
  return value;
}

Box drill(Volume& volume, const Tract& tract, double mouth_m, const std::optional<Breach>& breach,
          double empty) {
  const Shape shape(tract, mouth_m, breach);
  const Box box = box_of(volume.geometry, tract, shape.spine());
  drill_within(box, shape, empty, volume);
  return box;
}

Box redrill(Volume& drilled, const Volume& bone, const Tract& tract, double mouth_m,
            const Breach& breach, bool breached, double empty) {
  const Box box = box_of(drilled.geometry, tract, {breach.from_m, breach.tip_m});
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j) {
      const auto from = std::ptrdiff_t(bone.offset(box.begin[0], j, k));
      std::copy_n(bone.counts.begin() + from, box.end[0] - box.begin[0],
                  drilled.counts.begin() + from);
    }
  const Shape shape(tract, mouth_m, breached ? std::optional(breach) : std::nullopt);
  drill_within(box, shape, empty, drilled);
  return box;
}

}  // namespace volume
}  // namespace tractus
