#include "metrics/metric.hpp"

namespace tractus::metrics {

MetricInfo not_converged_share() {
  MetricInfo info{"not_converged_share",
                  "Steps not converged",
                  "1",
                  "Share of the samples whose probe was not in equilibrium to 0.001 N.",
                  "own definition",
                  trial::Rig::palpation,
                  [](const Subject& subject) -> Score {
                    const auto& samples = subject.trial.samples;
                    if (samples.empty()) return {{}, "no sample was recorded"};
                    const auto count = trial::count_ticks(subject.trial.block()).not_converged;
                    return {double(count) / double(samples.size()), ""};
                  }};
  info.shown_as = ShownAs::share;
  return info;
}

}  // namespace tractus::metrics
