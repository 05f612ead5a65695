/// The force is recorded late against the motion: what is recorded at t is the law's at t − delay.
#include "effects/delayed.hpp"
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class TimeDelay final : public ForceDelay {
 public:
  explicit TimeDelay(std::span<const double> values) : delay_s_(values[0]) {}
  /// Before the first sample the force is taken as that of the first.
  void delay(const ProbingMotion& motion, std::span<double> fz_N) const override {
    effects::delay(motion.t_s, delay_s_, fz_N);
  }

 private:
  double delay_s_;
};

}  // namespace

ProbingEffectInfo time_delay() {
  return {{.id = "time_delay",
           .label = "time delay",
           .kind = Kind::measurement,
           .summary = "The force is recorded late against the motion",
           .equation = "F(t − delay)",
           .source = "own",
           .experiment = "quick strokes of 3 mm at 1 to 5 per second, and a tap on something hard",
           .params = {{.name = "delay_s",
                       .meaning = "by which the force comes late",
                       .initial = 5e-3,
                       .low = 0.0,
                       .high = 0.2}},
           .is_delay = true},
          made<ForceDelay, TimeDelay>};
}

}  // namespace effects::probing
}  // namespace tractus
