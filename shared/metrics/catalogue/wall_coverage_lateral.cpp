#include "metrics/coverage_score.hpp"

namespace tractus::metrics {

MetricInfo wall_coverage_lateral() {
  MetricInfo info{
      "wall_coverage_lateral",
      "Lateral wall covered",
      "1",
      "Share of the lateral wall (a quarter turn, 10 depths × 3 angles) "
      "in which the force across the tract's axis reached 0.01 N.",
      "own definition",
      trial::Rig::palpation,
      [](const Subject& subject) { return coverage_score(subject, volume::Wall::lateral); }};
  info.shown_as = ShownAs::share;
  return info;
}

}  // namespace tractus::metrics
