#include "metrics/path_length.hpp"

#include <algorithm>

#include "metrics/metric.hpp"
#include "trial/signals.hpp"

namespace tractus {
namespace metrics {
namespace {
constexpr double kRate_Hz = 200.0;
constexpr double kEndEdge =
    1e-6;  // of a step: a sample this near to the grid's end still reaches it
constexpr double kLongestPath_s = 7200.0;

/// The tip's way on an even grid of 200 Hz from the first sample on, straight between samples.
std::vector<math::Vec3> even_path(const std::vector<trial::Sample>& samples,
                                  const trial::ProbeShape& probe) {
  const double start_s = samples.front().t_s;
  const auto steps = std::size_t((samples.back().t_s - start_s) * kRate_Hz + kEndEdge);
  std::vector<math::Vec3> path;
  std::size_t next = 1;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double t_s = start_s + double(i) / kRate_Hz;
    while (next + 1 < samples.size() && samples[next].t_s < t_s) ++next;
    const auto& before = samples[next - 1];
    const auto& after = samples[next];
    const double span_s = after.t_s - before.t_s;
    const double share = span_s > 0.0 ? std::clamp((t_s - before.t_s) / span_s, 0.0, 1.0) : 1.0;
    path.push_back((1.0 - share) * trial::tip_m(before, probe) +
                   share * trial::tip_m(after, probe));
  }
  return path;
}

Score length_of(const Subject& subject) {
  const auto probe = trial::probe_shape(subject.trial.header);
  if (!probe) return {{}, "the trial does not say how long the probe is"};
  const auto& samples = subject.trial.samples;
  const char* too_short = "the trial is shorter than 0.1 s";
  if (samples.size() < 2) return {{}, too_short};
  if (samples.back().t_s - samples.front().t_s > kLongestPath_s)
    return {{}, "the trial is longer than two hours"};
  const auto length_m = smoothed_length_m(even_path(samples, *probe), 1.0 / kRate_Hz);
  return {length_m, length_m ? "" : too_short};
}
}  // namespace

MetricInfo path_length() {
  return {"path_length",
          "Path length of the tip",
          "m",
          "Integral of the bent probe's tip speed; the tip's positions at 200 Hz are smoothed by a "
          "Savitzky–Golay fit (21 samples, order 3).",
          "own definition",
          trial::Rig::palpation,
          length_of};
}

}  // namespace metrics
}  // namespace tractus
