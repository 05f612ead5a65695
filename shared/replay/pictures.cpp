#include "replay/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "replay/table.hpp"

namespace tractus {
namespace replay {
namespace {

constexpr const char* kPlace = "#7b3fa0";  // where the probe is
// Along the handle's axis blue, across it orange; measured dark, simulated light, as in the source.
constexpr const char* kAlongMeasured = "#1b3f7f";
constexpr const char* kAlongSimulated = "#62a9de";
constexpr const char* kAcrossMeasured = "#a8480b";
constexpr const char* kAcrossSimulated = "#f0a04b";
constexpr int kBins = 60;

bool is_along(std::size_t channel) { return channel % 2 == 1; }

plot::Line line_of(std::span<const double> t_s, std::span<const math::Wrench> wrenches,
                   std::size_t channel, const char* label, const char* colour) {
  plot::Line line{label, {t_s.begin(), t_s.end()}, {}, colour, 1.2, false};
  for (const auto& wrench : wrenches) line.y.push_back(kChannels[channel].signed_value(wrench));
  return line;
}

plot::Panel force_panel(const trial::PalpationMeasurement& recording, const Replayed& replayed,
                        std::size_t channel, const char* title) {
  const auto& [id, label, unit, floor, value] = kChannels[channel];
  plot::Panel panel;
  panel.title = title;
  panel.y_label = fmt::format("{}, {}", label, unit);
  panel.lines.push_back(line_of(recording.t_s, replayed.wrench_H, channel, "simulated",
                                is_along(channel) ? kAlongSimulated : kAcrossSimulated));
  panel.lines.push_back(line_of(recording.t_s, recording.wrench_H, channel, "measured",
                                is_along(channel) ? kAlongMeasured : kAcrossMeasured));
  return panel;
}

/// Adds the purple curve of where the probe is, on the right axis.
template <class Place>
void add_place(plot::Panel& panel, const trial::PalpationMeasurement& recording, std::string label,
               std::string axis, const Place& place) {
  plot::Line line{std::move(label), recording.t_s, {}, kPlace, 1.0, true};
  for (const math::Pose& pose : recording.X_VH) line.y.push_back(place(pose));
  panel.right_label = std::move(axis);
  panel.lines.insert(panel.lines.begin(), std::move(line));
}

double angle_deg(const math::Vec3& a, const math::Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

void add_places(plot::Figure& figure, const trial::PalpationMeasurement& recording,
                const trial::StatedTract& tract, const ProbePlace& probe) {
  const auto from_entry = [&, entry = tract.entry_m](const math::Pose& pose) -> math::Vec3 {
    return pose.p + probe.pose_offset_m - entry;
  };
  add_place(figure.panels[0], recording, "sensor to tract entrance", "distance, mm",
            [&](const math::Pose& pose) { return -1e3 * from_entry(pose).dot(tract.axis); });
  figure.panels[0].marks = {
      {1e3 * probe.length_m, "tip enters the tract", kPlace, "8 3 2 3", true},
      {1e3 * (probe.length_m - tract.length_m), "tip at the tract's end", kPlace, "5 3", true},
  };
  add_place(
      figure.panels[1], recording, "sensor to tract axis", "distance, mm",
      [&](const math::Pose& pose) { return 1e3 * from_entry(pose).cross(tract.axis).norm(); });
  add_place(
      figure.panels[2], recording, "tract to handle", "angle, °",
      [&](const math::Pose& pose) { return angle_deg(pose.q * math::Vec3::UnitZ(), tract.axis); });
}

std::vector<double> densities(std::span<const math::Wrench> wrenches, const WrenchColumn& channel,
                              double low, double width) {
  std::vector<double> out(kBins, 0.0);
  for (const auto& wrench : wrenches) {
    const double bin = (channel.signed_value(wrench) - low) / width;
    out[std::size_t(std::clamp(bin, 0.0, double(kBins - 1)))] += 1.0;
  }
  for (double& count : out) count /= double(wrenches.size()) * width;
  return out;
}

plot::Panel distribution_panel(std::span<const math::Wrench> measured,
                               std::span<const math::Wrench> simulated, std::size_t c) {
  const WrenchColumn& channel = kChannels[c];
  double low = 0.0, high = channel.floor;
  for (const auto wrenches : {measured, simulated})
    for (const auto& wrench : wrenches) {
      low = std::min(low, channel.signed_value(wrench));
      high = std::max(high, channel.signed_value(wrench));
    }
  const double width = (high - low) / kBins;
  plot::Panel panel;
  panel.title = channel.label;
  panel.x_label = channel.unit;
  panel.y_label = channel.unit == "N" ? "density, 1/N" : "density, 1/(N·m)";
  panel.log_y = true;
  std::vector<double> edges;
  for (int k = 0; k <= kBins; ++k) edges.push_back(low + width * k);
  panel.steps = {{"simulated", edges, densities(simulated, channel, low, width),
                  is_along(c) ? kAlongSimulated : kAcrossSimulated, true},
                 {"measured", edges, densities(measured, channel, low, width),
                  is_along(c) ? kAlongMeasured : kAcrossMeasured, false}};
  return panel;
}

}  // namespace

plot::Figure trial_figure(const trial::PalpationMeasurement& recording, const Replayed& replayed,
                          const std::optional<trial::StatedTract>& tract, const ProbePlace& probe) {
  plot::Figure figure;
  figure.title = fmt::format("Trial {}{}", recording.id,
                             recording.operator_name.empty() ? "" : ", " + recording.operator_name);
  figure.panels = {force_panel(recording, replayed, 1, "Along the handle"),
                   force_panel(recording, replayed, 0, "Across the handle"),
                   force_panel(recording, replayed, 2, "Bending")};
  figure.panels.back().x_label = "time, s";
  if (tract) {
    add_places(figure, recording, *tract, probe);
  } else {
    add_place(figure.panels[0], recording, "sensor's z in the volume", "z, mm",
              [&](const math::Pose& pose) { return 1e3 * (pose.p.z() + probe.pose_offset_m.z()); });
  }
  figure.note =
      fmt::format("Replay of the recorded motion; {} of {} steps did not reach the equilibrium.",
                  replayed.not_converged, replayed.steps);
  return figure;
}

plot::Figure distribution_figure(std::span<const math::Wrench> measured,
                                 std::span<const math::Wrench> simulated) {
  plot::Figure figure;
  figure.title = "Forces and torques of all trials";
  figure.columns = 2;
  for (std::size_t c = 0; c < kChannels.size(); ++c)
    figure.panels.push_back(distribution_panel(measured, simulated, c));
  return figure;
}

}  // namespace replay
}  // namespace tractus
