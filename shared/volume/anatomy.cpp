#include "volume/anatomy.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace tractus {
namespace volume {
namespace {

constexpr double kReach_m =
    0.035;  // how far from the entry the midline may lie, and half the width compared
constexpr double kTurn_rad = 12.0 * std::numbers::pi / 180.0;
constexpr double kHalfHeight_m = 0.015;
constexpr double kBefore_m = 0.005, kBehind_m = 0.030;
constexpr double kStep_m = 0.002;  // between the points compared
constexpr double kLeastSymmetry =
    0.5;  // lumbar and thoracic pedicles in three CTs score 0.75 … 0.86
constexpr double kLeastSide_m = 0.002;
const double kLeastTilt = std::sin(20.0 * std::numbers::pi / 180.0);

core::Error refused(core::Errc code, std::string why) { return {code, std::move(why)}; }

/// The box in which halves are compared, about the tract.
struct Region {
  double y_low, y_high;  // of V, m
  double z_low, z_high;
};

struct Score {
  double symmetry = 0.0;  // Σ 2αα′ / Σ (α² + α′²)
  double rank = 0.0;      // the same times Σ 2αα′
};

class Mirror {
 public:
  Mirror(const Volume& volume, const TransferFunction& transfer, const Region& region)
      : volume_(volume), transfer_(transfer), region_(region) {}

  Score score(const Midline& plane) const {
    const Vec3 left = plane.left(), along(-left.y(), left.x(), 0.0);
    double both = 0.0, own = 0.0;
    for (double y = region_.y_low; y <= region_.y_high; y += kStep_m)
      for (double z = region_.z_low; z <= region_.z_high; z += kStep_m) {
        Vec3 foot = plane.at_m + (y - plane.at_m.y()) * along;
        foot.z() = z;
        for (double u = kStep_m / 2; u < kReach_m; u += kStep_m)
          add(foot + u * left, foot - u * left, both, own);
      }
    return own > 0.0 ? Score{both / own, both / own * both} : Score{};
  }

 private:
  void add(const Vec3& p, const Vec3& q, double& both, double& own) const {
    if (!volume_.geometry.contains(p) || !volume_.geometry.contains(q)) return;
    const double a = transfer_.opacity(volume_.value_at(p)),
                 b = transfer_.opacity(volume_.value_at(q));
    both += 2 * a * b;
    own += a * a + b * b;
  }
  const Volume& volume_;
  const TransferFunction& transfer_;
  Region region_;
};

struct Found {
  Midline plane;
  Score score;
};

/// The best plane of a grid of offsets and turns about `middle`.
Found best_of(const Mirror& mirror, const Midline& middle, double offset_m, double offset_step_m,
              double turn_rad, double turn_step_rad) {
  std::vector<Found> planes;
  const int offsets = int(std::lround(offset_m / offset_step_m)),
            turns = int(std::lround(turn_rad / turn_step_rad));
  for (int i = -offsets; i <= offsets; ++i)
    for (int j = -turns; j <= turns; ++j) {
      Midline plane = middle;
      plane.at_m.x() += i * offset_step_m;
      plane.turn_rad = std::clamp(middle.turn_rad + j * turn_step_rad, -kTurn_rad, kTurn_rad);
      planes.push_back({plane, {}});
    }
  tbb::parallel_for(std::size_t(0), planes.size(),
                    [&](std::size_t n) { planes[n].score = mirror.score(planes[n].plane); });
  Found best{middle, {}};
  for (const Found& found : planes)
    if (found.score.rank > best.score.rank) best = found;
  return best;
}

}  // namespace

Midline stated_midline(double x_m, const Vec3& entry_m) {
  return {{x_m, entry_m.y(), entry_m.z()}, 0.0, std::nullopt};
}

core::Result<Midline> midline_about(const Volume& volume, const TransferFunction& transfer,
                                    const Vec3& entry_m, const Vec3& target_m) {
  if (!entry_m.allFinite() || !target_m.allFinite())
    return refused(core::Errc::bad_input, "entry and target must be finite numbers");
  const double z = (entry_m.z() + target_m.z()) / 2;
  const Mirror mirror(
      volume, transfer,
      {std::min(entry_m.y(), target_m.y()) - kBefore_m,
       std::max(entry_m.y(), target_m.y()) + kBehind_m, z - kHalfHeight_m, z + kHalfHeight_m});
  const Midline start{entry_m, 0.0, std::nullopt};
  const double degree = std::numbers::pi / 180.0;
  Found found = best_of(mirror, start, 0.034, 0.002, kTurn_rad, 4 * degree);
  if (found.score.rank > 0.0)
    found = best_of(mirror, found.plane, 0.0015, 0.0005, 3 * degree, degree);
  if (!(found.score.symmetry >= kLeastSymmetry))
    return refused(core::Errc::out_of_range,
                   fmt::format("no midline found within {:.0f} mm of the entry (best symmetry "
                               "{:.2f}, {:.2f} is needed): "
                               "state it",
                               kReach_m * 1e3, found.score.symmetry, kLeastSymmetry));
  found.plane.symmetry = found.score.symmetry;
  return found.plane;
}

core::Result<Tract> tract_between(const Vec3& entry_m, const Vec3& target_m, double length_m,
                                  double radius_m, const Midline& midline) {
  if (!entry_m.allFinite() || !target_m.allFinite() || !std::isfinite(length_m) ||
      !std::isfinite(radius_m) || !midline.at_m.allFinite())
    return refused(core::Errc::bad_input,
                   "entry, target, length, radius and midline must be finite numbers");
  if ((target_m - entry_m).norm() < 1e-6)
    return refused(core::Errc::bad_input, "entry and target are the same point");
  if (!(length_m > 0.0))
    return refused(core::Errc::bad_input, fmt::format("length {} m must be positive", length_m));
  if (!(radius_m > 0.0))
    return refused(core::Errc::bad_input, fmt::format("radius {} m must be positive", radius_m));
  const double side_m = midline.left_of_plane_m(entry_m);
  if (std::abs(side_m) < kLeastSide_m)
    return refused(
        core::Errc::out_of_range,
        fmt::format("the entry lies {:.1f} mm from the midline: left or right is not known",
                    std::abs(side_m) * 1e3));
  Tract tract{.entry_m = entry_m,
              .axis = (target_m - entry_m).normalized(),
              .length_m = length_m,
              .radius_m = radius_m};
  const Vec3 to_midline = side_m > 0 ? Vec3(-midline.left()) : midline.left();
  const auto across = [&](const Vec3& v) -> Vec3 { return v - v.dot(tract.axis) * tract.axis; };
  if (across(to_midline).norm() < kLeastTilt || across(Vec3::UnitZ()).norm() < kLeastTilt)
    return refused(core::Errc::out_of_range,
                   "the axis runs left-right or up-down: its walls have no such names");
  tract.medial = across(to_midline).normalized();
  tract.superior = tract.axis.cross(tract.medial).normalized();
  if (tract.superior.z() < 0) tract.superior = -tract.superior;
  return tract;
}

}  // namespace volume
}  // namespace tractus
