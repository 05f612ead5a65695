#include "station/loop/probing_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace tractus {
namespace loop {
namespace {
namespace registers = devices::rig;
using devices::Exchange;
using devices::RigReading;

constexpr double kPeriod_s = 1e-3, kTravel_m = 0.05;

RigReading at(double x_m, double fz_N = 0.0) {
  RigReading r;
  r.x_m = x_m;
  r.fz_N = fz_N;
  r.status = registers::kEnabled;
  return r;
}

RigReading faulted(registers::RigFault fault) {
  RigReading r = at(0.01);
  r.status = static_cast<std::uint16_t>(registers::kFaulted | unsigned(fault) << 8);
  r.fault = fault;
  return r;
}

class TheGuard : public testing::Test {
 protected:
  ProbingGuard::Passed tick(const RigReading& reading, double speed_m_s, double torque_Nm = 0.0,
                            Exchange how = Exchange::ok) {
    seen_ = guard_.see(how, reading);
    return guard_.pass(speed_m_s, torque_Nm);
  }
  /// Through taring to the first tick in which it moves.
  void enable(double bias_N = 0.0) {
    for (int k = 0; k < 1000 && !guard_.enabled(); ++k) tick(at(0.0, bias_N), 0.0);
    ASSERT_TRUE(guard_.enabled());
  }
  ProbingGuard guard_{RigLimits{}, kTravel_m, kPeriod_s};
  ProbingGuard::LawInput seen_;
};

TEST_F(TheGuard, NothingIsEnabledBeforeTheSensorIsTared) {
  for (int k = 0; k < 199; ++k) {  // 0.2 s
    const auto passed = tick(at(0.0, 3.0), 0.1);
    EXPECT_FALSE(passed.command.enable);
    EXPECT_EQ(passed.command.speed_m_s, 0.0);
  }
  EXPECT_TRUE(tick(at(0.0, 3.0), 0.1).command.enable);
  EXPECT_NEAR(guard_.tare_N(), 3.0, 1e-12);
  tick(at(0.0, 13.0), 0.1);
  EXPECT_NEAR(seen_.fz_N, 10.0, 1e-12);
}

TEST_F(TheGuard, AHandOnTheProbeAtTheStartIsAFault) {
  for (int k = 0; k < 300; ++k) tick(at(0.0, 25.0), 0.1);
  EXPECT_EQ(guard_.fault(), safety::Fault::hand_on);
}

TEST_F(TheGuard, SpeedAndTorqueStayWithinTheirLimits) {
  enable();
  EXPECT_DOUBLE_EQ(tick(at(0.02), 5.0).command.speed_m_s, 0.23);
  EXPECT_DOUBLE_EQ(tick(at(0.02), -5.0).command.speed_m_s, -0.23);
  EXPECT_TRUE(tick(at(0.02), 5.0).limited);
  EXPECT_FALSE(tick(at(0.02), 0.01).limited);
  EXPECT_DOUBLE_EQ(tick(at(0.02), 0.0, 7.0).command.torque_Nm, 0.5);
  EXPECT_EQ(tick(at(0.02), std::numeric_limits<double>::quiet_NaN()).command.speed_m_s, 0.0);
}

TEST_F(TheGuard, TowardsTheProbeStopItSlowsDownAndBeyondItGoesNoFarther) {
  enable();
  // 1 mm before it: 0.001 / 0.01 s.
  EXPECT_NEAR(tick(at(0.049), 0.23).command.speed_m_s, 0.1, 1e-9);
  EXPECT_EQ(tick(at(0.05), 0.23).command.speed_m_s, 0.0);
  EXPECT_EQ(tick(at(0.051), 0.23).command.speed_m_s, 0.0);
  EXPECT_LT(tick(at(0.05), -0.1).command.speed_m_s, 0.0);
  EXPECT_EQ(tick(at(0.0), -0.1).command.speed_m_s, 0.0);
}

TEST_F(TheGuard, APushAboveItsLimitStopsTheStageAndLatchesWhenItStays) {
  enable();
  EXPECT_GT(tick(at(0.02, 179.0), 0.05).command.speed_m_s, 0.0);
  EXPECT_EQ(tick(at(0.02, 181.0), 0.05).command.speed_m_s, 0.0);
  EXPECT_FALSE(guard_.latched());
  EXPECT_GT(tick(at(0.02, 150.0), 0.05).command.speed_m_s, 0.0);
  for (int k = 0; k < 501; ++k) tick(at(0.02, 181.0), 0.05);
  EXPECT_EQ(guard_.fault(), safety::Fault::pushed);
}

TEST_F(TheGuard, WithoutAnAnswerNothingMovesAndAfterFiftyMillisecondsItLatches) {
  enable();
  for (int k = 0; k < 49; ++k) {
    EXPECT_EQ(tick(at(0.02), 0.1, 0.1, Exchange::silent).command.speed_m_s, 0.0);
    EXPECT_FALSE(seen_.fresh);
  }
  EXPECT_FALSE(guard_.latched());
  tick(at(0.02), 0.1, 0.0, Exchange::silent);
  EXPECT_EQ(guard_.fault(), safety::Fault::silent);
  EXPECT_FALSE(tick(at(0.02), 0.1).command.enable);  // no way back
}

TEST_F(TheGuard, APauseSwitchesTheDriveOffUntilTheHandHasLetGo) {
  enable();
  for (int k = 0; k < 5; ++k) tick(at(0.01, 50.0), 0.1);
  guard_.pause(true);
  EXPECT_FALSE(tick(at(0.01, 50.0), 0.1).command.enable);
  EXPECT_TRUE(guard_.paused());
  for (int k = 0; k < 1000; ++k) {
    const auto passed = tick(at(0.01, 50.0), 0.1);
    ASSERT_FALSE(passed.command.enable || passed.command.rotary_on);
    ASSERT_EQ(passed.command.speed_m_s, 0.0);
  }
  guard_.pause(false);
  for (int k = 0; k < 100; ++k)
    ASSERT_FALSE(tick(at(0.01, 11.0), 0.1).command.enable) << "above kTareMost_N, 10 N";
  tick(at(0.01, 2.0), 0.1);
  EXPECT_TRUE(guard_.enabled());
  tick(at(0.01, 2.0), 0.1);
  EXPECT_GT(tick(at(0.01, 50.0), 0.1).command.speed_m_s, 0.0) << "and then by the law";
}

TEST_F(TheGuard, RubbishAndAClosedLineLatchAtOnce) {
  for (const auto& [how, fault] : {std::pair{Exchange::garbage, safety::Fault::garbage},
                                   {Exchange::gone, safety::Fault::gone}}) {
    ProbingGuard guard(RigLimits{}, kTravel_m, kPeriod_s);
    guard.see(how, {});
    EXPECT_EQ(guard.fault(), fault);
    EXPECT_FALSE(guard.pass(0.1, 0.1).command.enable);
  }
}

TEST_F(TheGuard, TheMachinesOwnWatchdogIsClearedAndTheDriveEnabledAnew) {
  enable();
  const auto reset = tick(faulted(registers::RigFault::watchdog), 0.1);
  EXPECT_TRUE(reset.command.reset_fault);
  EXPECT_FALSE(reset.command.enable);
  const auto again = tick(at(0.01), 0.1);
  EXPECT_TRUE(again.command.enable);
  EXPECT_EQ(again.command.speed_m_s, 0.0);  // not with the command that enables
  EXPECT_GT(tick(at(0.01), 0.1).command.speed_m_s, 0.0);
  EXPECT_EQ(guard_.restarts(), 1);
  for (int k = 0; k < 2 * ProbingGuard::kMostRestarts + 2 && !guard_.latched(); ++k) {
    tick(faulted(registers::RigFault::watchdog), 0.1);
    tick(at(0.01), 0.1);
    tick(at(0.01), 0.1);
  }
  EXPECT_EQ(guard_.fault(), safety::Fault::watchdog);
}

TEST_F(TheGuard, EveryOtherFaultOfTheMachineLatches) {
  for (const auto& [theirs, ours] :
       {std::pair{registers::RigFault::stalled, safety::Fault::stalled},
        {registers::RigFault::drive, safety::Fault::drive},
        {registers::RigFault::sensor, safety::Fault::sensor},
        {registers::RigFault::emergency, safety::Fault::emergency}}) {
    ProbingGuard guard(RigLimits{}, kTravel_m, kPeriod_s);
    guard.see(Exchange::ok, faulted(theirs));
    EXPECT_EQ(guard.fault(), ours);
  }
}

// Whatever comes in, in any order.
TEST_F(TheGuard, NeverLetsThroughMoreThanItsLimits) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int run = 0; run < 50; ++run) {
    ProbingGuard guard(RigLimits{}, kTravel_m, kPeriod_s);
    bool latched = false;
    for (int k = 0; k < 2000; ++k) {
      const RigReading reading =
          random() % 500 == 0 ? faulted(registers::RigFault(random() % 6))
                              : at(0.025 + 0.04 * any(random), k < 250 ? 0.0 : 190.0 * any(random));
      const auto how = random() % 50 == 0 ? Exchange::silent : Exchange::ok;
      const auto seen = guard.see(how, reading);
      const auto out = guard.pass(std::exp(10.0 * any(random)) * any(random), 5.0 * any(random));
      const double v = out.command.speed_m_s;
      EXPECT_LE(std::abs(v), 0.23);
      EXPECT_LE(std::abs(out.command.torque_Nm), 0.5);
      if (!seen.fresh || std::abs(seen.fz_N) > 180.0) {
        EXPECT_EQ(v, 0.0);
      }
      if (seen.fresh && reading.x_m >= kTravel_m) {
        EXPECT_LE(v, 0.0);
      }
      if (seen.fresh && reading.x_m <= 0.0) {
        EXPECT_GE(v, 0.0);
      }
      EXPECT_TRUE(!latched || guard.latched());
      latched = guard.latched();
      if (latched) {
        EXPECT_FALSE(out.command.enable || out.command.rotary_on || v != 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace loop
}  // namespace tractus
