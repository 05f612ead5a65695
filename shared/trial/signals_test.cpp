#include "trial/signals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tractus {
namespace trial {
namespace {
using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Pointwise;

const std::vector<std::string> kForce{"force_xy_N"};

Header with_probe() {
  Header header;
  header.probe = {{"length_m", 0.1}, {"pose_offset_m", {0.0, 0.0, 0.02}}};
  return header;
}

/// `count` samples 1 ms apart; the transverse force of sample i is i N.
std::vector<Sample> ramp(int count) {
  std::vector<Sample> out(std::size_t(count), Sample{});
  for (int i = 0; i < count; ++i) {
    out[std::size_t(i)].t_s = i / 1000.0;
    out[std::size_t(i)].tick = std::uint32_t(i);
    out[std::size_t(i)].force_N = {0.6f * float(i), -0.8f * float(i), 0.0f};
  }
  return out;
}

TEST(Signals, PlacesTheTipByHand) {
  // A quarter turn about x takes z to -y: handle at (1, 2, 3), tip 0.1 along z of H and 0.01 along
  // x of H, offset 0.02 in z.
  Sample s;
  s.p_VH_m = {1, 2, 3};
  s.q_VH = {std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2, 0, 0};
  s.deflection_m = {0.01f, 0.0f};
  const auto tip = tip_m(s, *probe_shape(with_probe()));
  EXPECT_NEAR(tip.x(), 1.01, 1e-9);
  EXPECT_NEAR(tip.y(), 1.9, 1e-9);
  EXPECT_NEAR(tip.z(), 3.02, 1e-9);
}

TEST(Signals, DerivesDepthOffsetAndAngleByHand) {
  // Tract along -y from (1, 1.93, 3): the tip above lies 0.03 deep, (0.01, 0, 0.02) off the axis;
  // the shank runs along -y.
  Sample s;
  s.p_VH_m = {1, 2, 3};
  s.q_VH = {std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2, 0, 0};
  s.deflection_m = {0.01f, 0.0f};
  s.force_N = {3, 4, -12};
  s.torque_Nm = {0.3f, -0.4f, 0.5f};
  Signals signals(with_probe(), TractLine{{1, 1.93, 3}, {0, -1, 0}});
  signals.add({std::vector{s}, {}});
  const std::vector<std::string> all(kChannels.begin(), kChannels.end());
  const auto view = signals.view(all, 0, 1, 10);
  ASSERT_TRUE(view) << view.error().what;
  const double expected[] = {5, -12, 0.5, 0.5, 0.03, std::sqrt(5e-4), 0};
  for (std::size_t c = 0; c < 7; ++c) {
    EXPECT_EQ(view->channels[c].first, kChannels[c]);
    EXPECT_NEAR(view->channels[c].second.min[0], expected[c], 1e-6) << kChannels[c];
    EXPECT_EQ(view->channels[c].second.min, view->channels[c].second.max);
  }
  EXPECT_THAT(signals.path(5).force_N, ElementsAre(FloatNear(13, 1e-5f)));
}

TEST(Signals, EveryPointHoldsTheExtremesOfItsSamples) {
  Signals signals(Header{}, {});
  signals.add({ramp(10), {}});
  const auto view = signals.view(kForce, 0, 1, 4);  // 3 + 3 + 3 + 1
  ASSERT_TRUE(view);
  EXPECT_EQ(view->samples_per_point, 3u);
  const auto near = [](float v) { return FloatNear(v, 1e-5f); };
  EXPECT_THAT(view->channels[0].second.min, ElementsAre(near(0), near(3), near(6), near(9)));
  EXPECT_THAT(view->channels[0].second.max, ElementsAre(near(2), near(5), near(8), near(9)));
  EXPECT_THAT(view->t_s, Pointwise(testing::DoubleEq(), {0.001, 0.004, 0.007, 0.009}));
}

TEST(Signals, ARangeShowsTheSamplesInItAndNoOthers) {
  Signals signals(Header{}, {});
  signals.add({ramp(100), {}});
  const auto view = signals.view(kForce, 0.0105, 0.013, 1000);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->samples_per_point, 1u);
  EXPECT_THAT(view->t_s, ElementsAre(0.011, 0.012, 0.013));
  EXPECT_EQ(view->from_s, 0.011);
  EXPECT_EQ(view->to_s, 0.013);
  const auto none = signals.view(kForce, 5, 6, 10);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->t_s.empty());
  EXPECT_TRUE(none->channels[0].second.min.empty());
}

