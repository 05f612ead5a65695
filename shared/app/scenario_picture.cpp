#include "app/scenario_picture.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "scenarios/demand.hpp"

namespace tractus {
namespace commands {
namespace {

constexpr const char* kLayer = "#7d8794";
constexpr const char* kResistance = "#d98a00";
constexpr const char* kBreach = "#c0392b";

/// Every second layer; the stretches before and behind walls over them.
void shade(const laws::ProbingParameters& p, plot::Panel& panel) {
  for (std::size_t k = 0; k < p.layers.size(); k += 2)
    panel.bands.push_back({1e3 * p.layers[k].start_m,
                           1e3 * (p.layers[k].start_m + p.layers[k].thickness_m), kLayer, ""});
  for (const laws::CorticalWall& wall : p.walls) {
    panel.bands.push_back({1e3 * (wall.position_m - wall.resistance_interval_m),
                           1e3 * wall.position_m, kResistance, "resistance"});
    panel.bands.push_back({1e3 * wall.position_m, 1e3 * (wall.position_m + wall.breach_interval_m),
                           kBreach, "breach"});
  }
}

}  // namespace

core::Result<plot::Figure> scenario_picture(const scenarios::Scenario& scenario,
                                            std::span<const double> speeds_m_s) {
  const auto found = TRY(scenarios::resistance(scenario, speeds_m_s));
  plot::Panel panel;
  panel.x_label = "depth, mm";
  panel.y_label = "push, N";
  panel.height_px = 340;
  shade(found.parameters, panel);
  for (std::size_t k = 0; k < found.speeds_m_s.size(); ++k) {
    plot::Line line;
    line.label = fmt::format("{:g} mm/s", 1e3 * found.speeds_m_s[k]);
    for (const double x_m : found.depth_m) line.x.push_back(1e3 * x_m);
    line.y = found.force_N[k];
    panel.lines.push_back(std::move(line));
  }
  plot::Mark surgeon;
  surgeon.at = scenarios::kSurgeon_N;
  surgeon.label = "force of a surgeon";
  surgeon.colour = "#5b6470";
  panel.marks.push_back(surgeon);
  plot::Figure figure;
  figure.title = fmt::format("{} ({}): push needed against depth", scenario.name,
                             scenarios::name(scenario.kind));
  figure.panels.push_back(std::move(panel));
  figure.note = fmt::format("Version {:.12}, {}, {}. Layers shaded in turn.", scenario.id(),
                            scenario.origin.who, scenario.origin.when);
  return figure;
}

}  // namespace commands
}  // namespace tractus
