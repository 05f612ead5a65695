#include "drilling/erosion.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "drilling/drilled.hpp"
#include "drilling/drilling_test_support.hpp"
#include "volume/force_field.hpp"

namespace tractus {
namespace drilling {
namespace {

using math::Vec3;

/// 2/s at full force, the ball's centre at the felt tip.
constexpr Burr kSlow{
    .radius_m = 0.0015, .nose_m = 0.0, .rate_per_s = 2.0, .threshold_N = 0.5, .full_N = 2.5};

// By hand: 0.3 s at 2/s is a dose of 0.6 at the centre. Of the 1000 HU above water a voxel loses
// 0.6 (1 − d²/2.25 mm²): d = 0: 600; 0.5 mm: 533.3; 1 mm: 333.3; √2 mm: 66.7; 1.5 mm: 0.
TEST(Erosion, OfABallThatRestsTakesWhatTheLawSays) {
  const volume::Volume bone = block(21, 0.0005);
  const auto made = eroded(bone, kSlow, stroke(0, Vec3::Zero(), Vec3::Zero(), 1200, 3.0f));
  ASSERT_TRUE(made) << made.error().what;
  const auto left = [&](int i, int j, int k) {
    return made->volume().counts[made->volume().offset(10 + i, 10 + j, 10 + k)];
  };
  EXPECT_EQ(left(0, 0, 0), 2024 - 600);
  EXPECT_EQ(left(1, 0, 0), 2024 - 533);
  EXPECT_EQ(left(0, -1, 0), 2024 - 533);
  EXPECT_EQ(left(0, 0, 2), 2024 - 333);
  EXPECT_EQ(left(2, 2, 0), 2024 - 67);
  EXPECT_EQ(left(3, 0, 0), 2024);
  EXPECT_EQ(made->box().begin, (std::array{8, 8, 8}));
  EXPECT_EQ(made->box().end, (std::array{13, 13, 13}));
}

TEST(Erosion, IsNoMoreThanAllOfAVoxelAndNothingOfAir) {
  volume::Volume bone = block(21, 0.0005);
  bone.counts[bone.offset(11, 10, 10)] = 24;  // −1000 HU, below the empty value of 0 HU
  const auto made = eroded(bone, kSlow, stroke(0, Vec3::Zero(), Vec3::Zero(), 8000, 3.0f));
  ASSERT_TRUE(made);
  EXPECT_EQ(made->volume().counts[bone.offset(10, 10, 10)], 1024);  // 0 HU
  EXPECT_EQ(made->volume().counts[bone.offset(11, 10, 10)], 24);
  EXPECT_EQ(made->lost(10, 10, 10), 1.0);
}

// Eq. (2): half-way between threshold and full force the rate is halved.
TEST(Erosion, GrowsWithThePushFromItsThresholdToItsCap) {
  const volume::Volume bone = block(21, 0.0005);  // ᾱ = 1, and after a loss of 0.2 still
  const auto lost_at = [&](float push_N) {
    return eroded(bone, kSlow, stroke(0, Vec3::Zero(), Vec3::Zero(), 400, push_N))
        ->lost(10, 10, 10);
  };
  EXPECT_EQ(lost_at(0.5f), 0.0);
  EXPECT_NEAR(lost_at(1.5f), 0.1, 1e-6);  // 0.1 s · 1/s
  EXPECT_NEAR(lost_at(2.5f), 0.2, 1e-6);
  EXPECT_NEAR(lost_at(9.0f), 0.2, 1e-6);
}

// α(425 HU) = (425 − 150)/(700 − 150) = 0.5: 0.75 N count as 1.5 N, half-way, so 1/s; as it wears
// α falls (to 0.492 after 0.01) and the rate with it rises, to 1.02/s. Without opacity: 2/s
// unpushed.
TEST(Erosion, NeedsLessPushInSofterBoneAndNoneWhereNothingResists) {
  const auto lost_of = [](std::uint16_t count, float push_N) {
    volume::Volume bone = block(21, 0.0005);
    std::ranges::fill(bone.counts, count);
    return eroded(bone, kSlow, stroke(0, Vec3::Zero(), Vec3::Zero(), 40, push_N))->lost(10, 10, 10);
  };
  EXPECT_NEAR(lost_of(1449, 0.75f), 0.0101, 1e-4);
  EXPECT_EQ(lost_of(1449, 0.25f), 0.0);
  EXPECT_NEAR(lost_of(1124, 0.0f), 0.02, 1e-6);
}

TEST(Erosion, NeedsTheButtonAndAFreshSample) {
  const volume::Volume bone = block(21, 0.0005);
  auto released = stroke(0, Vec3::Zero(), Vec3::Zero(), 400, 3.0f), stale = released;
  for (auto& sample : released) sample.flags = 0;
  for (auto& sample : stale) sample.flags |= trial::kStale;
  EXPECT_EQ(eroded(bone, kSlow, released)->changes(), 0u);
  EXPECT_EQ(eroded(bone, kSlow, stale)->changes(), 0u);
}

TEST(Erosion, DoesNotWorkThroughAStallOrAJump) {
  const volume::Volume bone = block(41, 0.0005);
  auto samples = stroke(0, Vec3::Zero(), Vec3::Zero(), 40, 3.0f);
  for (auto& sample : samples) sample.t_s += sample.tick >= 20 ? 1.0 : 0.0;  // one second is gone
  EXPECT_NEAR(eroded(bone, kSlow, samples)->lost(20, 20, 20), 39 * 2.0 / 4000.0, 1e-6);

  auto jumped = stroke(0, Vec3(-0.009, 0, 0), Vec3(-0.009, 0, 0), 20, 3.0f);
  const auto beyond = stroke(21, Vec3(0.0135, 0, 0), Vec3(0.0135, 0, 0), 20, 3.0f);
  jumped.insert(jumped.end(), beyond.begin(), beyond.end());
  EXPECT_EQ(eroded(bone, kSlow, jumped)->lost(20, 20, 20), 0.0);
}

// A slow plunge of 10 mm with a rest at each end takes the capsule but for a skin that is worn in
// part. Across the axis the dose of a ball that passes at v is D u^1.5, u = 1 − ρ²/r²,
// D = 4 ρ₁ r / 3 v: ∫ min(1, D u^1.5) du = 1 − 0.6 D^(−2/3). A resting ball of dose E leaves
// 1 − (3/5)/E of itself to first order (∫ of 1 − E u over the skin u < 1/E, 3/4 E, within 1 %).
TEST(Erosion, OfAStraightPlungeTakesTheCapsule) {
  constexpr double kRadius = 0.0015, kRate = 1000.0, kSpeed = 0.010, kRun = 0.010, kRest_s = 0.2;
  const volume::Volume bone = block(81, 0.00025);
  const Burr burr{
      .radius_m = kRadius, .nose_m = 0.0, .rate_per_s = kRate, .threshold_N = 0.0, .full_N = 1.0};
  const Vec3 from(0.00003, -0.00007, -0.005), to = from + Vec3(0, 0, kRun);
  auto samples = stroke(0, from, from, std::uint32_t(kRest_s * 4000), 2.0f);
  for (const auto& part : {stroke(801, from, to, std::uint32_t(kRun / kSpeed * 4000), 2.0f),
                           stroke(4802, to, to, std::uint32_t(kRest_s * 4000), 2.0f)})
    samples.insert(samples.end(), part.begin(), part.end());
  const auto made = eroded(bone, burr, samples);
  ASSERT_TRUE(made);
  const double passing = 4.0 * kRate * kRadius / (3.0 * kSpeed);
  const double cylinder =
      std::numbers::pi * kRadius * kRadius * kRun * (1.0 - 0.6 * std::pow(passing, -2.0 / 3.0));
  const double ball =
      4.0 / 3.0 * std::numbers::pi * std::pow(kRadius, 3) * (1.0 - 0.75 / (kRate * kRest_s));
  EXPECT_NEAR(made->removed_m3(), cylinder + ball, 0.01 * (cylinder + ball));
}

TEST(Erosion, CountsBoneAloneAsRemoved) {
  volume::Volume bone = block(21, 0.0005);
  std::ranges::fill(bone.counts, std::uint16_t(1124));  // 100 HU: no opacity below 150
  const auto made = eroded(bone, kSlow, stroke(0, Vec3::Zero(), Vec3::Zero(), 1200, 3.0f));
  ASSERT_TRUE(made);
  EXPECT_GT(made->changes(), 0u);
  EXPECT_EQ(made->removed_m3(), 0.0);
}

/// A bent, hurried way through the block, ticks missing here and there.
std::vector<trial::Sample> wild() {
  std::vector<trial::Sample> out;
  for (std::uint32_t tick = 0; tick < 3000; tick += tick % 97 == 0 ? 9 : 1) {
    const double t = tick / 4000.0;
    out.push_back(pressed(tick,
                          {0.006 * std::sin(9 * t), 0.006 * std::cos(23 * t), 0.012 * (t - 0.35)},
                          float(1.5 + std::sin(40 * t))));
    if (tick % 500 > 450) out.back().flags = 0;
  }
  return out;
}

TEST(Erosion, RepeatsToTheLastBit) {
  const volume::Volume bone = block(61, 0.00035);
  const Burr burr;
  const auto a = eroded(bone, burr, wild()), b = eroded(bone, burr, wild());
  ASSERT_TRUE(a && b);
  ASSERT_GT(a->changes(), 10u);
  EXPECT_EQ(drilled_of(*a).sha256(), drilled_of(*b).sha256());
  EXPECT_EQ(a->removed_m3(), b->removed_m3());
}

// What a loop holds between two ticks must be a whole volume's field: every change is told, in
// time, no larger than its room, and with all of them the field is that of the drilled volume.
TEST(Erosion, TellsEveryChangeInPiecesThatALoopCanCopy) {
  const volume::Volume bone = block(61, 0.00035);
  const auto transfer = volume::TransferFunction::bone();
  auto field = volume::ForceField::make(bone, transfer, volume::FieldKind::paper);
  auto erosion = Erosion::make(bone, transfer, Burr{.rate_per_s = 400.0}, kProbe);
  ASSERT_TRUE(field && erosion);
  volume::FieldPatch patch(kMostPatchFloats);
  std::uint32_t told = 0;
  const Erosion::Take take = [&](const Change& change) {
    EXPECT_EQ(change.number, ++told);
    ASSERT_LE(volume::FieldPatch::floats_for(change.box, bone.geometry.dims), kMostPatchFloats);
    field->compute(erosion->volume(), change.box, patch);
    field->apply(patch);
  };
  for (const auto& sample : wild()) erosion->add(sample, take);
  erosion->finish(take);
  EXPECT_EQ(told, erosion->changes());
  const auto anew = volume::ForceField::make(erosion->volume(), transfer, volume::FieldKind::paper);
  ASSERT_TRUE(anew);
  for (int k = 0; k < 61; ++k)
    for (int j = 0; j < 61; ++j)
      for (int i = 0; i < 61; ++i) {
        const Vec3 p = bone.geometry.position_of({double(i), double(j), double(k)});
        ASSERT_EQ(field->opacity(p), anew->opacity(p)) << i << " " << j << " " << k;
      }
}

TEST(Erosion, CutsASweepOfOneChunkIntoChangesThatFit) {
  const volume::Volume bone = block(121, 0.00025);
  // 1 m/s across the block's diagonal: 5 mm in 5 ms, each way in a box of its own if one were told.
  const Burr burr{.rate_per_s = 1000.0};
  std::uint32_t told = 0;
  const auto made = eroded(
      bone, burr, stroke(0, Vec3::Constant(-0.006), Vec3::Constant(0.006), 20, 3.0f),
      [&](const Change& change) {
        ++told;
        EXPECT_LE(volume::FieldPatch::floats_for(change.box, {121, 121, 121}), kMostPatchFloats);
      });
  ASSERT_TRUE(made);
  EXPECT_GT(told, 2u);
  EXPECT_GT(made->lost(60, 60, 60), 0.0);  // nothing was skipped on the way
}

TEST(Erosion, RefusesABurrWhoseChangesNoLoopCouldCopy) {
  const volume::Volume bone = block(21, 0.0001);
  const auto made = Erosion::make(bone, volume::TransferFunction::bone(), Burr{}, kProbe);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, core::Errc::out_of_range);
  EXPECT_NE(made.error().what.find("1.50 mm"), std::string::npos);
}

TEST(Burr, IsReadAsItIsWrittenAndRefusesWhatNoBurrIs) {
  const Burr burr{.radius_m = 0.002, .rate_per_s = 7.0};
  const auto read = Burr::from_json(burr.to_json(), "b");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->to_json(), burr.to_json());
  for (const auto& [key, value] : std::vector<std::pair<const char*, double>>{
           {"radius_m", 0.1}, {"nose_m", 0.002}, {"rate_per_s", -1.0}, {"full_N", 0.01}}) {
    core::Json wrong = Burr{}.to_json();
    wrong[key] = value;
    const auto refused = Burr::from_json(wrong, "burr");
    ASSERT_FALSE(refused) << key;
    EXPECT_NE(refused.error().what.find(key), std::string::npos) << refused.error().what;
  }
}

}  // namespace
}  // namespace drilling
}  // namespace tractus
