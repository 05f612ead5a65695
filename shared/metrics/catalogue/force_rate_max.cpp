#include <algorithm>
#include <cmath>

#include "math/savitzky_golay.hpp"
#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo force_rate_max() {
  return {"force_rate_max",
          "Largest rate of force",
          "N/s",
          "Largest change of the force per time, by a Savitzky–Golay fit (21 samples at 200 Hz, "
          "order 3).",
          "[Trejos2014], filter our own",
          kBothRigs,
          [](const Subject& subject) {
            return score_of_kinematics(
                subject, [](const TipMotion& motion, const Kinematics&) -> std::optional<double> {
                  double most = 0.0;
                  for (const double rate :
                       math::SavitzkyGolay(21, 3, 1).apply(motion.force_N, 1.0 / kMotionRate_Hz))
                    most = std::max(most, std::abs(rate));
                  return most;
                });
          }};
}

}  // namespace tractus::metrics
