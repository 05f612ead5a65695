#include "station/loop/haptic_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>

#include "station/devices/catalogue.hpp"
#include "station/loop/allocation_guard.hpp"
#include "station/loop/loop_test_support.hpp"
#include "station/loop/placement.hpp"

namespace tractus {
namespace loop {
namespace {
using devices::Status;
using math::Vec3;
constexpr core::Instant_ns kHapticPeriod = 250'000;

class StillDevice final : public devices::Device {
 public:
  core::Result<devices::Limits> open() override { return devices::Limits{20, 0.2, 4000}; }
  Status read(core::Instant_ns now, devices::Sample& out) noexcept override {
    out = {};
    out.stamp = now;
    out.X_DH = pose;
    return status;
  }
  Status write(const math::Wrench& wrench) noexcept override {
    last = wrench;
    return Status::ok;
  }
  void close() noexcept override {}
  math::Pose pose;
  Status status = Status::ok;
  math::Wrench last;
};

/// Pushes along H's x with a set force once `after` ticks have gone.
class Pusher final : public Contact {
 public:
  laws::PalpationStep step(const effects::HandleMotion& handle, double) noexcept override {
    seen = handle.X_VH;
    laws::PalpationStep out;
    out.wrench_H.force_N = {++ticks > after ? push_N : 0.0, 0, 0};
    out.converged = converged;
    return out;
  }
  int ticks = 0, after = 100;
  double push_N = 0.5;
  bool converged = true;
  math::Pose seen;
};

template <class SomeClock>
struct Rig {
  SomeClock clock;
  StillDevice device;
  Pusher contact;
  Limiter limiter{HandLimits{}, kHapticPeriod};
  SampleRing ring{1024};
  LiveState live;
  HapticLoop loop{{clock, device, contact, limiter, ring, live}, {}, Vec3::Zero(), 4000.0};

  std::vector<trial::Sample> run(int ticks) {
    int left = ticks;
    loop.run([&] {
      if (--left <= 0) loop.stop();
    });
    std::vector<trial::Sample> out(1024);
    out.resize(ring.pop(out));
    return out;
  }
};

TEST(HapticLoop, TicksAtAbsoluteDeadlinesOnAPunctualClock) {
  Rig<core::ManualClock> rig;
  rig.limiter.arm();
  const auto samples = rig.run(100);
  ASSERT_EQ(samples.size(), 100u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].tick, i);
    EXPECT_DOUBLE_EQ(samples[i].t_s, 0.00025 * double(i));
  }
  EXPECT_EQ(rig.loop.counts().late, 0u);
  EXPECT_EQ(rig.loop.counts().skipped, 0u);
}

TEST(HapticLoop, CountsALateTickAndDoesNotDriftAfterIt) {
  Rig<StumblingClock> rig;
  rig.clock.late_ns = {0, 0, 70'000, 0, 60'000};  // a quarter of 250 µs is 62.5
  const auto samples = rig.run(6);
  ASSERT_EQ(samples.size(), 6u);
  EXPECT_EQ(rig.loop.counts().late, 1u);
  EXPECT_TRUE(samples[2].flags & trial::kLate);
  EXPECT_DOUBLE_EQ(samples[3].t_s, 0.00075);
  EXPECT_DOUBLE_EQ(samples[5].t_s, 0.00125);
}

TEST(HapticLoop, SkipsMissedDeadlinesInsteadOfChasingThem) {
  Rig<StumblingClock> rig;
  rig.clock.late_ns = {
      0, 1'100'000};  // the second tick wakes 4.4 periods late: four deadlines are gone
  const auto samples = rig.run(4);
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples[1].tick, 1u);
  EXPECT_EQ(samples[2].tick, 6u);
  EXPECT_DOUBLE_EQ(samples[2].t_s, 0.0015);
  EXPECT_EQ(rig.loop.counts().skipped, 4u);
}

TEST(HapticLoop, TurnsTheWrenchFromTheHandleIntoTheDevicesAxes) {
  Rig<core::ManualClock> rig;
  HandLimits limits;
  limits.ramp_s = 0.2;
  rig.limiter = Limiter(limits, kHapticPeriod);
  rig.device.pose.q =
      math::Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));  // H's x is D's y
  rig.limiter.arm();
  math::Wrench held;
  int left = 1020;
  rig.loop.run([&] {
    held = rig.device.last;
    if (--left == 0) rig.loop.stop();
  });
  EXPECT_NEAR(held.force_N.y(), 0.5, 1e-12);
  EXPECT_NEAR(held.force_N.x(), 0.0, 1e-12);
}

TEST(HapticLoop, LeavesTheDeviceAtZeroForce) {
  Rig<core::ManualClock> rig;
  rig.limiter.arm();
  rig.run(900);
  EXPECT_TRUE(rig.device.last.force_N.isZero(0.0));
}

TEST(HapticLoop, EndsWithTheDeviceAtZeroWhenTheModelGivesNotANumber) {
  Rig<core::ManualClock> rig;
  rig.contact.push_N = NAN;
  rig.limiter.arm();
  const auto samples = rig.run(900);
  EXPECT_EQ(samples.size(), 101u);
  EXPECT_EQ(rig.limiter.fault(), Fault::not_finite);
  EXPECT_TRUE(std::isfinite(samples.back().force_N[0]));  // what is recorded stays readable
  EXPECT_TRUE(rig.device.last.force_N.isZero(0.0));
}

