#include <algorithm>

#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo tip_speed_max() {
  return {"tip_speed_max",
          "Largest speed of the tip",
          "m/s",
          "Largest speed of the tip, by a Savitzky–Golay fit (21 samples at 200 Hz, order 3).",
          "own definition",
          kBothRigs,
          [](const Subject& subject) {
            return score_of_kinematics(
                subject, [](const TipMotion&, const Kinematics& k) -> std::optional<double> {
                  return std::ranges::max(k.speed_m_s);
                });
          }};
}

}  // namespace tractus::metrics
