#include "metrics/motion.hpp"
#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo probing_work() {
  return {"probing_work",
          "Work of the push",
          "J",
          "Integral of the push over the depth, by the trapezoid rule, over the motion.",
          "own definition",
          trial::Rig::probing,
          [](const Subject& subject) {
            return score_of_motion(subject, 2, [](std::span<const trial::ProbingSample> motion) {
              std::vector<double> x_m, push;
              for (const auto& s : motion) {
                x_m.push_back(s.x_m);
                push.push_back(push_N(s));
              }
              return integral(x_m, push);
            });
          }};
}

}  // namespace tractus::metrics
