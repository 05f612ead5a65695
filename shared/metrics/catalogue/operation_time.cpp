#include "metrics/metric.hpp"

namespace tractus::metrics {

MetricInfo operation_time() {
  MetricInfo info{"operation_time",
                  "Operation time",
                  "s",
                  "Time from the first to the last recorded sample: the palpation, "
                  "without the answer after it.",
                  "own definition",
                  trial::Rig::palpation,
                  [](const Subject& subject) -> Score {
                    const auto& samples = subject.trial.samples;
                    if (samples.empty()) return {{}, "no sample was recorded"};
                    return {samples.back().t_s - samples.front().t_s,
                            subject.trial.complete ? "" : "the trial was interrupted"};
                  }};
  info.followed = 1;
  return info;
}

}  // namespace tractus::metrics
