#include <cmath>

#include "math/savitzky_golay.hpp"
#include "metrics/tip_motion.hpp"

namespace tractus::metrics {

MetricInfo depth_path() {
  return {"depth_path",
          "Way along the tract",
          "m",
          "Length of the tip's way along the tract's axis, to and fro: its speed there by a "
          "Savitzky–Golay fit (21 samples at 200 Hz, order 3), integrated by the trapezoid rule.",
          "\"depth perception\" of [Oropesa2013], smoothed",
          trial::Rig::palpation,
          [](const Subject& subject) -> Score {
            if (!subject.tract) return {{}, "the tract is not known"};
            return score_of_kinematics(
                subject, [&](const TipMotion& motion, const Kinematics&) -> std::optional<double> {
                  std::vector<double> depth;
                  for (const auto& p : motion.points_m) depth.push_back(p.dot(subject.tract->axis));
                  const auto v = math::SavitzkyGolay(21, 3, 1).apply(depth, 1.0 / kMotionRate_Hz);
                  double sum = 0.0;
                  for (std::size_t i = 1; i < v.size(); ++i)
                    sum += 0.5 * (std::abs(v[i - 1]) + std::abs(v[i])) / kMotionRate_Hz;
                  return sum;
                });
          }};
}

}  // namespace tractus::metrics
