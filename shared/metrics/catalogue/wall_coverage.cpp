#include "metrics/coverage_score.hpp"

namespace tractus::metrics {

MetricInfo wall_coverage() {
  return {"wall_coverage",
          "Walls covered",
          "1",
          "Share of the side walls, unrolled into 10 depths × 12 angles, "
          "in which the force across the tract's axis reached 0.01 N.",
          "own definition",
          [](const Subject& subject) { return coverage_score(subject, std::nullopt); }};
}

}  // namespace tractus::metrics
