#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo economy_of_motion() {
  return {"economy_of_motion",
          "Economy of motion",
          "1",
          "Straight distance from the first to the last point of the tip over its path length: 1 "
          "is the straightest way.",
          "[Oropesa2013]; the inverse is printed too",
          kBothRigs,
          [](const Subject& subject) {
            return score_of_kinematics(
                subject, [](const TipMotion&, const Kinematics& k) -> std::optional<double> {
                  if (!(k.path_m > 0.0)) return std::nullopt;
                  return k.straight_m / k.path_m;
                });
          }};
}

}  // namespace tractus::metrics
