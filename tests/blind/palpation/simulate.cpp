#include "palpation/simulate.hpp"

#include <algorithm>
#include <cmath>

namespace blind {
namespace {

/// A slow one-way or bent trend from zero, of unit range.
std::vector<double> trend(Random& random, std::size_t count) {
  const double line = random.normal(), bend = random.normal(), settle = 1.5 * random.normal();
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(count - 1);
    out[i] = line * u + bend * u * u + settle * (1 - std::exp(-3 * u));
  }
  const double low = *std::ranges::min_element(out), high = *std::ranges::max_element(out);
  for (double& value : out) value /= high - low;
  return out;
}

void delay(Wrenches& wrenches, double steps) {
  const Wrenches now = wrenches;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double at = std::max(0.0, static_cast<double>(i) - steps);
    const auto k = std::min(static_cast<std::size_t>(at), now.size() - 2);
    const double f = at - static_cast<double>(k);
    wrenches[i].force_N = (1 - f) * now[k].force_N + f * now[k + 1].force_N;
    wrenches[i].torque_Nm = (1 - f) * now[k].torque_Nm + f * now[k + 1].torque_Nm;
  }
}

void record(Wrenches& wrenches, const std::vector<Hidden>& effects, std::uint64_t trial_seed,
            double dt_s) {
  const auto vec = [](const Hidden& e, const std::string& name) {
    return Vec3(e.of(name, 0), e.of(name, 1), e.of(name, 2));
  };
  for (const Hidden& e : effects) {
    if (e.id == "time_delay") delay(wrenches, e.of("delay_s") / dt_s);
    if (e.id == "sensor_bias")
      for (Wrench& w : wrenches) w.force_N += vec(e, "force_N"), w.torque_Nm += vec(e, "torque_Nm");
    if (e.id == "sensor_drift") {
      Random random(trial_seed ^ 0xD21F7);
      for (int axis = 0; axis < 3; ++axis) {
        const auto shape = trend(random, wrenches.size());
        for (std::size_t i = 0; i < wrenches.size(); ++i)
          wrenches[i].force_N[axis] += e.of("range_N") * shape[i];
      }
    }
  }
}

}  // namespace

std::vector<Palpation> hands_of(const PalpationPlan& plan) {
  Tract tract = plan.tract;
  tract.entry_m -=
      plan.truth.offset_m;  // the hand finds the hole where the probe's own offset puts it
  std::vector<Palpation> out;
  for (const std::uint64_t seed : plan.trial_seeds)
    out.emplace_back(Random(seed), tract, plan.truth, plan.request.duration_s, plan.tempo);
  return out;
}

std::vector<Pose> poses_of(const Palpation& hand, double dt_s, std::size_t count) {
  std::vector<Pose> out;
  for (std::size_t i = 0; i < count + 2; ++i)
    out.push_back(hand.at((static_cast<double>(i) - 1) * dt_s));
  return out;
}

Simulated simulate(const PalpationPlan& plan, const Field& field, const Probe& probe,
                   const std::vector<Hidden>& effects, const std::vector<std::vector<Pose>>& poses,
                   double dt_s) {
  constexpr double kSnap_m_s = 0.06;
  PalpationPhysics physics(field, probe, effects);
  Simulated out;
  double jumps = 0, steps = 0;
  for (std::size_t trial = 0; trial < poses.size(); ++trial) {
    physics.begin();
    Wrenches wrenches;
    Vec2 last(0, 0);
    for (std::size_t i = 1; i + 1 < poses[trial].size(); ++i) {
      wrenches.push_back(
          physics.step(poses[trial][i - 1], poses[trial][i], poses[trial][i + 1], dt_s));
      jumps += i > 1 && (physics.deflection() - last).norm() > kSnap_m_s * dt_s;
      last = physics.deflection();
      steps += 1;
    }
    record(wrenches, effects, plan.trial_seeds[trial], dt_s);
    out.trials.push_back(std::move(wrenches));
  }
  out.jump_share = jumps / std::max(1.0, steps);
  return out;
}

}  // namespace blind
