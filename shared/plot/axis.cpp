#include "plot/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tractus {
namespace plot {
namespace {

/// The step of 1, 2 or 5 times a power of ten nearest above width / wanted.
double nice_step(double width, int wanted) {
  const double raw = width / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * (1 - 1e-9)) return factor * power;
  return 10.0 * power;
}

std::string with_minus(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, "−");
  return text;
}

std::string label_of(double value, double step) {
  const double largest = std::max(std::abs(value), step);
  if (largest >= 1e6 || step < 1e-5) return with_minus(fmt::format("{:.6g}", value));
  const int decimals = std::max(0, -int(std::floor(std::log10(step) + 1e-9)));
  return with_minus(fmt::format("{:.{}f}", value, decimals));
}

/// Never empty, never so narrow that doubles cannot tell its ends apart.
Range widened(Range range) {
  if (range.empty()) return {0.0, 1.0};
  const double least = std::max(1e-12, 1e-9 * std::max(std::abs(range.low), std::abs(range.high)));
  if (range.high - range.low >= least) return range;
  const double half = range.low == 0.0 ? 0.5 : std::max(least, 0.1 * std::abs(range.low));
  return {range.low - half, range.high + half};
}

}  // namespace

void Range::take(double value) {
  if (!std::isfinite(value)) return;
  value = std::clamp(value, -1e300, 1e300);  // so that high - low is a number
  if (empty()) low = high = value;
  low = std::min(low, value);
  high = std::max(high, value);
}

Axis Axis::linear(Range range, int wanted, bool snug) {
  range = widened(range);
  const double step = nice_step(range.high - range.low, std::max(wanted, 1));
  Axis axis;
  axis.low_ = snug ? range.low : step * std::floor(range.low / step + 1e-9);
  axis.high_ = snug ? range.high : step * std::ceil(range.high / step - 1e-9);
  for (double k = std::ceil(axis.low_ / step - 1e-9); k <= axis.high_ / step + 1e-9; k += 1.0)
    axis.ticks_.push_back({k * step, label_of(k == 0.0 ? 0.0 : k * step, step)});
  return axis;
}

Axis Axis::decades(Range range) {
  Axis axis;
  axis.log_ = true;
  const bool none = range.empty() || !(range.high > 0.0);
  const double top = none ? 0.0 : std::ceil(std::log10(range.high) - 1e-9);
  const double foot =
      none || !(range.low > 0.0) ? top - 4.0 : std::floor(std::log10(range.low) + 1e-9);
  axis.low_ = std::max(std::min(foot, top - 1.0), top - 12.0);
  axis.high_ = top;
  constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  for (double power = axis.low_; power <= axis.high_; power += 1.0) {
    std::string label = power < 0 ? "10⁻" : "10";
    for (const char digit : fmt::format("{}", std::abs(int(power)))) label += kDigits[digit - '0'];
    axis.ticks_.push_back({std::pow(10.0, power), power == 0 ? "1" : label});
  }
  return axis;
}

double Axis::share(double value) const {
  if (log_) value = value > 0.0 ? std::max(std::log10(value), low_) : low_;
  return (value - low_) / (high_ - low_);
}

}  // namespace plot
}  // namespace tractus
