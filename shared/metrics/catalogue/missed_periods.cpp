#include <fmt/format.h>

#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo missed_periods() {
  return {"missed_periods",
          "Missed periods",
          "1",
          "Periods of the loop in which the exchange with the rig was not over in time, failed or "
          "did not "
          "take place.",
          "own definition",
          trial::Rig::probing,
          [](const Subject& subject) -> Score {
            if (subject.trial.probing.empty()) return {{}, "no sample was recorded"};
            const auto ticks = trial::count_ticks(subject.trial.block());
            return {double(ticks.missed + ticks.bus_lost + ticks.skipped),
                    fmt::format("{} late, {} failed, {} skipped", ticks.missed, ticks.bus_lost,
                                ticks.skipped)};
          }};
}

}  // namespace tractus::metrics
