#include <fmt/format.h>

#include "replay/probing_replay.hpp"

namespace tractus {
namespace replay {
namespace {

constexpr const char* kProbePlace = "#7b3fa0";  // where the probe is
constexpr const char* kMeasured = "#1b3f7f";
constexpr const char* kSimulated = "#62a9de";
constexpr const char* kError = "#a8480b";
constexpr std::size_t kMostAlongDepth = 5000;

std::vector<double> scaled(const std::vector<double>& values, double factor) {
  std::vector<double> out = values;
  for (double& v : out) v *= factor;
  return out;
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) out[k] = a[k] - b[k];
  return out;
}

std::vector<double> thinned(const std::vector<double>& values) {
  const std::size_t every = 1 + values.size() / kMostAlongDepth;
  std::vector<double> out;
  for (std::size_t k = 0; k < values.size(); k += every) out.push_back(values[k]);
  return out;
}

plot::Panel panel(std::string title, std::string y_label, std::string x_label = "time, s") {
  plot::Panel out;
  out.title = std::move(title);
  out.x_label = std::move(x_label);
  out.y_label = std::move(y_label);
  return out;
}

/// Measured and simulated of one channel, and their difference below.
void add_channel(plot::Figure& figure, const std::vector<double>& t_s,
                 const std::vector<double>& measured, const std::vector<double>& simulated,
                 const char* title, const char* axis) {
  plot::Panel both = panel(title, axis);
  both.lines = {{"simulated", t_s, simulated, kSimulated, 1.2, false},
                {"measured", t_s, measured, kMeasured, 1.0, false}};
  plot::Panel error = panel("measured − simulated", axis);
  error.height_px = 130;
  error.lines = {{"", t_s, difference(measured, simulated), kError, 1.0, false}};
  error.horizontal_marks = {0.0};
  figure.panels.push_back(std::move(both));
  figure.panels.push_back(std::move(error));
}

}  // namespace

plot::Figure trial_figure(const trial::ProbingMeasurement& recording,
                          const ProbingReplayed& replayed) {
  plot::Figure figure;
  figure.title = recording.id;
  const bool slides = !recording.x_m.empty();
  if (slides) {
    add_channel(figure, recording.t_s, recording.fz_N, replayed.forces.fz_N, "Push", "push, N");
    plot::Panel& push = figure.panels.front();
    push.right_label = "depth, mm";
    push.lines.insert(push.lines.begin(),
                      {"depth", recording.t_s, scaled(recording.x_m, 1e3), kProbePlace, 1.0, true});
  }
  if (!recording.tz_Nm.empty() && !replayed.forces.tz_Nm.empty())
    add_channel(figure, recording.t_s, recording.tz_Nm, replayed.forces.tz_Nm, "Torque",
                "torque, N·m");
  if (!replayed.live_x_m.empty()) {
    plot::Panel live =
        panel("Depth, as recorded and as the recorded push drives the model", "depth, mm");
    live.lines = {{"driven", recording.t_s, scaled(replayed.live_x_m, 1e3), kSimulated, 1.2, false},
                  {"recorded", recording.t_s, scaled(recording.x_m, 1e3), kMeasured, 1.0, false}};
    figure.panels.push_back(std::move(live));
  }
  if (slides) {
    const auto depth_mm = thinned(scaled(recording.x_m, 1e3));
    plot::Panel along = panel("Push against depth", "push, N", "depth, mm");
    along.lines = {{"simulated", depth_mm, thinned(replayed.forces.fz_N), kSimulated, 1.0, false},
                   {"measured", depth_mm, thinned(recording.fz_N), kMeasured, 1.0, false}};
    figure.panels.push_back(std::move(along));
  }
  return figure;
}

}  // namespace replay
}  // namespace tractus
