/// Pictures of an analysis, for its report.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "plot/figure.hpp"
#include "statistics/anova/anova.hpp"

namespace tractus::assessment {

/// Points. At most 1500 are drawn, evenly taken from all.
plot::Line crosses(const std::string& label, const statistics::Vector& x,
                   const statistics::Vector& y, const std::string& colour = "#1b4f8f");

/// Residuals against fitted values, and their normal quantile plot.
plot::Figure residual_picture(const statistics::Vector& fitted,
                              const statistics::Vector& residuals);

/// A straight line through the points; `reach` is half the width of its 95 % confidence band at x.
struct RegressionLine {
  std::string label;
  double intercept = 0.0, slope = 0.0;
  std::function<double(double x)> reach = {};  ///< none: no band
};
/// The same half width from the covariance of intercept and slope, by t on `df`.
std::function<double(double x)> band_of(const statistics::Matrix& covariance, double df);
/// A response against one predictor, with the lines that were fitted.
plot::Figure scatter_picture(const std::string& x_name, const statistics::Vector& x,
                             const std::string& y_name, const statistics::Vector& y,
                             const std::vector<RegressionLine>& lines);

/// Every value by group, its mean as a bar with a 95 % interval of the mean.
plot::Figure group_picture(const std::string& x_name, const statistics::Groups& groups,
                           const std::string& y_name);

/// A line per subject over the levels, and the means.
plot::Figure profile_picture(const std::vector<std::string>& levels,
                             const statistics::Matrix& values, const std::string& y_name);

/// A figure as data, for pages: {"note", "panels": [{"title", "x_label", "y_label", "group_names",
/// "lines": [{"label", "x", "y", "points"}], "ribbons": [{"label", "x", "low", "high"}],
/// "marks": [{"at", "label"}]}]}. Numbers have six digits; a gap is null.
core::Json figure_json(const plot::Figure& figure);

}  // namespace tractus::assessment
