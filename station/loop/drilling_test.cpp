#include "station/loop/drilling.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <deque>

#include "station/loop/allocation_guard.hpp"

namespace tractus {
namespace loop {
namespace {
using devices::Status;
using math::Vec3;
constexpr core::Instant_ns kDrillingPeriod = 250'000;

/// 1000 HU below the plane z = 0, air above; the burr comes along +z.
volume::Volume slab() {
  volume::Volume bone;
  bone.geometry.dims = {61, 61, 81};
  bone.geometry.spacing_m = Vec3::Constant(0.00035);
  bone.geometry.origin_m = Vec3(-0.0105, -0.0105, -0.0105);
  bone.intercept = -1024.0;
  bone.counts.assign(bone.geometry.voxel_count(), 2024);
  std::fill_n(bone.counts.begin(), 61 * 61 * 30, std::uint16_t(24));
  return bone;
}

/// A hand that pushes the handle along z at an even speed, the button held, and shakes a little; a
/// spring lets it lag behind where it feels something.
class Plunger final : public devices::Device {
 public:
  core::Result<devices::Limits> open() override { return devices::Limits{20, 0.2, 4000}; }
  Status read(core::Instant_ns now, devices::Sample& out) noexcept override {
    const double t = double(ticks++) * 0.00025;
    out = {};
    out.stamp = now;
    out.X_DH.p = Vec3(2e-4 * std::sin(50 * t), 1e-4 * std::sin(37 * t),
                      -0.13 - 0.002 + speed_m_s * t + give_m_per_N * push.z());
    out.buttons = buttons;
    return Status::ok;
  }
  Status write(const math::Wrench& wrench) noexcept override {
    push = 0.99 * push + 0.01 * wrench.force_N;
    return Status::ok;
  }
  void close() noexcept override {}
  double speed_m_s = 0.004, give_m_per_N = 0.0025;
  std::uint32_t buttons = 1;
  int ticks = 0;
  Vec3 push = Vec3::Zero();
};

struct DrillingBench {
  explicit DrillingBench(const drilling::Burr& burr = {}) {
    auto made = Drilling::make(bone, model, burr);
    core::require(bool(made), "the bench's burr fits its bone");
    drilling = std::move(*made);
    contact.emplace(drilling->runtime());
    loop.emplace(HapticLoop::Parts{.clock = clock,
                                   .device = device,
                                   .contact = *contact,
                                   .limiter = limiter,
                                   .ring = ring,
                                   .live = live,
                                   .tool = drilling.get()},
                 math::Pose{}, Vec3::Zero(), 4000.0);
  }
  /// `between` runs after each tick.
  std::vector<trial::Sample> run(int ticks, const std::function<void()>& between) {
    limiter.arm();
    int left = ticks;
    loop->run([&] {
      between();
      if (--left <= 0) loop->stop();
    });
    drilling->finish();
    std::vector<trial::Sample> out(32768);
    out.resize(ring.pop(out));
    return out;
  }

