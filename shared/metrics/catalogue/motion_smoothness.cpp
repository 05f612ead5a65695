#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo motion_smoothness() {
  return {"motion_smoothness",
          "Motion smoothness (jerk)",
          "1",
          "Square root of half the integral of the squared jerk times duration to the fifth over "
          "path length squared: larger is less smooth.",
          "[Cotin2002]",
          kBothRigs,
          [](const Subject& subject) {
            return score_of_kinematics(
                subject, [](const TipMotion&, const Kinematics& k) -> std::optional<double> {
                  if (!(k.path_m > 0.0)) return std::nullopt;
                  return k.motion_smoothness();
                });
          }};
}

}  // namespace tractus::metrics
