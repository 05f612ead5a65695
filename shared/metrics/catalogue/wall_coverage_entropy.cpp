#include <cmath>

#include "metrics/metric.hpp"

namespace tractus::metrics {

MetricInfo wall_coverage_entropy() {
  MetricInfo info{
      "wall_coverage_entropy",
      "Evenness of the walls' palpation",
      "1",
      "Entropy of the contacts over the wall's bins, over that of an even spread: 1 is even, 0 "
      "is one bin.",
      "own definition",
      trial::Rig::palpation,
      [](const Subject& subject) -> Score {
        if (!subject.tract) return {{}, "the tract is not known"};
        const auto& bins = coverage(subject);
        if (!bins) return {{}, "the trial does not say how long the probe is"};
        double total = 0.0, entropy = 0.0;
        for (const auto count : bins->samples) total += count;
        if (total == 0.0) return {{}, "no wall was touched"};
        for (const auto count : bins->samples)
          if (count > 0) entropy -= count / total * std::log(count / total);
        return {entropy / std::log(double(bins->samples.size())), ""};
      }};
  info.shown_as = ShownAs::share;
  return info;
}

}  // namespace tractus::metrics
