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

/// Opacities at a grid of points about a plane. All planes parallel to it are scored from the same points.
class Lines {
 public:
  /// @param reach_m  distance of the farthest plane that is scored from `middle`
  Lines(const Volume& volume, const TransferFunction& transfer, const Region& region,
        const Midline& middle, double reach_m, double grid_m)
      : grid_m_(grid_m),
        reach_(int(std::lround((reach_m + kReach_m) / grid_m))),
        across_(std::size_t(2 * reach_ + 1)) {
    const Vec3 left = middle.left(), along(-left.y(), left.x(), 0.0);
    for (double y = region.y_low; y <= region.y_high; y += kStep_m)
      for (double z = region.z_low; z <= region.z_high; z += kStep_m) {
        Vec3 foot = middle.at_m + (y - middle.at_m.y()) * along;
        foot.z() = z;
        for (int n = -reach_; n <= reach_; ++n) {
          const Vec3 p = foot + n * grid_m * left;
          opacity_.push_back(
              volume.geometry.contains(p) ? float(transfer.opacity(volume.value_at(p))) : kOutside);
        }
      }
  }

  /// Of the plane `aside` grid steps to the patient's left of the middle one.
  Score score(int aside) const {
    const int step = int(std::lround(kStep_m / grid_m_));
    const int pairs = int(kReach_m / kStep_m);
    double both = 0.0, own = 0.0;
    for (std::size_t line = 0; line < opacity_.size(); line += across_) {
      const float* at = &opacity_[line + std::size_t(reach_ + aside)];
      for (int n = step / 2, last = n + pairs * step; n < last; n += step) {
        const float a = at[n], b = at[-n];
        if (a == kOutside || b == kOutside) continue;
        both += 2.0 * double(a * b), own += double(a * a + b * b);
      }
    }
    return own > 0.0 ? Score{both / own, both / own * both} : Score{};
  }

 private:
  static constexpr float kOutside = -1.0f;
  double grid_m_;
  int reach_;
  std::size_t across_;
  std::vector<float> opacity_;  // [y][z][across]
};

struct Found {
  Midline plane;
  Score score;
};

/// Planes that are tried about a middle one: shifted and turned by so much to either side, in steps.
struct Planes {
  double aside_m,
      aside_step_m;  // the step is 2 mm or divides 1 mm: then all points lie on one grid
  double turn_rad, turn_step_rad;
};

/// The best of some planes about `middle`.
Found best_of(const Volume& volume, const TransferFunction& transfer, const Region& region,
              const Midline& middle, const Planes& planes) {
  const double grid_m = std::min(planes.aside_step_m, kStep_m / 2.0);
  const int most = int(std::lround(planes.aside_m / grid_m)),
            step = int(std::lround(planes.aside_step_m / grid_m)),
            turns = int(std::lround(planes.turn_rad / planes.turn_step_rad));
  std::vector<Found> of_turn(std::size_t(2 * turns + 1), {middle, {}});
  tbb::parallel_for(std::size_t(0), of_turn.size(), [&](std::size_t n) {
    Midline turned = middle;
    turned.turn_rad = std::clamp(middle.turn_rad + (int(n) - turns) * planes.turn_step_rad,
                                 -kTurn_rad, kTurn_rad);
    const Lines lines(volume, transfer, region, turned, planes.aside_m, grid_m);
    for (int aside = -most; aside <= most; aside += step) {
      const Score score = lines.score(aside);
      if (score.rank <= of_turn[n].score.rank) continue;
      of_turn[n] = {turned, score};
      of_turn[n].plane.at_m.x() += aside * grid_m / std::cos(turned.turn_rad);
    }
  });
  Found best{middle, {}};
  for (const Found& found : of_turn)
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
  const Region region{std::min(entry_m.y(), target_m.y()) - kBefore_m,
                      std::max(entry_m.y(), target_m.y()) + kBehind_m, z - kHalfHeight_m,
                      z + kHalfHeight_m};
  const Midline start{entry_m, 0.0, std::nullopt};
  const double degree = std::numbers::pi / 180.0;
  Found found = best_of(volume, transfer, region, start, {0.034, 0.002, kTurn_rad, 4 * degree});
  if (found.score.rank > 0.0)
    found = best_of(volume, transfer, region, found.plane, {0.0015, 0.0005, 3 * degree, degree});
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
