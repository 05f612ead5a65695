#include "assessment/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace assessment {
namespace {

using statistics::Vector;

constexpr Eigen::Index kMostPoints = 1500;
constexpr double kCross = 0.006;  // arm of a cross, as a share of the axis
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kGreyLine = "#9aa3ad";
constexpr const char* kRed = "#b3261e";

double span(const Vector& of) {
  const double width = of.maxCoeff() - of.minCoeff();
  return width > 0.0 ? width : 1.0;
}

/// "1 = soft, 2 = hard"; numbers stand for themselves where they count up from 1.
std::string numbered(const std::vector<std::string>& names) {
  std::string out;
  bool plain = true;
  for (std::size_t j = 0; j < names.size(); ++j) {
    plain = plain && names[j] == std::to_string(j + 1);
    if (j < 12) out += fmt::format("{}{} = {}", j ? ", " : "", j + 1, names[j]);
  }
  if (names.size() > 12) out += ", …";
  return plain ? "" : out;
}

void add_segment(plot::Line& line, double x0, double y0, double x1, double y1) {
  line.x.insert(line.x.end(), {x0, x1, x1});
  line.y.insert(line.y.end(), {y0, y1, kNaN});
}

/// A bar of the mean with whiskers of its 95 % interval.
void add_mean(plot::Line& bars, double at, const Vector& values) {
  const double mean = values.mean(), n = static_cast<double>(values.size());
  add_segment(bars, at - 0.22, mean, at + 0.22, mean);
  if (values.size() < 2) return;
  const double sd = std::sqrt((values.array() - mean).square().sum() / (n - 1.0));
  const double reach = statistics::student_t_quantile(0.975, n - 1.0) * sd / std::sqrt(n);
  add_segment(bars, at, mean - reach, at, mean + reach);
}

}  // namespace

plot::Line crosses(const std::string& label, const Vector& x, const Vector& y,
                   const std::string& colour) {
  plot::Line out{label, {}, {}, colour, 1.4, false};
  const double dx = kCross * span(x), dy = 2.2 * kCross * span(y);
  const Eigen::Index step = std::max<Eigen::Index>(1, (x.size() + kMostPoints - 1) / kMostPoints);
  for (Eigen::Index i = 0; i < x.size(); i += step) {
    add_segment(out, x[i] + dx, y[i], x[i] - dx, y[i]);
    add_segment(out, x[i], y[i] - dy, x[i], y[i] + dy);
  }
  return out;
}

plot::Figure residual_picture(const Vector& fitted, const Vector& residuals) {
  Vector sorted = residuals;
  std::sort(sorted.begin(), sorted.end());
  Vector quantiles(sorted.size());
  for (Eigen::Index i = 0; i < sorted.size(); ++i)
    quantiles[i] = statistics::normal_quantile((static_cast<double>(i) + 0.625) /
                                               (static_cast<double>(sorted.size()) + 0.25));
  const double sd = std::sqrt((sorted.array() - sorted.mean()).square().mean());
  plot::Panel against{"Residuals against fitted values",
                      "fitted",
                      "residual",
                      "",
                      {},
                      {},
                      {},
                      {0.0},
                      {},
                      false,
                      240};
  against.lines.push_back(crosses("", fitted, residuals));
  plot::Panel normal{"Normal quantiles of the residuals",
                     "standard normal quantile",
                     "residual",
                     "",
                     {},
                     {},
                     {},
                     {},
                     {},
                     false,
                     240};
  normal.lines.push_back(crosses("", quantiles, sorted));
  const double ends[] = {quantiles.minCoeff(), quantiles.maxCoeff()};
  normal.lines.push_back({"if normal",
                          {ends[0], ends[1]},
                          {sorted.mean() + sd * ends[0], sorted.mean() + sd * ends[1]},
                          kGreyLine});
  return {"", 900, 2, {against, normal}, ""};
}

plot::Figure scatter_picture(const std::string& x_name, const Vector& x, const std::string& y_name,
                             const Vector& y, const std::vector<RegressionLines>& lines) {
  plot::Panel panel{"", x_name, y_name, "", {}, {}, {}, {}, {}, false, 300};
  panel.lines.push_back(crosses("observed", x, y));
  const char* colours[] = {kRed, "#2e7d32", "#7b1fa2"};
  const double low = x.minCoeff(), high = x.maxCoeff();
  for (std::size_t k = 0; k < lines.size(); ++k)
    panel.lines.push_back(
        {lines[k].label,
         {low, high},
         {lines[k].intercept + lines[k].slope * low, lines[k].intercept + lines[k].slope * high},
         colours[k % 3],
         1.6});
  return {"", 620, 1, {panel}, ""};
}

plot::Figure group_picture(const std::string& x_name, const statistics::Groups& groups,
                           const std::string& y_name) {
  plot::Panel panel{"", x_name, y_name, "", {}, {}, {}, {}, {}, false, 300};
  plot::Line bars{"mean and its 95 % interval", {}, {}, kRed, 2.0};
  std::vector<double> x, y;
  for (std::size_t j = 0; j < groups.values.size(); ++j) {
    const double at = static_cast<double>(j + 1);
    const auto n = groups.values[j].size();
    for (Eigen::Index i = 0; i < n; ++i) {
      // Side by side, so that equal values are seen.
      x.push_back(
          at + (n > 1 ? 0.3 * (static_cast<double>(i) / static_cast<double>(n - 1) - 0.5) : 0.0));
      y.push_back(groups.values[j][i]);
    }
    add_mean(bars, at, groups.values[j]);
  }
  const auto size = static_cast<Eigen::Index>(x.size());
  panel.lines.push_back(
      crosses("", Eigen::Map<Vector>(x.data(), size), Eigen::Map<Vector>(y.data(), size)));
  panel.lines.push_back(bars);
  return {"", 620, 1, {panel}, numbered(groups.names)};
}

plot::Figure profile_picture(const std::vector<std::string>& levels,
                             const statistics::Matrix& values, const std::string& y_name) {
  plot::Panel panel{"", "level", y_name, "", {}, {}, {}, {}, {}, false, 300};
  plot::Line each{"each subject", {}, {}, kGreyLine, 0.8};
  const Eigen::Index step = std::max<Eigen::Index>(1, values.rows() / 200);
  for (Eigen::Index i = 0; i < values.rows(); i += step) {
    for (Eigen::Index j = 0; j < values.cols(); ++j) {
      each.x.push_back(static_cast<double>(j + 1));
      each.y.push_back(values(i, j));
    }
    each.x.push_back(1.0);
    each.y.push_back(kNaN);
  }
  plot::Line bars{"mean and its 95 % interval", {}, {}, kRed, 2.0};
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    add_mean(bars, static_cast<double>(j + 1), values.col(j));
  panel.lines = {each, bars};
  return {"", 620, 1, {panel}, numbered(levels)};
}

}  // namespace assessment
}  // namespace tractus
