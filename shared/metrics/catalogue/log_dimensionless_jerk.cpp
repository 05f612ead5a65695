#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo log_dimensionless_jerk() {
  return {"log_dimensionless_jerk",
          "Log dimensionless jerk",
          "1",
          "Negative logarithm of the integral of the squared second difference of the tip's speed "
          "at 200 Hz times duration cubed over peak speed squared: nearer to 0 is smoother.",
          "[Balasubramanian2015]",
          kBothRigs,
          [](const Subject& subject) {
            return score_of_kinematics(
                subject, [](const TipMotion&, const Kinematics& k) -> std::optional<double> {
                  return log_dimensionless_jerk(k.speed_m_s, kMotionRate_Hz);
                });
          }};
}

}  // namespace tractus::metrics
