#include "station/loop/probing_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "station/loop/allocation_guard.hpp"

namespace tractus {
namespace loop {
namespace {
namespace registers = devices::rig;
using devices::Exchange;
using trial::ProbingMode;

constexpr core::Instant_ns kProbingPeriod = 1'000'000;

/// A stage without lag under a constant push, and a bus that takes as long as it is told.
class FakeRig final : public devices::RigDevice {
 public:
  explicit FakeRig(core::ManualClock& clock) : clock_(clock) {}
  core::Result<devices::RigIdentity> open() override { return devices::RigIdentity{}; }
  Exchange exchange(const devices::RigCommand& command,
                    devices::RigReading& out) noexcept override {
    const auto number = exchanges_++;
    last = command;
    if (number < how.size() && how[number] != Exchange::ok) return how[number];
    clock_.advance(number < takes_ns.size() ? takes_ns[number] : 50'000);
    x_m_ += 1e-3 * speed_m_s_;
    angle_urad_ += static_cast<std::uint32_t>(1000);  // 1 rad/s
    speed_m_s_ = command.enable ? command.speed_m_s : 0.0;
    out = {};
    out.status = command.enable ? registers::kEnabled : 0;
    out.x_m = x_m_;
    out.speed_m_s = speed_m_s_;
    out.angle_urad = static_cast<std::int32_t>(angle_urad_);
    out.turning_rad_s = turning_rad_s;
    out.fz_N = command.enable ? push_N : 0.0;
    return Exchange::ok;
  }
  void close() noexcept override {}

  std::vector<Exchange> how;
  std::vector<core::Instant_ns> takes_ns;
  devices::RigCommand last;
  double push_N = 100.0, turning_rad_s = 1.0;

 private:
  core::ManualClock& clock_;
  std::size_t exchanges_ = 0;
  std::uint32_t angle_urad_ = 0x7fffff00u;  // about to wrap
  double x_m_ = 0.0, speed_m_s_ = 0.0;
};

/// D = 1000 N·s/m, no stiffness: 100 N move at 0.1 m/s; a wall at 10 mm with 5 mm of soft tissue of
/// 500 N·s/m behind it.
laws::ProbingParameters parameters(double damping_Ns_per_m = 1000.0) {
  laws::ProbingParameters p;
  p.layers = {{0.0, 0.02, 0.0, damping_Ns_per_m, 0.0}};
  p.walls = {{0.01, 0.0, 0.0, 0.005, 500.0}};
  p.travel_m = 0.02;
  return p;
}

models::ProbingRuntime runtime(double damping_Ns_per_m = 1000.0) {
  auto made = models::ProbingRuntime::make(parameters(damping_Ns_per_m), {});
  return std::move(*made);
}

struct ProbingBench {
  core::ManualClock clock;
  FakeRig device{clock};
  ProbingGuard guard{RigLimits{}, 0.02, 1e-3};
  ProbingRing ring{4096};
  Seqlock<ProbingLoopSnapshot> live;
  models::ProbingRuntime law = runtime();
  ProbingLoop loop{{clock, clock, device, guard, ring, live}, law, 0.02, 1000.0};
  std::vector<trial::ProbingSample> samples;

