#include <algorithm>
#include <cmath>

#include "metrics/metric.hpp"

namespace tractus {
namespace metrics {
namespace {
bool touches(const trial::Sample& sample) {
  const auto& f = sample.force_N;
  return std::hypot(double{f[0]}, double{f[1]}, double{f[2]}) >= kContact_N;
}
}  // namespace

MetricInfo contact_share() {
  MetricInfo info{
      "contact_share",
      "Time in contact",
      "1",
      "Share of the samples in which the magnitude of the model's force is at least 0.01 N.",
      "own definition",
      trial::Rig::palpation,
      [](const Subject& subject) -> Score {
        const auto& samples = subject.trial.samples;
        if (samples.empty()) return {{}, "no sample was recorded"};
        return {double(std::ranges::count_if(samples, touches)) / double(samples.size()), ""};
      }};
  info.shown_as = ShownAs::share;
  return info;
}

}  // namespace metrics
}  // namespace tractus
