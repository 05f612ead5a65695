#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo force_impulse() {
  return {"force_impulse",
          "Impulse of the force",
          "N·s",
          "Integral of the force over time at 200 Hz, by the trapezoid rule.",
          "[Trejos2014]",
          kBothRigs,
          [](const Subject& subject) {
            return score_of_kinematics(
                subject, [](const TipMotion& motion, const Kinematics&) -> std::optional<double> {
                  std::vector<double> t_s;
                  for (std::size_t i = 0; i < motion.force_N.size(); ++i)
                    t_s.push_back(double(i) / kMotionRate_Hz);
                  return integral(t_s, motion.force_N);
                });
          }};
}

}  // namespace tractus::metrics
