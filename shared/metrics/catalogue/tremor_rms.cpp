#include <cmath>

#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo tremor_rms() {
  return {"tremor_rms",
          "Tremor",
          "m",
          "Root mean square of the tip's position between 8 and 12 Hz, over all axes: Welch's "
          "density (Hann, 256 samples at 200 Hz).",
          "[Novak2017] for the band",
          kBothRigs,
          [](const Subject& subject) {
            return score_of_kinematics(
                subject, [](const TipMotion& motion, const Kinematics&) -> std::optional<double> {
                  double power = 0.0;
                  for (int axis = 0; axis < 3; ++axis) {
                    std::vector<double> values;
                    for (const auto& p : motion.points_m) values.push_back(p[axis]);
                    const auto own = band_power(values, kMotionRate_Hz, 8.0, 12.0);
                    if (!own) return std::nullopt;
                    power += *own;
                  }
                  return std::sqrt(power);
                });
          }};
}

}  // namespace tractus::metrics
