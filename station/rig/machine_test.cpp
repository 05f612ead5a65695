#include "station/rig/machine.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace rig {
namespace {

namespace registers = devices::rig;

constexpr Command kOff{};
Command moving(double speed_m_s, double torque_Nm = 0.0) {
  return {registers::kEnable | registers::kRotaryOn, 0, speed_m_s, torque_Nm};
}

/// Runs for a time, with a command every millisecond as a station sends it.
void run(Machine& machine, const Command& command, int milliseconds) {
  for (int k = 0; k < milliseconds; ++k) {
    machine.command(command);
    for (int step = 0; step < 10; ++step) machine.step();
  }
}

/// Without any command.
void run_silent(Machine& machine, int milliseconds) {
  for (int step = 0; step < 10 * milliseconds; ++step) machine.step();
}

RigFault fault_of(const Machine& machine) {
  return static_cast<RigFault>(machine.reading().status >> 8);
}

MachineParameters quiet() {
  MachineParameters p;
  p.sensor = {0.0, 0.0, 0.0, 0.0, 1000.0};
  return p;
}

TEST(Machine, MovesOnlyWhileItIsEnabled) {
  Machine machine{quiet()};
  run(machine, {0, 0, 0.05, 0.0}, 100);
  EXPECT_EQ(machine.reading().x_m, 0.0);
  run(machine, moving(0.05), 100);
  EXPECT_NEAR(machine.reading().x_m, 0.05 * (0.1 - 0.002), 1e-5);  // v (t − τ), 5 µm a step
  EXPECT_TRUE(machine.reading().status & registers::kEnabled);
  run(machine, kOff, 10);
  EXPECT_EQ(machine.reading().v_m_s, 0.0);
}

TEST(Machine, StandsStillWithinTenMillisecondsOfTheLastCommand) {
  Machine machine{quiet()};
  run(machine, moving(0.22), 200);
  ASSERT_GT(machine.reading().v_m_s, 0.2);
  run_silent(machine, 5);
  EXPECT_GT(machine.reading().v_m_s, 0.2);  // a late command is not a lost bus
  run_silent(machine, 4);                   // the last command came 1 ms before
  EXPECT_EQ(machine.reading().v_m_s, 0.0);
  EXPECT_EQ(fault_of(machine), RigFault::watchdog);
}

TEST(Machine, StaysStoppedAfterAFaultUntilItIsResetAndEnabledAnew) {
  Machine machine{quiet()};
  run(machine, moving(0.01), 20);
  run_silent(machine, 20);
  const double x_m = machine.reading().x_m;
  run(machine, moving(0.01), 20);  // as if nothing had been: the bit is not rising
  EXPECT_EQ(machine.reading().x_m, x_m);
  run(machine, kOff, 2);
  run(machine, moving(0.01), 20);  // rising, but the fault is there
  EXPECT_EQ(machine.reading().x_m, x_m);
  run(machine, {registers::kResetFault, 0, 0.0, 0.0}, 2);
  EXPECT_EQ(fault_of(machine), RigFault::none);
  run(machine, moving(0.01), 20);
  EXPECT_GT(machine.reading().x_m, x_m);
}

TEST(Machine, LeavesTheEmergencyStopOnlyToAPerson) {
  Machine machine{quiet()};
  run(machine, moving(0.1), 50);
  World world;
  world.panel.stop_pressed = true;
  machine.set_world(world);
  run(machine, moving(0.1), 4);
  EXPECT_EQ(machine.reading().v_m_s, 0.0);
  EXPECT_TRUE(machine.reading().status & registers::kEmergency);
  world.panel.stop_pressed = false;
  machine.set_world(world);
  for (const std::uint16_t control : std::initializer_list<std::uint16_t>{0, 2, 0, 1, 0, 3, 0, 7})
    run(machine, {control, 0, 0.1, 0}, 3);
  EXPECT_TRUE(machine.reading().status & registers::kEmergency);
  EXPECT_EQ(fault_of(machine), RigFault::emergency);
  EXPECT_EQ(machine.reading().v_m_s, 0.0);
  world.panel.reset_pressed = true;
  machine.set_world(world);
  run(machine, moving(0.1), 5);
  EXPECT_FALSE(machine.reading().status & registers::kEmergency);
  EXPECT_EQ(machine.reading().v_m_s, 0.0);  // reset never starts a motion
  run(machine, kOff, 1);
  run(machine, moving(0.1), 20);
  EXPECT_GT(machine.reading().v_m_s, 0.09);
}

TEST(Machine, ShowsTheStartButtonAndMovesNothingForIt) {
  Machine machine{quiet()};
  World world;
  world.panel.start_pressed = true;
  machine.set_world(world);
  run(machine, kOff, 20);
  EXPECT_TRUE(machine.reading().status & registers::kStartPressed);
  EXPECT_FALSE(machine.reading().status & registers::kEnabled);
  EXPECT_EQ(machine.reading().v_m_s, 0.0);
  world.panel.start_pressed = false;
  machine.set_world(world);
  run(machine, kOff, 1);
  EXPECT_FALSE(machine.reading().status & registers::kStartPressed);
}

TEST(Machine, IsNotResetWhileTheEmergencyStopIsPressed) {
  Machine machine{quiet()};
  World world;
  world.panel = {true, true, false};
  machine.set_world(world);
  run(machine, kOff, 5);
  EXPECT_TRUE(machine.reading().status & registers::kEmergency);
  world.panel.stop_pressed = false;  // the reset button was held all the time: no edge
  machine.set_world(world);
  run(machine, kOff, 5);
  EXPECT_TRUE(machine.reading().status & registers::kEmergency);
}

TEST(Machine, FaultsWhenTheHandIsStrongerThanTheActuator) {
  Machine machine{quiet()};
  World world;
  world.hand_force_N = 700.0;
  machine.set_world(world);
  run(machine, moving(0.001), 10);
  EXPECT_EQ(fault_of(machine), RigFault::stalled);
}

TEST(Machine, FaultsWithItsDrive) {
  Machine machine{quiet()};
  run(machine, moving(0.1), 20);
  World world;
  world.panel.drive_error = true;
  machine.set_world(world);
  run(machine, moving(0.1), 5);
  EXPECT_EQ(fault_of(machine), RigFault::drive);
  EXPECT_EQ(machine.reading().v_m_s, 0.0);
}

TEST(Machine, TurnsAsFastAsHandAndFrictionAllow) {
  // At rest of ω̇: ω = τ / b = 0.001 / 0.001 = 1 rad/s; time constant J / b = 0.2 s, so 2 s are ten
  // of it.
  Machine machine{quiet()};
  World world;
  world.hand_torque_Nm = 0.001;
  machine.set_world(world);
  run(machine, kOff, 2000);
  EXPECT_NEAR(machine.reading().omega_rad_s, 1.0, 1e-3);
  EXPECT_EQ(machine.reading().torque_Nm, 0.001);
  // A motor that resists with as much brings it to rest; switched off it does nothing.
  run(machine, {registers::kRotaryOn, 0, 0.0, -0.001}, 2000);
  EXPECT_NEAR(machine.reading().omega_rad_s, 0.0, 1e-3);
  run(machine, {0, 0, 0.0, -0.001}, 2000);
  EXPECT_NEAR(machine.reading().omega_rad_s, 1.0, 1e-3);
}

TEST(Sensor, HasTheNoiseAndABiasOfItsParameters) {
  // Mean of 10 000: 0.05 / 100 = 0.0005 N; four of them. Sample deviation: 0.7 %; four of them.
  Sensor sensor({.force_bias_sd_N = 0.5, .force_noise_N = 0.05}, 7);
  double sum = 0.0, squares = 0.0;
  for (int k = 0; k < 10000; ++k) {
    sensor.sample(80.0, 0.0);
    const double off = sensor.force_N() - 80.0 - sensor.force_bias_N();
    sum += off;
    squares += off * off;
  }
  EXPECT_NEAR(sum / 1e4, 0.0, 0.002);
  EXPECT_NEAR(std::sqrt(squares / 1e4), 0.05, 0.0015);
  EXPECT_NE(sensor.force_bias_N(), 0.0);
  EXPECT_LT(std::abs(sensor.force_bias_N()), 2.0);  // four standard deviations
}

TEST(Machine, GivesTheSameBitsForTheSameSeedAndOthersForAnother) {
  const auto last = [](std::uint64_t seed) {
    MachineParameters p;
    p.seed = seed;
    Machine machine{p};
    World world;
    world.surgeon = true;
    machine.set_world(world);
    run(machine, moving(0.005), 300);
    return machine.reading();
  };
  EXPECT_EQ(last(3).force_N, last(3).force_N);
  EXPECT_EQ(last(3).theta_rad, last(3).theta_rad);
  EXPECT_NE(last(3).force_N, last(4).force_N);
}

/// A station in front of the machine, as simple as one can be: the stage yields F / D.
double yield(Machine& machine, double damping_Ns_per_m, int milliseconds) {
  double most_N = 0.0;
  for (int k = 0; k < milliseconds; ++k) {
    const double force_N = machine.reading().force_N;
    most_N = std::max(most_N, force_N);
    run(machine, moving(std::min(0.15, force_N / damping_Ns_per_m)), 1);
  }
  return most_N;
}

TEST(Surgeon, AdvancesAtAboutItsGoalAndTurnsTheProbe) {
  Machine machine{quiet()};
  World world;
  world.surgeon = true;
  machine.set_world(world);
  const double most_N = yield(machine, 8000.0, 4000);
  // 6 mm/s ± 10 % after the spring of the hand is loaded: 48 N / 3000 N/m = 16 mm behind at most.
  EXPECT_GT(machine.reading().x_m, 4.0 * 0.0054 - 0.018);
  EXPECT_LT(machine.reading().x_m, 4.0 * 0.0066);
  EXPECT_LE(most_N, 150.0);
  // Turning: wrist 0.05 against bearings 0.001: 98 % of 0.8 rad/s ± 10 %; above 10 °/s.
  EXPECT_NEAR(machine.reading().omega_rad_s, 0.78, 0.09);
}

TEST(Surgeon, LetsGoAfterItsReactionTimeWhenTheBoneGivesWay) {
  Machine machine{quiet()};
  World world;
  world.surgeon = true;
  machine.set_world(world);
  yield(machine, 20000.0, 6000);  // loaded: about 6 mm/s would take 120 N
  ASSERT_GT(machine.reading().force_N, 60.0);
  yield(machine, 1000.0, 100);  // gave way; reaction takes 0.18 s at least
  EXPECT_GT(machine.reading().force_N, 0.0);
  yield(machine, 1000.0, 160);  // 0.26 s: after 0.22 s at most it has let go, for 0.5 s
  EXPECT_EQ(machine.reading().force_N, 0.0);
}

/// As after an emergency stop in the middle of a trial: whoever holds on is told to let go at 30 N.
TEST(Surgeon, LetsGoOfAStageThatReturnsToTheEntryAndStartsThere) {
  Machine machine{quiet()};
  World world;
  world.surgeon = true;
  machine.set_world(world);
  yield(machine, 8000.0, 6000);
  ASSERT_GT(machine.reading().x_m, 0.02);
  run(machine, kOff, 500);  // longer than its reaction time
  double most_N = 0.0;
  while (machine.reading().x_m > 0.0005) {
    run(machine, moving(-0.02), 1);
    most_N = std::max(most_N, machine.reading().force_N);
  }
  EXPECT_LT(most_N, 5.0);
  run(machine, moving(0.0), 1000);
  EXPECT_GT(machine.reading().force_N, 10.0);  // 3000 N/m, 6 mm/s: at work again
}

TEST(Surgeon, KeepsItsHandsOffAStageThatIsNotEnabled) {
  Machine machine{quiet()};
  World world;
  world.surgeon = true;
  machine.set_world(world);
  run(machine, kOff, 500);
  EXPECT_EQ(machine.reading().force_N, 0.0);
  EXPECT_EQ(machine.reading().omega_rad_s, 0.0);
}

}  // namespace
}  // namespace rig
}  // namespace tractus
