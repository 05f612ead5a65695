#include "station/loop/limiter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace tractus {
namespace loop {
namespace {
using devices::Sample;
using devices::Status;
using math::Vec3;
using math::Wrench;
constexpr core::Instant_ns kLimiterPeriod = 250'000;

HandLimits quick() {
  HandLimits limits;
  limits.ramp_s = 0.2;  // the shortest there is
  return limits;
}

/// A limiter with a still handle, ticking.
struct LimiterBench {
  Limiter limiter;
  core::Instant_ns now = 1'000'000;
  Sample sample;
  Status status = Status::ok;

  explicit LimiterBench(const HandLimits& limits = quick()) : limiter(limits, kLimiterPeriod) {
    limiter.arm();
  }
  Limiter::Passed tick(const Wrench& wanted) {
    now += kLimiterPeriod;
    if (status == Status::ok) sample.stamp = now;
    return limiter.pass(now, status, sample, wanted);
  }
  void settle() {  // past the quiet moment and the ramp
    for (int i = 0; i < 900; ++i) tick({});
    EXPECT_EQ(limiter.guard(), Guard::on);
  }
};

Wrench push(double x_N) { return {{x_N, 0, 0}, Vec3::Zero()}; }

TEST(Limiter, LetsASmallForceThroughUnchanged) {
  LimiterBench bench;
  bench.settle();
  for (int i = 0; i < 10; ++i) bench.tick(push(1.5));
  const auto passed = bench.tick(push(1.5));
  EXPECT_EQ(passed.wrench.force_N, Vec3(1.5, 0, 0));
  EXPECT_FALSE(passed.limited);
}

TEST(Limiter, GivesNothingWhileNobodyHasArmedIt) {
  LimiterBench bench;
  bench.limiter.disarm();
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(bench.tick(push(1.0)).wrench.force_N.isZero(0.0));
}

TEST(Limiter, WaitsForAQuietMomentBeforeTheRamp) {
  LimiterBench bench;
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(bench.tick(push(5.0)).wrench.force_N.isZero(0.0));
  EXPECT_EQ(bench.limiter.guard(), Guard::waiting);
}

TEST(Limiter, APauseTakesTheForceAwayAtTheSlewRateAndItComesBackByTheRamp) {
  HandLimits limits;
  limits.max_force_slew_N_per_s = 2000.0;  // 0.5 N in a tick of 0.25 ms
  limits.ramp_s = 0.2;
  LimiterBench bench(limits);
  bench.settle();
  for (int i = 0; i < 50; ++i) bench.tick(push(3.0));
  bench.limiter.pause(true);
  EXPECT_FALSE(bench.limiter.paused());
  double last_N = 3.0;
  for (int i = 0; i < 7; ++i) {  // 3 N / 0.5 N, and one for the rounding
    const double now_N = bench.tick(push(3.0)).wrench.force_N.x();
    EXPECT_LE(last_N - now_N, 0.5 + 1e-9);
    last_N = now_N;
  }
  EXPECT_TRUE(bench.limiter.paused());
  for (int i = 0; i < 4000; ++i) ASSERT_TRUE(bench.tick(push(3.0)).wrench.force_N.isZero(0.0));

  bench.limiter.pause(false);
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE(bench.tick(push(3.0)).wrench.force_N.isZero(0.0)) << "the hand is in the wall yet";
  for (int i = 0; i < Limiter::kQuietTicks; ++i) bench.tick({});
  for (int i = 0; i < 400; ++i) last_N = bench.tick(push(3.0)).wrench.force_N.x();
  EXPECT_NEAR(last_N, 1.5, 0.02) << "half of the ramp of 0.2 s";
}

TEST(Limiter, AFaultInAPauseLatches) {
  LimiterBench bench;
  bench.settle();
  bench.limiter.pause(true);
  for (int i = 0; i < 10; ++i) bench.tick({});
  bench.status = Status::gone;
  bench.tick({});
  EXPECT_EQ(bench.limiter.fault(), Fault::unplugged);
  bench.limiter.pause(false);
  bench.status = Status::ok;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(bench.tick(push(1.0)).wrench.force_N.isZero(0.0));
}

TEST(Limiter, RampsFromNothingToAllInTheStatedTime) {
  HandLimits limits;
  limits.ramp_s = 0.5;
  LimiterBench bench(limits);
  for (int i = 0; i < Limiter::kQuietTicks; ++i) bench.tick({});
  // From here the ramp runs: after half of 0.5 s, 1000 ticks of 0.25 ms, half of 4 N.
  Limiter::Passed passed;
  for (int i = 0; i < 1000; ++i) passed = bench.tick(push(4.0));
  EXPECT_NEAR(passed.wrench.force_N.x(), 2.0, 0.01);
  for (int i = 0; i < 1001; ++i) passed = bench.tick(push(4.0));
  EXPECT_EQ(passed.wrench.force_N.x(), 4.0);
}

TEST(Limiter, LatchesOnEachFaultInTheVeryTickAndStaysAtZeroUntilArmed) {
  const auto check = [](Fault expected, auto&& spoil) {
    LimiterBench bench;
    bench.settle();
    for (int i = 0; i < 50; ++i) bench.tick(push(3.0));
    Wrench wanted = push(3.0);
    spoil(bench, wanted);
    EXPECT_TRUE(bench.tick(wanted).wrench.force_N.isZero(0.0)) << text_of(expected);
    EXPECT_EQ(bench.limiter.fault(), expected);
    bench.sample = {};
    bench.status = Status::ok;
    for (int i = 0; i < 1000; ++i)
      ASSERT_TRUE(bench.tick(push(3.0)).wrench.force_N.isZero(0.0)) << text_of(expected);
    bench.limiter.arm();
    bench.settle();
    for (int i = 0; i < 50; ++i) bench.tick(push(3.0));
    EXPECT_EQ(bench.tick(push(3.0)).wrench.force_N.x(), 3.0) << text_of(expected);
  };
  check(Fault::not_finite, [](LimiterBench&, Wrench& w) { w.torque_Nm.y() = NAN; });
  check(Fault::not_finite, [](LimiterBench&, Wrench& w) { w.force_N.z() = INFINITY; });
  check(Fault::not_finite, [](LimiterBench& b, Wrench&) { b.sample.X_DH.p.x() = NAN; });
  check(Fault::not_finite, [](LimiterBench& b, Wrench&) { b.sample.X_DH.q.coeffs() *= 2.0; });
  check(Fault::jump,
        [](LimiterBench& b, Wrench&) { b.sample.X_DH.p.x() += 0.006; });  // > 5 mm in one tick
  check(Fault::speed, [](LimiterBench& b, Wrench&) { b.sample.velocity_m_s.x() = 2.1; });
  check(Fault::speed, [](LimiterBench& b, Wrench&) { b.sample.angular_velocity_rad_s.x() = 41.0; });
  check(Fault::device, [](LimiterBench& b, Wrench&) { b.status = Status::fault; });
}

TEST(Limiter, ZeroesAStaleTickAndLatchesAfterTwentyMilliseconds) {
  LimiterBench bench;
  bench.settle();
  for (int i = 0; i < 50; ++i) bench.tick(push(2.0));
  bench.status = Status::stale;
  for (int i = 0; i < 80; ++i)
    EXPECT_TRUE(bench.tick(push(2.0)).wrench.force_N.isZero(0.0));  // 20 ms
  EXPECT_EQ(bench.limiter.guard(), Guard::on);
  bench.tick(push(2.0));
  EXPECT_EQ(bench.limiter.fault(), Fault::stale);
}

TEST(Limiter, TreatsAnOldStampAsStaleWhateverTheDeviceSays) {
  LimiterBench bench;
  bench.settle();
  for (int i = 0; i < 50; ++i) bench.tick(push(2.0));
  bench.now += 6'000'000;
  EXPECT_TRUE(bench.limiter.pass(bench.now, Status::ok, bench.sample, push(2.0)).stale);
}

TEST(Limiter, AllowsAJumpThatALongPauseExplains) {
  LimiterBench bench;
  bench.settle();
  bench.now += 19'750'000;  // 20 ms at 2 m/s: 40 mm
  bench.sample.X_DH.p.x() = 0.030;
  bench.tick({});
  EXPECT_EQ(bench.limiter.fault(), Fault::none);
}

TEST(HandLimits, CanBeLoweredButNeverRaised) {
  HandLimits wild;
  wild.max_force_N = 1e9;
  wild.max_torque_Nm = std::nan("");
  wild.ramp_s = 0.0;
  const HandLimits ours = HandLimits{}.lowered_by(wild);
  EXPECT_EQ(ours.max_force_N, HandLimits{}.max_force_N);
  EXPECT_EQ(ours.max_torque_Nm, 0.0);
  EXPECT_EQ(ours.ramp_s, HandLimits{}.ramp_s);
  HandLimits low;
  low.max_force_N = 3.0;
  EXPECT_EQ(HandLimits{}.lowered_by(low).max_force_N, 3.0);
}

TEST(HandLimits, RefusesAFileAboveTheCeiling) {
  const auto refused = HandLimits::from_json({{"max_force_N", 1000.0}}, "config.json: /limits");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("/limits/max_force_N"), std::string::npos);
  EXPECT_FALSE(HandLimits::from_json({{"max_forse_N", 1.0}}, "config.json"));
  EXPECT_TRUE(HandLimits::from_json(HandLimits{}.to_json(), "round trip"));
}

/// A random tick: mostly plausible, sometimes anything.
struct Wild {
  std::mt19937_64 random;
  double unit() { return std::uniform_real_distribution<>(-1.0, 1.0)(random); }
  bool rarely(double share) { return std::uniform_real_distribution<>()(random) < share; }
  double number() {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    constexpr std::array odd{kInf,  -kInf,  std::numeric_limits<double>::quiet_NaN(),
                             1e308, -1e308, 5e-324};
    return rarely(0.00005) ? odd[random() % odd.size()] : 30.0 * unit();
  }
  Vec3 vector(double scale) { return scale * Vec3(number(), number(), number()); }
};

TEST(Limiter, HoldsItsPromisesOverAMillionRandomTicks) {
  Wild wild{std::mt19937_64(20240611)};
  LimiterBench bench;
  Wrench last;
  core::Instant_ns last_now = bench.now;
  bool was_latched = false;
  const HandLimits limits = quick();
  int on = 0, latched = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    if (wild.rarely(0.01)) bench.now += static_cast<core::Instant_ns>(4e6 * (1.0 + wild.unit()));
    bench.status = wild.rarely(0.005)     ? Status::stale
                   : wild.rarely(0.00005) ? Status::fault
                                          : Status::ok;
    bench.sample.X_DH.p += 1e-5 * Vec3(wild.unit(), wild.unit(), wild.unit());
    bench.sample.velocity_m_s = 0.04 * Vec3(wild.unit(), wild.unit(), wild.unit());
    if (wild.rarely(0.00005)) bench.sample.X_DH.p += wild.vector(0.01);
    if (wild.rarely(0.00005)) bench.sample.velocity_m_s = wild.vector(0.1);
    const bool armed = was_latched && wild.rarely(0.01);
    if (armed) {
      bench.limiter.arm();
      bench.sample = {};
    }
    const bool quiet = wild.rarely(0.5) || bench.limiter.guard() == Guard::waiting;
    const auto passed = bench.tick(quiet ? Wrench{} : Wrench{wild.vector(1.0), wild.vector(0.01)});
    const Wrench& out = passed.wrench;

    ASSERT_TRUE(out.force_N.allFinite() && out.torque_Nm.allFinite()) << "tick " << i;
    ASSERT_LE(out.force_N.norm(), limits.max_force_N) << "tick " << i;
    ASSERT_LE(out.torque_Nm.norm(), limits.max_torque_Nm) << "tick " << i;
    const bool zero = out.force_N.isZero(0.0) && out.torque_Nm.isZero(0.0);
    if (!zero) {
      // Time between ticks counts at most twice the period; a nanosecond's worth of room for
      // rounding.
      const double dt_s = double(std::min(bench.now - last_now, 2 * kLimiterPeriod)) * 1e-9;
      ASSERT_LE((out.force_N - last.force_N).norm(), limits.max_force_slew_N_per_s * (dt_s + 1e-9));
      ASSERT_LE((out.torque_Nm - last.torque_Nm).norm(),
                limits.max_torque_slew_Nm_per_s * (dt_s + 1e-9));
    }
    const bool is_latched = bench.limiter.guard() == Guard::latched;
    ASSERT_TRUE(zero || (!is_latched && bench.status == Status::ok)) << "tick " << i;
    ASSERT_TRUE(!was_latched || armed || is_latched) << "re-enabled by itself at tick " << i;
    last = out;
    last_now = bench.now;
    was_latched = is_latched;
    on += bench.limiter.guard() == Guard::on;
    latched += is_latched;
  }
  EXPECT_GT(on, 100'000);  // the walk did visit both sides
  EXPECT_GT(latched, 1000);
}

}  // namespace
}  // namespace loop
}  // namespace tractus
