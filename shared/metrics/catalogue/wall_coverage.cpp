#include "metrics/coverage_score.hpp"

namespace tractus::metrics {

MetricInfo wall_coverage() {
  MetricInfo info{"wall_coverage",
                  "Walls covered",
                  "1",
                  "Share of the side walls, unrolled into 10 depths × 12 angles, "
                  "in which the force across the tract's axis reached 0.01 N.",
                  "own definition",
                  trial::Rig::palpation,
                  [](const Subject& subject) { return coverage_score(subject, std::nullopt); }};
  info.shown_as = ShownAs::share;
  info.followed = 8;
  return info;
}

}  // namespace tractus::metrics
