#include "plot/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tractus {
namespace plot {
namespace {

/// Writes "M x y L x y …", lifting the pen at gaps.
class Pen {
 public:
  void to(double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y)) return lift();
    // Far outside the picture SVG renderers lose precision; the panel clips there anyway.
    text_ +=
        (down_ ? "L" : "M") + px(std::clamp(x, -1e5, 1e5)) + " " + px(std::clamp(y, -1e5, 1e5));
    down_ = true;
  }
  void lift() { down_ = false; }
  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
  bool down_ = false;
};

/// Draws points [from, to) of one pixel column by their first, lowest, highest and last, in their
/// order.
void draw_column(std::span<const double> x, std::span<const double> y, std::size_t from,
                 std::size_t to, const Axis& across, const Axis& up, const Frame& frame, Pen& pen) {
  std::size_t low = from, high = from;
  for (std::size_t k = from; k < to; ++k) {
    if (y[k] < y[low]) low = k;
    if (y[k] > y[high]) high = k;
  }
  std::size_t last = to;
  for (const std::size_t k : {from, std::min(low, high), std::max(low, high), to - 1}) {
    if (k != last) pen.to(frame.x(across, x[k]), frame.y(up, y[k]));
    last = k;
  }
}

}  // namespace

std::string px(double value) {
  std::string text = fmt::format("{:.2f}", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string curve(std::span<const double> x, std::span<const double> y, const Axis& across,
                  const Axis& up, const Frame& frame) {
  Pen pen;
  const bool thin = std::ranges::is_sorted(x) && double(x.size()) > 4.0 * frame.width_px;
  for (std::size_t k = 0; k < x.size();) {
    if (!std::isfinite(x[k]) || !std::isfinite(y[k])) {
      pen.lift();
      ++k;
      continue;
    }
    std::size_t end = k + 1;
    const double column = std::floor(frame.x(across, x[k]));
    while (thin && end < x.size() && std::isfinite(y[end]) &&
           std::floor(frame.x(across, x[end])) == column)
      ++end;
    draw_column(x, y, k, end, across, up, frame, pen);
    k = end;
  }
  return std::move(pen).text();
}

std::string crosses(std::span<const double> x, std::span<const double> y, const Axis& across,
                    const Axis& up, const Frame& frame) {
  constexpr double kArm = 3.0;
  Pen pen;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double at_x = frame.x(across, x[k]), at_y = frame.y(up, y[k]);
    if (!std::isfinite(at_x) || !std::isfinite(at_y)) continue;
    for (const auto& [dx, dy] : {std::pair{kArm, 0.0}, std::pair{0.0, kArm}}) {
      pen.lift();
      pen.to(at_x - dx, at_y - dy);
      pen.to(at_x + dx, at_y + dy);
    }
  }
  return std::move(pen).text();
}

std::string staircase(std::span<const double> edges, std::span<const double> y, const Axis& across,
                      const Axis& up, const Frame& frame, bool filled) {
  if (y.empty()) return {};
  Pen pen;
  const double foot = std::clamp(frame.y(up, 0.0), 0.0, frame.height_px);
  if (filled) pen.to(frame.x(across, edges.front()), foot);
  for (std::size_t k = 0; k < y.size(); ++k) {
    pen.to(frame.x(across, edges[k]), frame.y(up, y[k]));
    pen.to(frame.x(across, edges[k + 1]), frame.y(up, y[k]));
  }
  if (filled) pen.to(frame.x(across, edges.back()), foot);
  return std::move(pen).text() + (filled ? "Z" : "");
}

}  // namespace plot
}  // namespace tractus
