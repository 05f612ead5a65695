#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo speed_peaks() {
  return {"speed_peaks",
          "Movement units",
          "1",
          "Number of local maxima of the tip's speed of at least 5 mm/s.",
          "own definition; threshold of the literature's class",
          kBothRigs,
          [](const Subject& subject) {
            return score_of_kinematics(
                subject, [](const TipMotion&, const Kinematics& k) -> std::optional<double> {
                  return double(speed_peaks(k.speed_m_s, 0.005));
                });
          }};
}

}  // namespace tractus::metrics
