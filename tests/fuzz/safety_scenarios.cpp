#include "tests/fuzz/safety_scenarios.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "scenarios/scenario.hpp"
#include "station/loop/probing_loop.hpp"

namespace tractus {
namespace fuzz {
namespace {
namespace registers = devices::rig;
using devices::Exchange;

constexpr double kTravel_m = 0.05, kRate_Hz = 100.0;
constexpr int kTicks = 90;  // 0.2 s of taring are 20 of them

/// Random numbers of one run.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<>()(random_);
  }
  /// Ends and spans of decades more often than the middle.
  double anywhere(double low, double high) {
    if (rarely(0.1)) return rarely(0.5) ? low : high;
    if (low > 0.0 && high / low > 100.0) return low * std::pow(high / low, between(0, 1));
    return between(low, high);
  }
  bool rarely(double share) { return between(0.0, 1.0) < share; }
  std::size_t one_of(std::size_t count) { return std::size_t(random_() % count); }

 private:
  std::mt19937_64 random_;
};

scenarios::Scenario draw_scenario(Dice& dice) {
  scenarios::Scenario s;
  s.name = "fuzzed";
  s.kind = scenarios::Kind(dice.one_of(4));
  s.bone = {.stiffness_N_per_m = dice.anywhere(0.0, 2e5),
            .damping_Ns_per_m = dice.anywhere(1e-3, 1e6),
            .equilibrium_m = -dice.anywhere(0.0, 0.05),
            .interval_m = dice.anywhere(1e-3, kTravel_m)};
  s.breach = {.resistance_interval_m = dice.anywhere(0.0, 0.01),
              .resistance_factor_per_m = dice.anywhere(0.0, 1e5),
              .breach_interval_m = dice.anywhere(1e-4, 0.02),
              .breach_damping_Ns_per_m = dice.anywhere(1e-3, 1e6)};
  const bool walled =
      s.kind == scenarios::Kind::lateral_breach || s.kind == scenarios::Kind::in_out_in;
  if (walled) s.walls_m = {dice.between(0.01, 0.03)};
  s.density = dice.anywhere(0.05, 20.0);
  s.travel_m = kTravel_m;
  return s;
}

std::vector<effects::EffectInstance> draw_effects(Dice& dice) {
  std::vector<effects::EffectInstance> out;
  for (const effects::ProbingEffectInfo& info : effects::probing_effects()) {
    if (!dice.rarely(0.15)) continue;
    effects::EffectInstance use{.id = info.facts.id, .values = {}};
    for (const effects::Param& p : info.facts.params)
      for (int c = 0; c < p.components; ++c) use.values.push_back(dice.anywhere(p.low, p.high));
    out.push_back(std::move(use));
  }
  return out;
}

/// A stage under a wild hand; holds what it is commanded against the promises.
class WildRig final : public devices::RigDevice {
 public:
  WildRig(Dice& dice, const loop::ProbingGuard& guard, core::ManualClock& clock, Outcome& outcome)
      : dice_(dice), guard_(guard), clock_(clock), outcome_(outcome) {}
  core::Result<devices::RigIdentity> open() override { return devices::RigIdentity{}; }
  void close() noexcept override {}

  Exchange exchange(const devices::RigCommand& c, devices::RigReading& out) noexcept override {
    judge(c);
    clock_.advance(dice_.rarely(0.02) ? 30'000'000 : 100'000);
    if (dice_.rarely(0.01)) return Exchange::silent;
    if (dice_.rarely(0.002)) return dice_.rarely(0.5) ? Exchange::garbage : Exchange::gone;
    if (ticks_ > 20 && dice_.rarely(0.2)) push_N_ = dice_.between(-200.0, 200.0);
    x_m_ = std::clamp(x_m_ + (c.enable ? c.speed_m_s : 0.0) / kRate_Hz, -1e-3, kTravel_m + 1e-3);
    if (dice_.rarely(0.01)) x_m_ = dice_.between(0.0, kTravel_m);
    out = {};
    out.status = c.enable ? registers::kEnabled : 0;
    out.x_m = x_m_;
    out.speed_m_s = c.speed_m_s;
    out.turning_rad_s = dice_.between(-3.0, 3.0);
    out.angle_urad = std::int32_t(dice_.between(-2e9, 2e9));
    out.fz_N = ++ticks_ > 20 ? push_N_ : 0.0;
    if (dice_.rarely(0.005)) {
      out.status |= registers::kFaulted;
      out.fault = registers::RigFault(1 + dice_.one_of(5));
    }
    return Exchange::ok;
  }

 private:
  void judge(const devices::RigCommand& c) noexcept {
    const loop::RigLimits most;
    const double speed = std::abs(c.speed_m_s), torque = std::abs(c.torque_Nm);
    if (!(speed <= most.max_speed_m_s)) outcome_.broken = "speed above the clamp";
    if (!(torque <= most.max_torque_Nm)) outcome_.broken = "torque above the clamp";
    if (guard_.latched() && (c.enable || c.rotary_on || speed > 0.0 || torque > 0.0))
      outcome_.broken = "a command after a fault";
    outcome_.moved = outcome_.moved || speed > 0.0;
    outcome_.highest =
        std::max({outcome_.highest, speed / most.max_speed_m_s, torque / most.max_torque_Nm});
  }
  Dice& dice_;
  const loop::ProbingGuard& guard_;
  core::ManualClock& clock_;
  Outcome& outcome_;
  double x_m_ = 0.0, push_N_ = 0.0;
  int ticks_ = 0;
};
}  // namespace

Outcome run_probing(std::uint64_t seed) {
  Dice dice(seed);
  Outcome out;
  core::Result<models::ProbingRuntime> law = core::Error{};
  for (int tries = 0; tries < 50 && !out.made; ++tries) {
    const auto numbers = draw_scenario(dice).expanded();
    if (!numbers) continue;
    law = models::ProbingRuntime::make(*numbers, draw_effects(dice));
    out.made = bool(law);
  }
  if (!out.made) return out;
  core::ManualClock clock;
  loop::ProbingGuard guard(
      loop::RigLimits{.max_push_N = 1e9, .max_speed_m_s = 1e9, .max_torque_Nm = 1e9}, kTravel_m,
      1.0 / kRate_Hz);
  WildRig rig(dice, guard, clock, out);
  loop::ProbingRing ring(256);
  loop::Seqlock<loop::ProbingLoopSnapshot> live;
  loop::ProbingLoop loop({clock, clock, rig, guard, ring, live}, *law, kTravel_m, kRate_Hz);
  int left = kTicks;
  loop.run([&](const trial::ProbingSample&) {
    if (--left <= 0) loop.stop();
  });
  return out;
}

}  // namespace fuzz
}  // namespace tractus
