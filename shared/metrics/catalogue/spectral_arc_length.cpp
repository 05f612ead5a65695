#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo spectral_arc_length() {
  MetricInfo info{
      "spectral_arc_length",
      "Spectral arc length",
      "1",
      "SPARC of the tip's speed at 200 Hz: nearer to 0 is smoother, a minimum-jerk movement "
      "has -1.41.",
      "[Balasubramanian2015]",
      kBothRigs,
      [](const Subject& subject) {
        return score_of_kinematics(
            subject, [](const TipMotion&, const Kinematics& k) -> std::optional<double> {
              return spectral_arc_length(k.speed_m_s, kMotionRate_Hz);
            });
      }};
  info.followed = 7;
  return info;
}

}  // namespace tractus::metrics
