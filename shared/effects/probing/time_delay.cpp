/// The force is recorded late against the motion: what is recorded at t is the law's at t − delay.
#include <algorithm>
#include <vector>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// Cubic Hermite interpolation with central differences as slopes, between samples `i` and `i + 1`.
double between(const std::vector<double>& t, const std::vector<double>& f, std::size_t i,
               double at) {
  const double span = t[i + 1] - t[i];
  if (!(span > 0.0)) return f[i];
  const auto slope = [&](std::size_t k) {
    const std::size_t before = k == 0 ? 0 : k - 1, after = std::min(k + 1, f.size() - 1);
    const double width = t[after] - t[before];
    return width > 0.0 ? span * (f[after] - f[before]) / width : 0.0;
  };
  const double u = (at - t[i]) / span, rise = f[i + 1] - f[i];
  const double from = slope(i) - rise, to = rise - slope(i + 1);
  return f[i] + u * (rise + (1.0 - u) * ((1.0 - u) * from + u * to));
}

class TimeDelay final : public ForceDelay {
 public:
  explicit TimeDelay(std::span<const double> values) : delay_s_(values[0]) {}
  /// Before the first sample the force is taken as that of the first.
  void delay(const ProbingMotion& motion, std::span<double> fz_N) const override {
    if (delay_s_ == 0.0 || fz_N.empty()) return;
    const std::vector<double> law(fz_N.begin(), fz_N.end());
    std::size_t i = 0;
    for (std::size_t k = 0; k < fz_N.size(); ++k) {
      const double at_s = motion.t_s[k] - delay_s_;
      while (i + 1 < k && motion.t_s[i + 1] <= at_s) ++i;
      fz_N[k] = at_s <= motion.t_s.front() ? law.front() : between(motion.t_s, law, i, at_s);
    }
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
                       .high = 0.2}}},
          made<ForceDelay, TimeDelay>};
}

}  // namespace effects::probing
}  // namespace tractus
