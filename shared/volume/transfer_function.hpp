/// From CT value to opacity.
#pragma once

#include <vector>

#include "core/result.hpp"

namespace tractus::volume {

/// α(v): piecewise linear through its points, constant beyond the first and the last [Zoller2020,
/// "Haptic rendering": a transfer function maps grey values to opacity].
class TransferFunction {
 public:
  struct Point {
    double value;    ///< CT value
    double opacity;  ///< 0 … 1
    bool operator==(const Point&) const = default;
  };
  /// @param points  at least two, values strictly increasing, opacities within 0 … 1. Errors:
  /// bad_input.
  static core::Result<TransferFunction> make(std::vector<Point> points);
  /// The default for calibrated CT: nothing below 150 HU, full from 700 HU (design: models).
  static TransferFunction bone();

  double opacity(double value) const noexcept;
  const std::vector<Point>& points() const noexcept { return points_; }

 private:
  explicit TransferFunction(std::vector<Point> points) : points_(std::move(points)) {}
  std::vector<Point> points_;
};

}  // namespace tractus::volume
