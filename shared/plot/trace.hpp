/// From points to the text of an SVG path.
#pragma once

#include <span>
#include <string>

#include "plot/axis.hpp"

namespace tractus::plot {

/// Where a panel's values lie on the picture, px from the plot's own corner.
struct Frame {
  double width_px, height_px;
  double x(const Axis& axis, double value) const { return width_px * axis.share(value); }
  double y(const Axis& axis, double value) const { return height_px * (1.0 - axis.share(value)); }
};

/// A curve's path; gaps where a value is not finite; thinned as `Line` says.
std::string curve(std::span<const double> x, std::span<const double> y, const Axis& across,
                  const Axis& up, const Frame& frame);

/// A small cross at each point; none where a value is not finite.
std::string crosses(std::span<const double> x, std::span<const double> y, const Axis& across,
                    const Axis& up, const Frame& frame);

/// A staircase's path; closed to the axis' foot (or to zero, if that is on the axis) when filled.
std::string staircase(std::span<const double> edges, std::span<const double> y, const Axis& across,
                      const Axis& up, const Frame& frame, bool filled);

/// A coordinate with at most two decimals.
std::string px(double value);

}  // namespace tractus::plot