TEST(Signals, TheExtremesAreThoseOfASlowSearch) {
  auto samples = ramp(1000);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].force_N = {0, 0, float(int(i * 7919 % 1009) - 500)};  // scattered, both signs
  Signals signals(Header{}, {});
  signals.add({samples, {}});
  for (const std::size_t points : {1, 3, 7, 60, 130, 999, 1000}) {
    const auto view = signals.view(std::vector<std::string>{"force_z_N"}, 0, 1, points);
    ASSERT_TRUE(view);
    const auto& [low, high] = view->channels[0].second;
    for (std::size_t p = 0; p < low.size(); ++p) {
      float least = 1e9f, most = -1e9f;
      for (std::size_t i = p * view->samples_per_point;
           i < std::min(samples.size(), (p + 1) * view->samples_per_point); ++i) {
        least = std::min(least, samples[i].force_N[2]);
        most = std::max(most, samples[i].force_N[2]);
      }
      ASSERT_EQ(low[p], least) << points << " points, point " << p;
      ASSERT_EQ(high[p], most) << points << " points, point " << p;
    }
  }
}

TEST(Signals, NeverGivesMorePointsThanAskedFor) {
  Signals signals(Header{}, {});
  signals.add({ramp(1237), {}});
  for (std::size_t points = 1; points < 1500; points += 7) {
    const auto view = signals.view(kForce, 0, 10, points);
    ASSERT_TRUE(view);
    EXPECT_LE(view->t_s.size(), points);
    EXPECT_NEAR(view->channels[0].second.max.back(), 1236, 1e-3);
  }
}

TEST(Signals, RefusesWhatItDoesNotHave) {
  Signals signals(Header{}, {});
  signals.add({ramp(3), {}});
  EXPECT_FALSE(signals.has("depth_m"));
  const auto depth = signals.view(std::vector<std::string>{"depth_m"}, 0, 1, 10);
  ASSERT_FALSE(depth);
  EXPECT_THAT(depth.error().what, HasSubstr("probe or tract is not known"));
  const auto nonsense = signals.view(std::vector<std::string>{"nonsense"}, 0, 1, 10);
  ASSERT_FALSE(nonsense);
  EXPECT_THAT(nonsense.error().what, HasSubstr("expected force_xy_N"));
  EXPECT_FALSE(signals.view(kForce, 1, 0, 10));
  EXPECT_FALSE(signals.view(kForce, std::nan(""), 1, 10));
  EXPECT_FALSE(signals.view(kForce, 0, 1, 0));
  EXPECT_TRUE(signals.path(10).t_s.empty());
  Header lying;
  lying.probe = {{"length_m", "long"}};
  EXPECT_FALSE(probe_shape(lying));
  lying.probe = {{"length_m", 0.1}, {"pose_offset_m", {1, 2}}};
  EXPECT_FALSE(probe_shape(lying));
}

TEST(Signals, ThePathKeepsTheStrongestContactOfEveryStretch) {
  auto samples = ramp(1000);
  for (auto& s : samples) s.force_N = {};
  samples[777].force_N = {0, 0, 2.5f};
  samples[123].force_N = {1.5f, 0, 0};
  Signals signals(with_probe(), {});
  signals.add({samples, {}});
  const auto path = signals.path(20);
  EXPECT_EQ(path.t_s.size(), 20u);
  EXPECT_EQ(path.t_s[0], 0.0);
  EXPECT_EQ(path.t_s[2], 0.123);
  EXPECT_EQ(path.t_s[15], 0.777);
  EXPECT_EQ(path.force_N[15], 2.5f);
  EXPECT_NEAR(path.tip_m[15].z(), 0.12, 1e-7);
}

}  // namespace
}  // namespace trial
}  // namespace tractus
