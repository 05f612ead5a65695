#include "assessment/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Vector;

constexpr Eigen::Index kMostPoints = 1500;
constexpr int kBandSteps = 60;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kGreyLine = "#9aa3ad";
constexpr const char* kRed = "#b3261e";

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
  plot::Line out{label, {}, {}, colour, 1.4, false, true};
  const Eigen::Index step = std::max<Eigen::Index>(1, (x.size() + kMostPoints - 1) / kMostPoints);
  for (Eigen::Index i = 0; i < x.size(); i += step) {
    out.x.push_back(x[i]);
    out.y.push_back(y[i]);
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

std::function<double(double x)> band_of(const statistics::Matrix& covariance, double df) {
  const double quantile = statistics::student_t_quantile(0.975, df);
  return [=](double x) {
    const double variance =
        covariance(0, 0) + 2.0 * x * covariance(0, 1) + x * x * covariance(1, 1);
    return quantile * std::sqrt(variance);
  };
}

plot::Figure scatter_picture(const std::string& x_name, const Vector& x, const std::string& y_name,
                             const Vector& y, const std::vector<RegressionLine>& lines) {
  plot::Panel panel{"", x_name, y_name, "", {}, {}, {}, {}, {}, false, 300};
  panel.lines.push_back(crosses("observed", x, y));
  const char* colours[] = {kRed, "#2e7d32", "#7b1fa2"};
  const double low = x.minCoeff(), high = x.maxCoeff();
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const RegressionLine& line = lines[k];
    const auto at = [&](double value) { return line.intercept + line.slope * value; };
    panel.lines.push_back({line.label, {low, high}, {at(low), at(high)}, colours[k % 3], 1.6});
    if (!line.reach) continue;
    plot::Ribbon band{"95 % confidence band of the mean", {}, {}, {}, colours[k % 3]};
    for (int i = 0; i <= kBandSteps; ++i) {
      const double value = low + (high - low) * i / kBandSteps, reach = line.reach(value);
      band.x.push_back(value);
      band.low.push_back(at(value) - reach);
      band.high.push_back(at(value) + reach);
    }
    panel.ribbons.push_back(std::move(band));
  }
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
  panel.group_names = groups.names;
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
  panel.group_names = levels;
  return {"", 620, 1, {panel}, numbered(levels)};
}

namespace {

/// Six digits are more than a picture shows.
Json six_digits(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == 0.0) return 0.0;
  const double scale = std::pow(10.0, 5.0 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(scale) && scale > 0.0 ? std::round(value * scale) / scale : value;
}

Json six_digits(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double value : values) out.push_back(six_digits(value));
  return out;
}

Json panel_json(const plot::Panel& panel) {
  Json lines = Json::array(), ribbons = Json::array(), marks = Json::array();
  for (const auto& line : panel.lines)
    lines.push_back({{"label", line.label},
                     {"x", six_digits(line.x)},
                     {"y", six_digits(line.y)},
                     {"points", line.points}});
  for (const auto& ribbon : panel.ribbons)
    ribbons.push_back({{"label", ribbon.label},
                       {"x", six_digits(ribbon.x)},
                       {"low", six_digits(ribbon.low)},
                       {"high", six_digits(ribbon.high)}});
  for (const double at : panel.horizontal_marks) marks.push_back({{"at", at}, {"label", ""}});
  for (const auto& mark : panel.marks) marks.push_back({{"at", mark.at}, {"label", mark.label}});
  return {{"title", panel.title},
          {"x_label", panel.x_label},
          {"y_label", panel.y_label},
          {"group_names", panel.group_names},
          {"lines", lines},
          {"ribbons", ribbons},
          {"marks", marks}};
}

}  // namespace

Json figure_json(const plot::Figure& figure) {
  Json panels = Json::array();
  for (const auto& panel : figure.panels) panels.push_back(panel_json(panel));
  return {{"note", figure.note}, {"panels", panels}};
}

}  // namespace assessment
}  // namespace tractus
