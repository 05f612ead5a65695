#include <fmt/format.h>

#include "metrics/metric.hpp"

namespace tractus::metrics {

MetricInfo late_ticks() {
  return {"late_ticks",
          "Late ticks",
          "1",
          "Number of ticks of the station's loop that woke more than a quarter period late.",
          "own definition",
          kBothRigs,
          [](const Subject& subject) -> Score {
            const auto ticks = trial::count_ticks(subject.trial.block());
            return {double(ticks.late), fmt::format("and {} skipped", ticks.skipped)};
          }};
}

}  // namespace tractus::metrics
