#include "bench/hand_recognition/tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <span>

#include "core/file.hpp"
#include "plot/figure.hpp"
#include "statistics/distributions/proportions.hpp"

namespace tractus {
namespace bench {
namespace {

std::string truth_of(const Tried& one) {
  return one.breach ? std::string(name(*one.breach)) : "whole";
}

void print_share(const std::string& what, int right, int of) {
  if (of == 0) return;
  const auto share = statistics::Proportion::make(right, of).value();
  const auto within = statistics::wilson(share);
  fmt::print("  {:<30} {:4}/{:<4} {:5.1f} %  [{:.1f}, {:.1f}]\n", what, right, of,
             100.0 * share.share(), 100.0 * within.low, 100.0 * within.high);
}

/// A cross of two short lines at each point.
void add_points(const std::vector<Tried>& tried, const std::string& label, const char* colour,
                bool passes, plot::Panel& panel) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  plot::Line out{.label = label, .x = {}, .y = {}, .colour = colour, .width_px = 2.0};
  for (const Tried& one : tried) {
    if (!one.breach || one.passes != passes) continue;
    for (const auto& [dx, dy] : {std::pair{-0.012, 0.0},
                                 {0.012, 0.0},
                                 {kNone, kNone},
                                 {0.0, -0.012},
                                 {0.0, 0.012},
                                 {kNone, kNone}}) {
      out.x.push_back(one.foretold + dx);
      out.y.push_back(one.rate() + dy);
    }
  }
  if (!out.x.empty()) panel.lines.push_back(std::move(out));
}

}  // namespace

double correlation(const std::vector<Tried>& tried) {
  double count = 0, mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (const Tried& one : tried)
    if (one.breach) mx += one.foretold, my += one.rate(), count += 1.0;
  mx /= count, my /= count;
  for (const Tried& one : tried) {
    if (!one.breach) continue;
    const double x = one.foretold - mx, y = one.rate() - my;
    xx += x * x, yy += y * y, xy += x * y;
  }
  return xy / std::sqrt(xx * yy);
}

double highest_correlation(const std::vector<Tried>& tried) {
  double count = 0, mean = 0, square = 0, binomial = 0;
  for (const Tried& one : tried) {
    if (!one.breach) continue;
    const double p = one.rate();
    count += 1.0, mean += p, square += p * p, binomial += p * (1.0 - p) / (one.trials - 1);
  }
  const double variance = (square - mean * mean / count) / (count - 1.0);
  return std::sqrt(std::max(0.0, 1.0 - binomial / count / variance));
}

void print_table(const std::vector<Tried>& tried) {
  std::map<std::string, std::array<int, 2>> by_truth;
  std::map<std::string, std::map<std::string, int>> instead;
  for (const Tried& one : tried) {
    auto& [right, of] = by_truth[truth_of(one)];
    right += one.right, of += one.trials;
    for (const auto& said : one.said)
      if (said != truth_of(one)) ++instead[truth_of(one)][said];
  }
  std::array<int, 2> all{};
  for (const auto& [truth, counts] : by_truth) {
    print_share(truth, counts[0], counts[1]);
    for (const auto& [said, count] : instead[truth]) fmt::print("    said {}: {}\n", said, count);
    all[0] += counts[0], all[1] += counts[1];
  }
  print_share("all", all[0], all[1]);
  const auto whole = by_truth.find("whole");
  if (whole != by_truth.end())
    print_share("false alarms", whole->second[1] - whole->second[0], whole->second[1]);
}

void write_scatter(const std::filesystem::path& path, const std::vector<Tried>& tried) {
  plot::Panel panel;
  panel.title = "SIMULATED hand: share of right answers of each form of a case";
  panel.x_label = "share right that is foretold";
  panel.y_label = "share right";
  panel.height_px = 420;
  plot::Line curve{.label = "as foretold", .x = {}, .y = {}, .colour = "#888888"};
  curve.x = curve.y = {0.0, 1.0};
  panel.lines.push_back(std::move(curve));
  add_points(tried, "passes", "#1b4f8f", true, panel);
  add_points(tried, "does not pass", "#b03a2e", false, panel);
  plot::Figure figure;
  figure.title = "Recognition against detectability";
  figure.panels = {panel};
  figure.note =
      fmt::format("r = {:.2f}, at most {:.2f}", correlation(tried), highest_correlation(tried));
  const std::string text = plot::svg(figure);
  const auto written = core::write_file(path, std::as_bytes(std::span(text)));
  if (written) return;
  fmt::print(stderr, "{}\n", written.error().what);
  std::exit(2);
}

}  // namespace bench
}  // namespace tractus
