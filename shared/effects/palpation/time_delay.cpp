/// A force that is recorded late against the motion (or early, where the poses come late): what is
/// recorded at t is the force of the motion at t − delay, all of it, weight and inertia too.
#include "effects/palpation_effect.hpp"

namespace tractus {
namespace effects {
namespace {

class TimeDelay final : public MotionDelay {
 public:
  explicit TimeDelay(double seconds) : delay_s_(seconds) {}
  double delay_s() const noexcept override { return delay_s_; }

 private:
  double delay_s_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo time_delay() {
  return {.facts = {.id = "time_delay",
                    .label = "time delay",
                    .kind = Kind::measurement,
                    .summary = "Forces that are recorded late against the motion",
                    .equation = "recorded F(t) = F of the motion at t − delay",
                    .source = "own",
                    .experiment = "quick taps on something hard, three a second",
                    .params = {{.name = "delay_s",
                                .meaning = "how late; below 0: how early",
                                .initial = 0.005,
                                .low = -0.1,
                                .high = 0.2,
                                .step = 5e-4}},
                    .is_delay = true},
          .make = [](std::span<const double> values) -> PalpationEffect {
            return std::make_unique<TimeDelay>(values[0]);
          }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
