#include "volume/transfer_function.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tractus::volume {

core::Result<TransferFunction> TransferFunction::make(std::vector<Point> points) {
  const auto bad = [](std::string why) {
    return core::Error{core::Errc::bad_input, "transfer: " + why};
  };
  if (points.size() < 2) return bad("at least two points [CT value, opacity] are needed");
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!std::isfinite(points[k].value) || !(points[k].opacity >= 0.0 && points[k].opacity <= 1.0))
      return bad(
          fmt::format("point {}: [{}, {}] needs a finite CT value and an opacity within 0 … 1", k,
                      points[k].value, points[k].opacity));
    if (k > 0 && !(points[k].value > points[k - 1].value))
      return bad(fmt::format("point {}: CT value {} must be greater than {} before it", k,
                             points[k].value, points[k - 1].value));
  }
  return TransferFunction(std::move(points));
}

TransferFunction TransferFunction::bone() { return TransferFunction({{150.0, 0.0}, {700.0, 1.0}}); }

double TransferFunction::opacity(double value) const noexcept {
  if (value <= points_.front().value) return points_.front().opacity;
  for (std::size_t k = 1; k < points_.size(); ++k) {
    const Point &a = points_[k - 1], &b = points_[k];
    if (value <= b.value)
      return a.opacity + (b.opacity - a.opacity) * (value - a.value) / (b.value - a.value);
  }
  return points_.back().opacity;
}

}  // namespace tractus::volume
