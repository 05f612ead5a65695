#include "replay/probing_replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace replay {
namespace {

using testing::HasSubstr;

constexpr double kStiffness = 4000.0, kDamping = 2000.0;

models::ProbingModel one_layer() {
  models::ProbingModel model;
  model.name = "one layer";
  model.layers = {{0.0, 0.05, kStiffness, kDamping, 0.0}};
  return model;
}

/// Strokes within the layer with the push that spring and damper ask for, written down here, plus
/// `more_N` against the motion.
trial::ProbingMeasurement strokes(double more_N = 0.0, bool angle = true) {
  trial::ProbingMeasurement t;
  t.id = "t1";
  t.file = "t1.csv";
  t.operator_name = "S1";
  for (int k = 0; k < 4000; ++k) {
    const double s = 0.001 * k;
    const double x = 0.010 - 0.006 * std::cos(2.0 * s), v = 0.012 * std::sin(2.0 * s);
    t.t_s.push_back(s);
    t.x_m.push_back(x);
    t.fz_N.push_back(kStiffness * x + kDamping * v + (v > 0 ? more_N : -more_N));
    if (angle) t.theta_rad.push_back(1.5 * s);
  }
  return t;
}

ProbingReplayed replayed(const trial::ProbingMeasurement& recording) {
  auto out = replay(one_layer(), recording, {}, "t1.csv");
  EXPECT_TRUE(out) << out.error().what;
  return std::move(*out);
}

TEST(ProbingReplay, GivesThePushOfSpringAndDamperBack) {
  const auto recording = strokes();
  const auto out = replayed(recording);
  ASSERT_EQ(out.forces.fz_N.size(), recording.fz_N.size());
  for (std::size_t k = 50; k + 50 < recording.fz_N.size(); ++k)
    ASSERT_NEAR(out.forces.fz_N[k], recording.fz_N[k], 0.05) << k;  // of some 50 N
}

TEST(ProbingReplay, TheRecordedPushDrivesTheModelWhereItWent) {
  const auto recording = strokes();
  const auto out = replayed(recording);
  for (std::size_t k = 0; k < recording.x_m.size(); ++k)
    ASSERT_NEAR(out.live_x_m[k], recording.x_m[k], 2e-5) << k;  // a tick's way at 12 mm/s is 12 µm
}

TEST(ProbingReplay, AStageThatOnlySlidesIsDrivenToo) {
  const auto recording = strokes(0.0, false);
  const auto out = replayed(recording);
  EXPECT_TRUE(out.forces.tz_Nm.empty());
  EXPECT_NEAR(out.live_x_m.back(), recording.x_m.back(), 2e-5);
}

TEST(ProbingReplay, TellsTheFrictionLeftOutAsItsError) {
  const auto recording = strokes(3.0);
  const auto table = rows({recording}, {replayed(recording)});
  // all, operator and trial; the force and the driven depth each
  ASSERT_EQ(table.size(), 6u);
  EXPECT_EQ(table[0].scope, "all");
  EXPECT_EQ(table[0].channel, "fz_N");
  EXPECT_NEAR(table[0].rmse, 3.0, 0.05);  // N, always one way or the other
  EXPECT_THAT(csv(table), HasSubstr("trial,t1,fz_N,4000,"));
}

TEST(ProbingReplay, ARigThatOnlyTurnsIsReplayedInTorque) {
  trial::ProbingMeasurement t;
  t.id = t.file = "t1";
  models::ProbingModel model = one_layer();
  model.rotary = {.viscous_Nms_per_rad = 0.1, .detent_Nm = 0.0, .detent_pitch_rad = 0.35};
  for (int k = 0; k < 2000; ++k) {
    t.t_s.push_back(0.002 * k);
    t.theta_rad.push_back(0.5 * std::sin(t.t_s.back()));
    t.tz_Nm.push_back(0.05 * std::cos(t.t_s.back()));  // 0.1 N·m·s/rad times the speed
  }
  const auto out = replay(model, t, {}, "t1");
  ASSERT_TRUE(out) << out.error().what;
  EXPECT_TRUE(out->forces.fz_N.empty());
  EXPECT_TRUE(out->live_x_m.empty());
  for (std::size_t k = 50; k + 50 < t.tz_Nm.size(); ++k)
    ASSERT_NEAR(out->forces.tz_Nm[k], t.tz_Nm[k], 1e-3) << k;
}

TEST(ProbingReplay, WritesEachTrialWithWhatWasMeasuredBesideIt) {
  const auto recording = strokes();
  const std::string text = csv(recording, replayed(recording));
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "t_s,x_m,theta_rad,fz_N,tz_Nm,measured_fz_N,speed_m_s,turning_rad_s,live_x_m");
  EXPECT_EQ(std::ranges::count(text, '\n'), 4001);
}

TEST(ProbingReplay, TooFewSamplesAreRefusedByName) {
  auto recording = strokes();
  recording.t_s.resize(20), recording.x_m.resize(20), recording.fz_N.resize(20);
  recording.theta_rad.resize(20);
  const auto out = replay(one_layer(), recording, {}, "set/t1.csv");
  ASSERT_FALSE(out);
  EXPECT_THAT(out.error().what, HasSubstr("set/t1.csv"));
}

}  // namespace
}  // namespace replay
}  // namespace tractus