TEST(HapticLoop, HoldsTheLastPoseThroughAStaleSampleAndFlagsIt) {
  Rig<core::ManualClock> rig;
  rig.device.pose.p = {0.01, 0.02, 0.03};
  rig.limiter.arm();
  rig.run(1);
  rig.device.status = Status::stale;
  rig.device.pose.p = {9, 9, 9};
  rig.loop.tick(rig.clock.now() + kHapticPeriod, 1, false);
  std::array<trial::Sample, 4> out;
  ASSERT_EQ(rig.ring.pop(out), 1u);
  EXPECT_TRUE(out[0].flags & trial::kStale);
  EXPECT_EQ(out[0].p_VH_m, (std::array<double, 3>{0.01, 0.02, 0.03}));
}

TEST(HapticLoop, APauseHasNoSamplesAndNoTimeInTheTrial) {
  Rig<core::ManualClock> rig;
  rig.contact.push_N = 0.0;
  rig.limiter.arm();
  int ticks = 0;
  rig.loop.run([&] {
    ++ticks;
    if (ticks == 100) rig.limiter.pause(true);
    if (ticks == 300) rig.limiter.pause(false);
    if (ticks == 400) rig.loop.stop();
  });
  std::vector<trial::Sample> samples(1024);
  samples.resize(rig.ring.pop(samples));
  // 400 ticks less the 200 of the pause, 0.25 ms and one tick apart throughout.
  ASSERT_EQ(samples.size(), 200u);
  EXPECT_EQ(rig.loop.counts().samples, 200u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].tick, i);
    EXPECT_NEAR(samples[i].t_s, 0.25e-3 * double(i), 1e-9);
  }
}

TEST(HapticLoop, CountsWhatTheRingCouldNotTake) {
  Rig<core::ManualClock> rig;
  rig.limiter.arm();
  rig.run(1500);
  EXPECT_EQ(rig.loop.periods().lost(), 1500u - 1024u);
}

TEST(HapticLoop, CountsTicksThatDidNotConverge) {
  Rig<core::ManualClock> rig;
  rig.contact.converged = false;
  rig.limiter.arm();
  EXPECT_TRUE(rig.run(10).back().flags & trial::kNotConverged);
  EXPECT_EQ(rig.loop.counts().not_converged, 10u);
}

TEST(HapticLoop, AllocatesNothingInTheTick) {
  Rig<core::ManualClock> rig;
  rig.limiter.arm();
  const AllocationGuard guard;
  for (std::uint32_t i = 0; i < 2000; ++i) rig.loop.tick(i * kHapticPeriod, i, false);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(HapticLoop, AllocatesNothingInTheTickWithAnySimulatedDevice) {
  for (const devices::DeviceInfo& info : devices::all(devices::DeviceKind::handle)) {
    if (!info.simulated) continue;
    auto made = info.make({});
    ASSERT_TRUE(made) << info.id;
    ASSERT_TRUE(made->device->open()) << info.id;
    Rig<core::ManualClock> rig;
    HapticLoop loop({rig.clock, *made->device, rig.contact, rig.limiter, rig.ring, rig.live}, {},
                    Vec3::Zero(), 4000.0);
    rig.limiter.arm();
    const AllocationGuard guard;
    for (std::uint32_t i = 0; i < 80'000; ++i) loop.tick(i * kHapticPeriod, i, false);  // 20 s
    EXPECT_EQ(guard.allocations(), 0u) << info.id;
  }
}

TEST(Ring, KeepsOrderAndLosesNothingBetweenTwoThreads) {
  Ring<std::uint64_t> ring(64);
  constexpr std::uint64_t kCount = 200'000;
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < kCount;)
      if (ring.push(i)) ++i;
  });
  std::array<std::uint64_t, 48> out;
  std::uint64_t next = 0;
  bool ordered = true;
  while (next < kCount) {
    const std::size_t n = ring.pop(out);
    for (std::size_t i = 0; i < n; ++i) ordered = ordered && out[i] == next++;
  }
  producer.join();
  EXPECT_TRUE(ordered);
}

TEST(Seqlock, NeverShowsHalfAValue) {
  struct Pair {
    std::uint64_t a, b, c;
  };
  Seqlock<Pair> lock;
  EXPECT_FALSE(lock.read().has_value());
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= 200'000; ++i) lock.write({i, 2 * i, 3 * i});
  });
  bool whole = true;
  std::uint64_t last = 0;
  while (last < 200'000) {
    const auto seen = lock.read();
    if (!seen) continue;
    whole = whole && seen->b == 2 * seen->a && seen->c == 3 * seen->a && seen->a >= last;
    last = seen->a;
  }
  writer.join();
  EXPECT_TRUE(whole);
}

TEST(Placement, PutsTheTipInTheMouthWithTheHandleInTheCentreOfTheWorkspace) {
  volume::Tract tract;
  tract.entry_m = {0.01, -0.02, 0.3};
  tract.axis = Vec3(1, 2, 2) / 3.0;
  tract.superior = Vec3(2, 1, -2) / 3.0;
  tract.medial = tract.superior.cross(tract.axis);
  tract.length_m = 0.04;
  const Vec3 offset(0, 0.0045, 0.0005);
  const math::Pose X_VD = place_device(tract, 0.13, offset);
  // The operator's side: x of D points out of the bone.
  EXPECT_LT((X_VD.q * Vec3::UnitX() + tract.axis).norm(), 1e-12);
  EXPECT_LT((X_VD.q * Vec3::UnitZ() - tract.superior).norm(), 1e-12);
  // Handle at D's origin, probe along −x of D; the law adds the offset.
  EXPECT_LT((X_VD * Vec3(-0.13, 0, 0) + offset - tract.entry_m).norm(), 1e-12);
  const volume::Tract in_D = tract_in_device(tract, X_VD, offset);
  EXPECT_LT((in_D.entry_m - Vec3(-0.13, 0, 0)).norm(), 1e-12);
  EXPECT_LT((in_D.axis + Vec3::UnitX()).norm(), 1e-12);
}

}  // namespace
}  // namespace loop
}  // namespace tractus