  const volume::Volume bone = slab();
  const models::PalpationModel model;
  core::ManualClock clock;
  Plunger device;
  Limiter limiter{HandLimits{}, kDrillingPeriod};
  SampleRing ring{32768};
  LiveState live;
  std::unique_ptr<Drilling> drilling;
  std::optional<PalpationContact> contact;
  std::optional<HapticLoop> loop;
};

/// Does what was recorded say all? The voxels drilled again, and every force felt again with the
/// changes that its tick had.
void expect_replays(const DrillingBench& bench, const std::vector<trial::Sample>& samples) {
  const auto& setup = bench.drilling->setup();
  auto erosion = drilling::Erosion::make(bench.bone, setup.transfer, setup.burr,
                                         {.length_m = bench.model.base.length_m});
  auto field = volume::ForceField::make(bench.bone, setup.transfer, bench.model.field);
  ASSERT_TRUE(erosion && field);
  models::PalpationModel with_burr = bench.model;
  with_burr.base.radius_m = setup.burr.shank_radius_m;
  const auto runtime = models::PalpationRuntime::make(with_burr, *field);
  ASSERT_TRUE(runtime);
  std::deque<volume::FieldPatch> waiting;
  const auto take = [&](const drilling::Change& change) {
    waiting.emplace_back(drilling::kMostPatchFloats);
    field->compute(erosion->volume(), change.box, waiting.back());
  };
  PalpationContact contact(*runtime);
  std::uint32_t applied = 0;
  double worst_N = 0.0, hardest_N = 0.0;
  for (const trial::Sample& sample : samples) {
    for (; applied < sample.patches; ++applied) {
      ASSERT_FALSE(waiting.empty()) << "a change was felt before its cause, tick " << sample.tick;
      field->apply(waiting.front());
      waiting.pop_front();
    }
    const Vec3 again = contact.step({.X_VH = sample.pose()}, sample.t_s).wrench_H.force_N;
    const Vec3 felt(sample.force_N[0], sample.force_N[1], sample.force_N[2]);
    worst_N = std::max(worst_N, (again - felt).norm());
    hardest_N = std::max(hardest_N, felt.norm());
    erosion->add(sample, take);
  }
  erosion->finish(take);
  EXPECT_LT(worst_N, 1e-6);
  EXPECT_GT(hardest_N, 0.05);
  EXPECT_GT(samples.back().patches, 20u);
  EXPECT_EQ(erosion->volume().counts, bench.drilling->erosion().volume().counts);
  EXPECT_EQ(erosion->removed_m3(), bench.drilling->erosion().removed_m3());
  EXPECT_GT(erosion->removed_m3(), 5e-9);
}

TEST(Drilling, IsFeltAndReplaysFromItsSamplesUnderAManualClock) {
  DrillingBench bench;
  const auto samples = bench.run(8000, [&] { bench.drilling->work(); });
  ASSERT_EQ(samples.size(), 8000u);
  expect_replays(bench, samples);
}

// The worker races the loop, which runs as fast as it can: what it does when is chance, what the
// record says is not.
TEST(Drilling, ReplaysFromItsSamplesWhateverTheWorkersPace) {
  DrillingBench bench;
  core::MonotonicClock real;
  bench.drilling->start(real);
  const auto samples = bench.run(16000, [&] {
    // The worker gets a share of the processors, however busy the machine is.
    if (bench.loop->counts().samples % 64 == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  ASSERT_EQ(samples.size(), 16000u);
  ASSERT_FALSE(bench.drilling->fell_behind());
  const auto last = samples.back().patches;
  EXPECT_LE(last, bench.drilling->erosion().changes());
  expect_replays(bench, samples);
}

TEST(Drilling, TakesNothingWithoutTheButton) {
  DrillingBench bench;
  bench.device.buttons = 2;
  bench.run(4000, [&] { bench.drilling->work(); });
  EXPECT_EQ(bench.drilling->erosion().changes(), 0u);
}

// A burr that takes the bone from under the hand at once: the model's force falls in one tick by
// more than the slew lets through, and what is rendered does not.
TEST(Drilling, OfAllTheBoneAtOnceDoesNotJerkTheHand) {
  DrillingBench bench({.nose_m = 0.0, .rate_per_s = 1000.0, .threshold_N = 2.2, .full_N = 2.201});
  bench.device.give_m_per_N = 0.0;
  const auto samples = bench.run(8000, [&] { bench.drilling->work(); });
  const double most_N = bench.limiter.limits().max_force_slew_N_per_s * 0.00025;
  double model_N = 0.0, rendered_N = 0.0;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const auto step = [&](const std::array<float, 3>& a, const std::array<float, 3>& b) {
      return (Vec3(a[0], a[1], a[2]) - Vec3(b[0], b[1], b[2])).norm();
    };
    model_N = std::max(model_N, step(samples[k].force_N, samples[k - 1].force_N));
    rendered_N =
        std::max(rendered_N, step(samples[k].rendered_force_N, samples[k - 1].rendered_force_N));
  }
  EXPECT_GT(model_N, 2.0 * most_N);
  EXPECT_LE(rendered_N, most_N * (1.0 + 1e-5));  // recorded in single precision
}

TEST(Drilling, AllocatesNothingInTheTick) {
  DrillingBench bench;
  core::MonotonicClock real;
  bench.drilling->start(real);
  std::uint64_t allocations = 0;
  bench.limiter.arm();
  for (std::uint32_t tick = 0; tick < 8000; ++tick) {
    const AllocationGuard guard;
    bench.loop->tick(core::Instant_ns{tick} * kDrillingPeriod, tick, false);
    allocations += guard.allocations();
    if (tick % 64 == 0) std::this_thread::yield();
  }
  bench.drilling->finish();
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(bench.drilling->erosion().changes(), 0u);
}

TEST(Drilling, SaysWhenTheWorkerIsTooFarBehind) {
  DrillingBench bench;
  for (std::size_t tick = 0; tick < Drilling::kRoom; ++tick) bench.drilling->worked({});
  EXPECT_FALSE(bench.drilling->fell_behind());
  bench.drilling->worked({});
  EXPECT_TRUE(bench.drilling->fell_behind());
}

TEST(Drilling, ShowsWhatChangedAndNothingTwice) {
  DrillingBench bench;
  volume::Volume shown = bench.bone;
  int boxes = 0;
  EXPECT_FALSE(bench.drilling->show(shown));
  bench.run(8000, [&] {
    bench.drilling->work();
    if (bench.loop->counts().samples % 500 == 0) boxes += bool(bench.drilling->show(shown));
  });
  bench.drilling->show(shown);
  EXPECT_FALSE(bench.drilling->show(shown));
  EXPECT_GT(boxes, 3);
  EXPECT_EQ(shown.counts, bench.drilling->erosion().volume().counts);
}

TEST(Drilling, ShowsWhatEachVoxelLostWhenTheBurrWasAtWork) {
  DrillingBench bench;
  EXPECT_FALSE(bench.drilling->worn());
  bench.run(4000, [&] { bench.drilling->work(); });
  const auto worn = bench.drilling->worn();
  ASSERT_TRUE(worn);
  EXPECT_FALSE(bench.drilling->worn());
  const auto& erosion = bench.drilling->erosion();
  EXPECT_EQ(worn->removed_m3, erosion.removed_m3());
  const auto& [begin, end] = worn->box;
  ASSERT_LT(begin[2], end[2]);
  std::size_t at = 0;
  double inside = 0.0, all = 0.0;
  for (int k = 0; k < 81; ++k)
    for (int j = 0; j < 61; ++j)
      for (int i = 0; i < 61; ++i) {
        all += erosion.lost(i, j, k);
        if (i < begin[0] || i >= end[0] || j < begin[1] || j >= end[1] || k < begin[2] ||
            k >= end[2])
          continue;
        ASSERT_LT(at, worn->lost.size());
        EXPECT_EQ(double(worn->lost[at++]), erosion.lost(i, j, k));
        inside += erosion.lost(i, j, k);
      }
  EXPECT_EQ(at, worn->lost.size());
  EXPECT_EQ(inside, all);
  EXPECT_GT(all, 100.0);
}

}  // namespace
}  // namespace loop
}  // namespace tractus
