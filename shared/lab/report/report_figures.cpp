/// The report's pictures: overlays, distributions, spectra, the map of the tract.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "lab/identify/verdict_text.hpp"
#include "lab/report/report_parts.hpp"
#include "plot/figure.hpp"
#include "plot/text.hpp"

namespace tractus {
namespace lab::page {
namespace {

using plot::escaped;

/// The trials with the largest, the middle and the smallest error.
std::vector<std::size_t> representative(const Comparison& comparison) {
  std::vector<std::size_t> order(comparison.trials.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::stable_sort(order, std::greater<>(),
                           [&](std::size_t k) { return comparison.trials[k].rmse; });
  if (order.size() <= 3) return order;
  return {order.front(), order[order.size() / 2], order.back()};
}

plot::Panel signal_panel(const ReportContent& content, std::size_t trial, std::size_t channel) {
  const TrialSamples& before = content.before.samples.trials[trial];
  const auto [what, unit] = name_and_unit(content.before.samples.channels[channel].name);
  plot::Panel panel;
  panel.x_label = "";
  panel.y_label = fmt::format("{}, {}", what, unit);

  panel.height_px = 190;
  panel.lines.push_back({"measured", before.t_s, before.measured[channel], kMeasuredColour, 1.6});
  panel.lines.push_back(
      {"model " + content.before_name, before.t_s, before.simulated[channel], kBeforeColour, 1.2});
  if (content.better) {
    const TrialSamples& better = content.better->samples.trials[trial];
    panel.lines.push_back(
        {better_name(content), better.t_s, better.simulated[channel], kBetterColour, 1.2});
  }
  return panel;
}

std::vector<double> residuals(const TrialSamples& trial, std::size_t channel) {
  std::vector<double> out(trial.t_s.size());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = trial.residual(channel, k);
  return out;
}

/// The height at which residuals are cut off, so that the samples at a border of layers do not hide
/// all others; nothing where none is far out.
double residual_edge(const ReportContent& content, std::size_t trial, std::size_t channel) {
  constexpr double kShown = 0.99, kRoom = 1.5, kFar = 2.0;
  std::vector<double> sizes = residuals(content.before.samples.trials[trial], channel);
  for (double& r : sizes) r = std::abs(r);
  const auto at = sizes.begin() + std::ptrdiff_t(kShown * double(sizes.size() - 1));
  std::ranges::nth_element(sizes, at);
  const double edge =
      std::max(kRoom * *at, 4.0 * content.before.samples.channels[channel].noise_floor);
  return *std::max_element(at, sizes.end()) > kFar * edge ? edge
                                                          : std::numeric_limits<double>::infinity();
}

std::vector<double> cut_off(std::vector<double> values, double edge) {
  for (double& v : values) v = std::clamp(v, -edge, edge);
  return values;
}

plot::Panel residual_panel(const ReportContent& content, std::size_t trial, std::size_t channel) {
  const TrialSamples& before = content.before.samples.trials[trial];
  const auto& facts = content.before.samples.channels[channel];
  plot::Panel panel;
  panel.x_label = "t, s";
  panel.y_label = "residual, " + name_and_unit(facts.name).unit;
  panel.height_px = 120;
  const double edge = residual_edge(content, trial, channel);
  panel.lines.push_back(
      {"", before.t_s, cut_off(residuals(before, channel), edge), kBeforeColour, 1.0});
  if (content.better) {
    const TrialSamples& better = content.better->samples.trials[trial];
    panel.lines.push_back(
        {"", better.t_s, cut_off(residuals(better, channel), edge), kBetterColour, 1.0});
  }
  panel.marks = {{2.0 * facts.noise_floor, "± 2 × noise", ""}, {-2.0 * facts.noise_floor, "", ""}};
  return panel;
}

plot::Panel histogram_panel(const ReportContent& content, std::size_t c) {
  const ChannelComparison& before = content.before.comparison.channels[c];
  const auto [what, unit] = name_and_unit(before.name);
  plot::Panel panel;
  panel.title = fmt::format("Residual of {}", what);
  panel.x_label = unit;
  panel.y_label = "share of samples";

  panel.height_px = 150;
  const auto add = [&](const ChannelComparison& of, const std::string& label, const char* colour) {
    panel.steps.push_back(
        {label, of.residual.histogram.edges, of.residual.histogram.shares, colour, true});
  };
  add(before, content.before_name, kBeforeColour);
  if (content.better)
    add(content.better->comparison.channels[c], better_name(content), kBetterColour);
  return panel;
}

plot::Panel value_panel(const ReportContent& content, std::size_t c) {
  const ChannelComparison& before = content.before.comparison.channels[c];
  const auto [what, unit] = name_and_unit(before.name);
  plot::Panel panel;
  panel.title = fmt::format("Values of {}", what);
  panel.x_label = unit;
  panel.y_label = "share of samples";

  panel.height_px = 150;
  const auto add = [&](const Distribution& of, const std::string& label, const char* colour) {
    panel.steps.push_back({label, of.histogram.edges, of.histogram.shares, colour});
  };
  add(before.measured, "measured", kMeasuredColour);
  add(before.simulated, content.before_name, kBeforeColour);
  if (content.better)
    add(content.better->comparison.channels[c].simulated, better_name(content), kBetterColour);
  return panel;
}

std::vector<double> decades_of(const std::vector<double>& frequency_Hz) {
  std::vector<double> out;
  for (const double f : frequency_Hz) out.push_back(std::log10(f));
  return out;
}

plot::Panel spectrum_panel(const ReportContent& content, std::size_t c) {
  const ChannelComparison& before = content.before.comparison.channels[c];
  const auto [what, unit] = name_and_unit(before.name);
  plot::Panel panel;
  panel.title = fmt::format("Spectrum of {}", what);
  panel.x_label = "log10 of the frequency in Hz";
  panel.y_label = fmt::format("({})² per Hz", unit);

  panel.height_px = 150;
  panel.log_y = true;
  const auto x = decades_of(before.spectrum.frequency_Hz);
  panel.lines.push_back({"measured", x, before.spectrum.measured, kMeasuredColour, 1.6});
  panel.lines.push_back(
      {"residual " + content.before_name, x, before.spectrum.residual, kBeforeColour, 1.4});
  if (content.better)
    panel.lines.push_back({"residual " + better_name(content), x,
                           content.better->comparison.channels[c].spectrum.residual, kBetterColour,
                           1.4});
  return panel;
}

std::string cell(double x, double y, double w, double h, double share) {
  return fmt::format(
      R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}" fill-opacity="{:.3f}"/>)",
      x, y, w, h, kBeforeColour, share);
}

}  // namespace

std::string overlays(const ReportContent& content) {
  std::string body;
  const auto chosen = representative(content.before.comparison);
  const std::array<const char*, 3> ranks{"largest error", "middle", "smallest error"};
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const auto& trial = content.before.comparison.trials[chosen[k]];
    plot::Figure figure;
    figure.width_px = 960;
    for (const std::size_t channel : content.before.samples.judged) {
      figure.panels.push_back(signal_panel(content, chosen[k], channel));
      figure.panels.push_back(residual_panel(content, chosen[k], channel));
    }
    const std::string rank =
        content.before.comparison.trials.size() > 2 ? fmt::format(" · {}", ranks[k]) : "";
    body += fmt::format(
        "<h3>{}{} · {}{}</h3>\n{}", escaped(trial.id), rank,
        lab::figure(trial.rmse, content.before.comparison.judged_unit),
        content.better
            ? fmt::format(" → {}", lab::figure(content.better->comparison.trials[chosen[k]].rmse,
                                               content.before.comparison.judged_unit))
            : "",
        plot::svg(figure));
  }
  return section("Measured and simulated",
                 "Residual is measured − simulated; errors are root mean squares. Where a few "
                 "residuals are far larger than all others, as at a border of layers, they end at "
                 "the picture's edge.",
                 body);
}

std::string distributions(const ReportContent& content) {
  plot::Figure figure;
  figure.width_px = 960;
  figure.columns = 3;
  for (std::size_t c = 0; c < content.before.comparison.channels.size(); ++c) {
    figure.panels.push_back(value_panel(content, c));
    figure.panels.push_back(histogram_panel(content, c));
    figure.panels.push_back(spectrum_panel(content, c));
  }
  return section("How the error is distributed", "", plot::svg(figure));
}

std::string tract_picture(const TractMap& map, const std::string& unit) {
  const double left = 70, top = 12, width = 760, height = 220;
  const std::size_t depths = map.depth_m.size() - 1, angles = map.angle_rad.size() - 1;
  double largest = 0.0;
  for (const double rmse : map.rmse)
    if (std::isfinite(rmse)) largest = std::max(largest, rmse);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 290\" role=\"img\" "
      "aria-label=\"Error on the wall of the tract\" font-family=\"sans-serif\">\n");
  const double w = width / double(depths), h = height / double(angles);
  for (std::size_t d = 0; d < depths; ++d)
    for (std::size_t a = 0; a < angles; ++a)
      if (const double rmse = map.rmse[d * angles + a]; std::isfinite(rmse) && largest > 0.0)
        out += cell(left + w * double(d), top + height - h * double(a + 1), w, h,
                    0.08 + 0.92 * rmse / largest) +
               "\n";
  for (std::size_t d = 0; d <= depths; d += 3)
    out += plot::written({left + w * double(d), top + height + 18, 12, "middle"},
                         fmt::format("{:.0f}", 1e3 * map.depth_m[d]));
  for (int quarter = 0; quarter <= 4; ++quarter)
    out += plot::written({left - 8, top + height * (1.0 - 0.25 * quarter) + 4, 12, "end"},
                         fmt::format("{}°", 90 * quarter));
  out += plot::written(
      {left + 0.5 * width, top + height + 40, 12.5, "middle"},
      fmt::format(
          "depth along the tract, mm; upwards the angle about its axis · darkest: {}; empty: "
          "not touched",
          lab::figure(largest, unit)));
  out += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="none" stroke="#b9c0c8"/>)",
                     left, top, width, height);
  return out + "</svg>\n";
}

}  // namespace lab::page
}  // namespace tractus
