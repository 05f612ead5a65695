/// The tuned scenarios on the simulated rig under the simulated surgeon, in simulated time: law,
/// scenario and machine fit together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "laws/probing_law.hpp"
#include "scenarios/scenario.hpp"
#include "station/rig/machine.hpp"

namespace tractus {
namespace {

namespace registers = devices::rig;
using scenarios::Kind;

struct Trial {
  double duration_s = 0.0, mean_N = 0.0, most_N = 0.0;
  double bone_speed_m_s = 0.0, breach_speed_m_s = 0.0, before_breach_N = 0.0;
  bool faulted = false, reached_stop = false;
};

/// The smallest station there can be: read, law, write, once a millisecond.
Trial run(Kind kind, std::uint64_t seed, double skill) {
  const auto scenario = *scenarios::tuned(kind);
  const auto law = *laws::ProbingLaw::make(*scenario.expanded());
  rig::MachineParameters parameters;
  parameters.seed = seed;
  parameters.linear.travel_m = scenario.travel_m;
  parameters.surgeon = rig::SurgeonParameters::of_skill(skill);
  rig::Machine machine(parameters);
  rig::World world;
  world.surgeon = true;
  machine.set_world(world);
  Trial trial;
  int ticks = 0;
  for (; ticks < 60000 && !trial.reached_stop && !trial.faulted; ++ticks) {
    const rig::Reading r = machine.reading();
    laws::ProbingState state{r.x_m, laws::ProbingMode::holding};
    const double speed_m_s = law.advance(r.force_N, r.omega_rad_s, 1e-3, state);
    const double torque_Nm = -law.torque_Nm(r.x_m, r.theta_rad, r.omega_rad_s);
    machine.command({registers::kEnable | registers::kRotaryOn, 0, speed_m_s, torque_Nm});
    for (int step = 0; step < 10; ++step) machine.step();
    trial.mean_N += r.force_N;
    trial.most_N = std::max(trial.most_N, r.force_N);
    if (law.mode_at(r.x_m) == laws::ProbingMode::breach)
      trial.breach_speed_m_s = std::max(trial.breach_speed_m_s, r.v_m_s);
    else if (trial.breach_speed_m_s == 0.0)
      trial.before_breach_N = r.force_N;
    if (trial.breach_speed_m_s == 0.0)
      trial.bone_speed_m_s = std::max(trial.bone_speed_m_s, r.v_m_s);
    trial.faulted = r.status & registers::kFaulted;
    trial.reached_stop = r.x_m >= scenario.travel_m - 1e-5;
  }
  trial.duration_s = 1e-3 * ticks;
  trial.mean_N /= ticks;
  return trial;
}

constexpr struct {
  std::uint64_t seed;
  double skill;
} kHands[] = {{1, 0.0}, {2, 0.5}, {3, 1.0}, {4, 0.5}};

class EveryTunedScenario : public testing::TestWithParam<Kind> {};

TEST_P(EveryTunedScenario, IsPlayedToTheProbeStopByASimulatedSurgeonWithoutAFault) {
  for (const auto& [seed, skill] : kHands) {
    const Trial trial = run(GetParam(), seed, skill);
    EXPECT_FALSE(trial.faulted);
    EXPECT_TRUE(trial.reached_stop);
    EXPECT_LT(trial.most_N, 155.0);  // 150 N and five times the sensor's bias and noise
    EXPECT_GT(trial.duration_s, 2.0);
    EXPECT_LT(trial.duration_s, 30.0);
  }
}
INSTANTIATE_TEST_SUITE_P(Rig, EveryTunedScenario,
                         testing::Values(Kind::hard, Kind::soft, Kind::lateral_breach,
                                         Kind::in_out_in));

TEST(ABreach, IsASuddenJumpInSpeedOnTheRig) {
  for (const Kind kind : {Kind::lateral_breach, Kind::in_out_in})
    for (const auto& [seed, skill] : kHands) {
      const Trial trial = run(kind, seed, skill);
      EXPECT_GT(trial.breach_speed_m_s, 3.0 * trial.bone_speed_m_s);
      EXPECT_GT(trial.before_breach_N, 100.0);
    }
}

TEST(HardBone, TakesAboutTwiceThePushOfSoftBone) {
  for (const auto& [seed, skill] : kHands) {
    const double ratio = run(Kind::hard, seed, skill).mean_N / run(Kind::soft, seed, skill).mean_N;
    EXPECT_GT(ratio,
              1.5);  // the surgeon's own spring evens it out a little: he is slower in hard bone
    EXPECT_LT(ratio, 2.1);
  }
}

}  // namespace
}  // namespace tractus
