/// A sensor whose zero wanders slowly over a trial. Its course is another one in every trial, so a
/// model cannot predict it and a replay adds nothing: the lab takes it out of each trial by itself
/// and reports how far it went.
#include "effects/palpation_effect.hpp"

namespace tractus::effects::palpation {

PalpationEffectInfo sensor_drift() {
  return {.facts = {.id = "sensor_drift",
                    .label = "sensor drift",
                    .kind = Kind::measurement,
                    .summary = "A slow trend of the sensor's zero, another one in each trial",
                    .equation = "recorded = true + slow trend over the trial, per axis",
                    .source = "own",
                    .experiment = "two trials of 60 s with free air at their ends",
                    .params = {{.name = "range_N",
                                .meaning = "from the lowest to the highest of the trend in a trial",
                                .initial = 0.1,
                                .low = 0.0,
                                .high = 50.0}},
                    .parents = {"sensor_bias"},
                    .free_per_trial = true},
          .make = [](std::span<const double>) -> PalpationEffect { return FreePerTrial{}; }};
}

}  // namespace tractus::effects::palpation
