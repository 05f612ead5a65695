#include "station/session/tip_way.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace session {
namespace {
using math::Vec3;

constexpr double kLength_m = 0.13;
const trial::ProbeShape kProbe{.length_m = kLength_m};

/// The straight probe along z, its tip there.
trial::Sample at(const Vec3& tip_m) {
  trial::Sample sample;
  sample.p_VH_m = {tip_m.x(), tip_m.y(), tip_m.z() - kLength_m};
  return sample;
}

/// In and out along z, at 4 kHz: from 30 mm before the entry to 40 mm behind it and back.
std::vector<trial::Sample> in_and_out(int samples) {
  std::vector<trial::Sample> out;
  for (int i = 0; i <= samples; ++i)
    out.push_back(at({0, 0, 0.040 - 0.070 * std::abs(2.0 * i / samples - 1.0)}));
  return out;
}

TEST(TipWay, IsKeptInStepsOfAQuarterOfAMillimetreToWhereTheTipIs) {
  TipWay way(kProbe, {});
  way.add(in_and_out(120'000));
  TipWay::Snapshot seen;
  way.show(seen);
  // 140 mm in steps of 0.25 mm and what a sample goes beyond one: 1.2 µm.
  EXPECT_NEAR(double(seen.points_m.size()), 140 / 0.25, 5);
  EXPECT_NEAR(seen.points_m.front().z(), -0.030, 1e-9);
  EXPECT_NEAR(seen.points_m.back().z(), -0.030, 1e-9);
  ASSERT_TRUE(seen.deepest && seen.withdrawn);
  EXPECT_NEAR(trial::tip_m(*seen.deepest, kProbe).z(), 0.040, 1e-9);
  // The last within 15 mm of the entry, on the way out.
  EXPECT_NEAR(trial::tip_m(*seen.withdrawn, kProbe).z(), -0.015, 2e-6);
}

TEST(TipWay, StaysBoundedAndWholeHoweverLongTheTrialIs) {
  TipWay way(kProbe, {});
  TipWay::Snapshot seen;
  for (int time = 0; time < 40; ++time) way.add(in_and_out(10'000));  // 5.6 m
  way.show(seen);
  EXPECT_LE(seen.points_m.size(), TipWay::kPoints + 1);
  EXPECT_GT(seen.points_m.size(), TipWay::kPoints / 4);
  EXPECT_NEAR(seen.points_m.front().z(), -0.030, 1e-9);
  int turns = 0;  // every one of the forty is still there
  for (std::size_t i = 1; i + 1 < seen.points_m.size(); ++i) {
    const double before = seen.points_m[i - 1].z(), now = seen.points_m[i].z();
    turns += now > before && now >= seen.points_m[i + 1].z() && now > 0.035;
  }
  EXPECT_EQ(turns, 40);
}

TEST(TipWay, OfAToolThatWasNeverWithdrawnEndsInTheBone) {
  TipWay way(kProbe, {});
  auto samples = in_and_out(1000);
  samples.resize(600);
  way.add(samples);
  TipWay::Snapshot seen;
  way.show(seen);
  ASSERT_TRUE(seen.withdrawn);
  EXPECT_EQ(seen.withdrawn->p_VH_m, samples.back().p_VH_m);
}

}  // namespace
}  // namespace session
}  // namespace tractus