  void run(std::size_t most = 4000,
           const std::function<void(const trial::ProbingSample&)>& also = {}) {
    std::size_t seen = 0;
    loop.run([&](const trial::ProbingSample& sample) {
      if (also) also(sample);
      if (++seen == most) loop.stop();
    });
    samples.resize(4096);
    samples.resize(ring.pop(samples));
  }
};

TEST(ProbingLoop, MovesByTheLawThroughBoneAndBreachToTheStop) {
  ProbingBench bench;
  bench.run();
  ASSERT_FALSE(bench.guard.latched()) << text_of(bench.guard.fault());
  bool breach = false;
  for (const auto& s : bench.samples) {
    if (s.mode == ProbingMode::bone && s.x_m > 0.002 && s.x_m < 0.0099) {
      EXPECT_NEAR(double(s.law_m_s), 0.1, 1e-6);
      EXPECT_NEAR(double(s.command_m_s), 0.1, 1e-6);
    }
    if (s.mode != ProbingMode::breach) continue;
    breach = true;
    EXPECT_GE(s.x_m, 0.01);
    EXPECT_LT(s.x_m, 0.015);
    EXPECT_EQ(s.command_Nm, 0.0f);  // the rotary motor is off
  }
  EXPECT_TRUE(breach);
  EXPECT_EQ(bench.samples.back().mode, ProbingMode::stopped);
  // Half a second at the stop ends it.
  EXPECT_EQ(bench.samples[bench.samples.size() - 500].mode, ProbingMode::stopped);
  EXPECT_NE(bench.samples[bench.samples.size() - 502].mode, ProbingMode::stopped);
  EXPECT_FALSE(bench.device.last.enable);
}

TEST(ProbingLoop, HoldsWhileTheProbeTurnsTooSlowly) {
  ProbingBench bench;
  bench.device.turning_rad_s = 0.17;  // 10 deg/s are 0.1745
  bench.run(1000);
  EXPECT_EQ(bench.samples.back().x_m, 0.0);
  EXPECT_EQ(bench.samples.back().mode, ProbingMode::holding);
}

TEST(ProbingLoop, SamplesEveryTickWithItsRoundTripAndAnUnwrappedAngle) {
  ProbingBench bench;
  bench.run(400);
  ASSERT_EQ(bench.samples.size(), 400u);
  for (std::size_t k = 0; k < 400; ++k) {
    EXPECT_EQ(bench.samples[k].tick, k);
    EXPECT_NEAR(bench.samples[k].t_s, 1e-3 * double(k), 1e-9);
    EXPECT_NEAR(double(bench.samples[k].round_trip_s), 50e-6, 1e-9);
    EXPECT_NEAR(bench.samples[k].theta_rad, 1e-3 * double(k), 1e-9);  // across the register's wrap
  }
}

TEST(ProbingLoop, CountsWhatWasLateSkippedOrLostAndSaysSoInTheSamples) {
  ProbingBench bench;
  bench.device.takes_ns.assign(400, 50'000);
  bench.device.takes_ns[300] = 1'200'000;  // into the next period: missed, the next one late
  bench.device.takes_ns[350] = 3'600'000;  // over three more
  bench.device.how.assign(400, Exchange::ok);
  bench.device.how[380] = Exchange::silent;
  bench.run(397);
  const auto counts = trial::count_ticks({{}, bench.samples});
  EXPECT_EQ(counts.missed, 3u);   // 300, 350, and 351, which woke 2.6 ms late
  EXPECT_EQ(counts.skipped, 2u);  // 3.6 ms after tick 350 began: 352 and 353 never did
  EXPECT_EQ(counts.bus_lost, 1u);
  EXPECT_EQ(counts.stale, 1u);
  EXPECT_TRUE(bench.samples[300].flags & trial::kMissed);
  EXPECT_FALSE(bench.samples[301].flags & trial::kLate);  // 0.2 ms: under a quarter
  EXPECT_EQ(bench.samples[380].round_trip_s, 0.0f);
  EXPECT_EQ(bench.samples[380].command_m_s, 0.0f);
  EXPECT_EQ(bench.loop.counts().missed, counts.missed);
  EXPECT_EQ(bench.loop.counts().skipped, counts.skipped);
}

TEST(ProbingLoop, APauseStandsStillAndHasNoSamplesAndNoTimeInTheTrial) {
  ProbingBench bench;
  std::size_t ticks = 0;
  double x_before_m = 0.0;
  bench.run(1000, [&](const trial::ProbingSample& sample) {
    ++ticks;
    if (ticks == 250) bench.guard.pause(true);  // 50 ms after the tare
    if (ticks == 300) x_before_m = sample.x_m;
    if (ticks == 500) {
      EXPECT_EQ(sample.x_m, x_before_m);
      bench.guard.pause(false);
    }
  });
  // The drive is off one exchange after the pause was asked for, and the stage stands one later.
  EXPECT_NEAR(double(bench.samples.size()), 750.0, 3.0);
  for (std::size_t i = 1; i < bench.samples.size(); ++i) {
    EXPECT_EQ(bench.samples[i].tick, i);
    EXPECT_NEAR(bench.samples[i].t_s - bench.samples[i - 1].t_s, 1e-3, 1e-6);
  }
  EXPECT_GT(bench.samples.back().x_m, x_before_m) << "it goes on";
}

TEST(ProbingLoop, EndsWithTheGuardAndLeavesTheDriveOff) {
  ProbingBench bench;
  bench.device.how.assign(301, Exchange::ok);
  bench.device.how[300] = Exchange::garbage;
  bench.run();
  EXPECT_EQ(bench.guard.fault(), safety::Fault::garbage);
  EXPECT_EQ(bench.samples.size(), 301u);
  EXPECT_FALSE(bench.device.last.enable);
}

TEST(ProbingLoop, TakesAnotherLawFromTheNextTickOn) {
  ProbingBench bench;
  const auto softer = runtime(500.0);
  bench.run(260, [&](const trial::ProbingSample& sample) {
    if (sample.tick == 240) bench.loop.exchange_law(softer);
  });
  EXPECT_NEAR(double(bench.samples[240].law_m_s), 0.1, 1e-6);
  EXPECT_NEAR(double(bench.samples[241].law_m_s), 0.2, 1e-6);
}

TEST(ProbingLoop, AllocatesNothing) {
  ProbingBench bench;
  std::uint64_t allocations = 0;
  std::optional<AllocationGuard> guard;  // from the first tick on
  bench.run(400, [&](const trial::ProbingSample& sample) {
    if (sample.tick == 0) guard.emplace();
    allocations = guard->allocations();
  });
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace loop
}  // namespace tractus
