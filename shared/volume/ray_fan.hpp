/// The rays on which a vertebra's outer face is looked for.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "volume/tract.hpp"

namespace tractus::volume {

/// The fan of rays that leaves a tract: rows along it with a hemisphere at each end.
class Fan {
 public:
  static constexpr int kRays = 32;             ///< about the axis
  static constexpr int kPolar = 10;            ///< rows of rays of each hemisphere
  static constexpr double kRowStep_m = 0.001;  ///< between the rows along the tract

  explicit Fan(const Tract& tract)
      : tract_(tract), along_(1 + std::max(1, int(std::lround(tract.length_m / kRowStep_m)))) {}

  int rows() const { return along_ + 2 * kPolar; }
  Vec3 foot(int row) const {
    const double share = std::clamp(double(row - kPolar) / (along_ - 1), 0.0, 1.0);
    return tract_.entry_m + share * tract_.length_m * tract_.axis;
  }
  Vec3 direction(int row, int turn) const {
    const double lift = lift_rad(row), angle = 2.0 * std::numbers::pi * turn / kRays;
    const Vec3 out = std::cos(angle) * tract_.medial + std::sin(angle) * tract_.superior;
    return std::cos(lift) * out + std::sin(lift) * tract_.axis;
  }
  /// Row, turn (both continuous) and distance from the tract of a point; nothing where that is
  /// `reach_m` or more.
  struct Place {
    double row, turn, distance_m;
  };
  std::optional<Place> place_within(double reach_m, const Vec3& p) const {
    const double depth = tract_.depth_of(p);
    const math::Vec2 off = tract_.offset_of(p);
    const double inside = std::clamp(depth, 0.0, tract_.length_m), over = depth - inside;
    const double square_m2 = over * over + off.squaredNorm();
    if (square_m2 >= reach_m * reach_m) return std::nullopt;
    const double lift =  // −1 … 1
        over == 0.0 ? 0.0 : std::atan2(over, off.norm()) / (std::numbers::pi / 2.0);
    const double row = kPolar + inside / tract_.length_m * (along_ - 1) + lift * kPolar;
    double turn = std::atan2(off.y(), off.x()) / (2.0 * std::numbers::pi) * kRays;
    if (turn < 0.0) turn += kRays;
    return Place{row, turn, std::sqrt(square_m2)};
  }
  bool beside(int row) const { return row >= kPolar && row < kPolar + along_; }
  double depth_m(int row) const { return double(row - kPolar) / (along_ - 1) * tract_.length_m; }

 private:
  double lift_rad(int row) const {
    const int over = row < kPolar ? row - kPolar : std::max(0, row - (kPolar + along_ - 1));
    return double(over) / kPolar * std::numbers::pi / 2.0;
  }
  Tract tract_;
  int along_;
};

}  // namespace tractus::volume
