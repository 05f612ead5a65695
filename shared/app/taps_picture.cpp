#include "app/taps_picture.hpp"

#include <fmt/format.h>

#include <limits>

namespace tractus {
namespace app {
namespace {
constexpr const char *kForce = "#1b4f8f", *kWay = "#c05a1c";
constexpr double kShown_mm = 4.0;

plot::Panel panel_of(const std::string& trial, const capture::ClockFit& clock,
                     const capture::TapPair& pair, const capture::TapView& run) {
  plot::Panel panel;
  panel.title =
      fmt::format("{}: offset {:.2f} ms ± {:.2f} ms; force and way go together by {:.1f} %", trial,
                  1e3 * (clock.force_time(pair.taps_s.front()) - pair.taps_s.front()),
                  1e3 * pair.sd_s, 100.0 * pair.together);
  panel.x_label = "t, s (motion's clock)";
  panel.y_label = "|F|, N";
  panel.right_label = "way into the surface, mm";
  plot::Line force, way;
  force.label = "force";
  force.x = run.force_t_s, force.y = run.force_N;
  force.colour = kForce;
  way.label = "tip";
  way.x = run.way_t_s;
  way.colour = kWay;
  way.right_axis = true;
  // Far above the surface nothing is to be seen: the last millimetres fill the panel.
  for (const double w : run.way_m)
    way.y.push_back(1e3 * w > -kShown_mm ? 1e3 * w : std::numeric_limits<double>::quiet_NaN());
  panel.lines = {std::move(way), std::move(force)};
  return panel;
}
}  // namespace

plot::Figure taps_figure(const std::vector<ShownTaps>& trials) {
  plot::Figure figure;
  figure.title = "Taps: force and motion on one clock";
  for (const ShownTaps& one : trials) {
    for (std::size_t k = 0; k < one.runs.size(); ++k)
      figure.panels.push_back(panel_of(one.trial, one.clock, one.clock.runs[k], one.runs[k]));
    if (one.runs.empty())
      figure.note += fmt::format("{}: no taps, the offset was stated. ", one.trial);
  }
  return figure;
}

}  // namespace app
}  // namespace tractus
