#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo tip_speed_mean() {
  return {"tip_speed_mean",
          "Mean speed of the tip",
          "m/s",
          "Path length over duration of the motion at 200 Hz.",
          "own definition",
          kBothRigs,
          [](const Subject& subject) {
            return score_of_kinematics(
                subject, [](const TipMotion&, const Kinematics& k) -> std::optional<double> {
                  return k.path_m / k.duration_s;
                });
          }};
}

}  // namespace tractus::metrics
