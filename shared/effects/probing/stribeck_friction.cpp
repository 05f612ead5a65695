/// Dry friction that falls with speed: F = (F_c + (F_s − F_c) exp(−(v/v_s)²)) sgn v.
#include <algorithm>
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class StribeckFriction final : public ProbeForce {
 public:
  explicit StribeckFriction(std::span<const double> values)
      : friction_N_(values[0]), breakaway_N_(values[1]), velocity_m_s_(values[2]) {}
  double force_N(const ProbingTick& tick, double, ProbingMemory&) const noexcept override {
    const double u = tick.v_m_s / velocity_m_s_;
    const double size_N = friction_N_ + (breakaway_N_ - friction_N_) * std::exp(-u * u);
    return size_N * direction(tick.v_m_s, tick.rest_m_s);
  }

 private:
  double friction_N_, breakaway_N_, velocity_m_s_;
};

/// Speeds that occur.
Starts stribeck_friction_starts(const ProbingStatistics& recordings) {
  Starts out;
  for (const double v : spread(std::max(2e-4, recordings.slow_m_s), recordings.fast_m_s, 7))
    out.push_back({1.0, 1.0, std::clamp(v, 1e-4, 0.2)});
  return out;
}

}  // namespace

ProbingEffectInfo stribeck_friction() {
  return {
      {.id = "stribeck_friction",
       .label = "Stribeck friction",
       .kind = Kind::force,
       .summary = "Dry friction that is greater at low speed, so that the probe sticks and slips",
       .equation = "(F_c + (F_s − F_c) exp(−(v/v_s)²)) sgn v",
       .source = "Olsson1998, Stribeck friction",
       .experiment = "strokes in and out at constant speeds from 0.5 to 30 mm/s, slow ones of 0.5 "
                     "and 1 mm/s among them",
       .params = {{.name = "friction_N",
                   .meaning = "F_c, friction at speed",
                   .initial = 1.0,
                   .low = 0.0,
                   .high = 200.0},
                  {.name = "breakaway_N",
                   .meaning = "F_s, friction as the motion begins",
                   .initial = 2.0,
                   .low = 0.0,
                   .high = 400.0},
                  {.name = "stribeck_velocity_m_s",
                   .meaning = "v_s, speed at which the surplus has fallen to 1/e",
                   .initial = 4e-3,
                   .low = 1e-4,
                   .high = 0.2,
                   .off = kNoOff,
                   .logarithmic = true}},
       .parents = {"coulomb_friction"},
       .is_dry = true,
       .admissible = [](std::span<const double> v) { return v[1] >= v[0]; }},
      made<ProbeForce, StribeckFriction>,
      stribeck_friction_starts};
}

}  // namespace effects::probing
}  // namespace tractus
