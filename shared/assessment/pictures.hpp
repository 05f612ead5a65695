/// Pictures of an analysis, for its report.
#pragma once

#include <string>
#include <vector>

#include "plot/figure.hpp"
#include "statistics/anova/anova.hpp"

namespace tractus::assessment {

/// Points as small crosses. At most 1500 are drawn, evenly taken from all.
plot::Line crosses(const std::string& label, const statistics::Vector& x,
                   const statistics::Vector& y, const std::string& colour = "#1b4f8f");

/// Residuals against fitted values, and their normal quantile plot.
plot::Figure residual_picture(const statistics::Vector& fitted,
                              const statistics::Vector& residuals);

/// A response against one predictor, with straight lines laid through: label, intercept, slope.
struct RegressionLines {
  std::string label;
  double intercept = 0.0, slope = 0.0;
};
plot::Figure scatter_picture(const std::string& x_name, const statistics::Vector& x,
                             const std::string& y_name, const statistics::Vector& y,
                             const std::vector<RegressionLines>& lines);

/// Every value by group, its mean as a bar with a 95 % interval of the mean.
plot::Figure group_picture(const std::string& x_name, const statistics::Groups& groups,
                           const std::string& y_name);

/// A line per subject over the levels, and the means.
plot::Figure profile_picture(const std::vector<std::string>& levels,
                             const statistics::Matrix& values, const std::string& y_name);

}  // namespace tractus::assessment
