#include "trial/motion_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tractus {
namespace trial {
namespace {

using testing::HasSubstr;

MotionProgram one_move(double to_m, double speed_m_s, double hold_s) {
  MotionProgram out{.name = "one", .words = "one", .start_m = 0.01, .acceleration_m_s2 = 0.5};
  out.moves = {{to_m, speed_m_s, 0.0, 1.0, hold_s}};
  return out;
}

/// Both stages, to and fro, short and long, with a hold.
MotionProgram many_moves() {
  MotionProgram out{.name = "many", .words = "many", .start_m = 0.002};
  out.moves = {
      {0.03, 0.02, 1.0, 2.0, 0.2}, {0.0299, 0.05, 0.5, 0.3, 0.0}, {0.002, 0.08, 0.5, 1.0, 1.0}};
  return out;
}

// By hand: to 0.02 m/s at 0.5 m/s² takes 0.04 s and 0.4 mm, and as much to stop; the other 9.2 of 10 mm last 0.46 s.
TEST(MotionProgram, RisesToItsSpeedAndHolds) {
  const MotionProgram program = one_move(0.020, 0.02, 1.0);
  EXPECT_NEAR(program.seconds(), 0.04 + 0.46 + 0.04 + 1.0, 1e-12);
  const auto motion = program.motion(0.001);
  EXPECT_NEAR(motion.x_m.front(), 0.010, 1e-12);
  EXPECT_NEAR(motion.x_m[40], 0.0104, 1e-12);
  EXPECT_NEAR(motion.v_m_s[300], 0.02, 1e-12);
  EXPECT_NEAR(motion.x_m.back(), 0.020, 1e-12);
  EXPECT_EQ(motion.v_m_s.back(), 0.0);
}

// By hand: a rise over half of 0.1 mm ends at √(1e-4 m · 0.5 m/s²) = 7.07 mm/s.
TEST(MotionProgram, ShortMoveNeverReachesItsSpeed) {
  const auto motion = one_move(0.0101, 0.08, 0.0).motion(1e-5);
  EXPECT_NEAR(*std::ranges::max_element(motion.v_m_s), std::sqrt(1e-4 * 0.5), 1e-6);
  EXPECT_NEAR(motion.x_m.back(), 0.0101, 1e-7);
}

TEST(MotionProgram, SpeedAndAccelerationAreDerivatives) {
  const double h = 1e-4;
  const auto motion = many_moves().motion(h);
  for (std::size_t i = 1; i + 1 < motion.size(); ++i) {
    EXPECT_NEAR((motion.x_m[i + 1] - motion.x_m[i - 1]) / (2 * h), motion.v_m_s[i], 2e-4) << i;
    EXPECT_NEAR((motion.theta_rad[i + 1] - motion.theta_rad[i - 1]) / (2 * h),
                motion.omega_rad_s[i], 1e-2)
        << i;
    EXPECT_NEAR((motion.v_m_s[i + 1] - motion.v_m_s[i - 1]) / (2 * h), motion.a_m_s2[i], 0.05) << i;
  }
}

TEST(MotionProgram, IsReadAsItWasWritten) {
  const auto back = MotionProgram::from_json(many_moves().to_json(), "");
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->to_json(), many_moves().to_json());
  EXPECT_EQ(back->motion(0.01).x_m, many_moves().motion(0.01).x_m);
}

TEST(MotionProgram, RefusesWhatNoRigCanPlay) {
  const auto refused = [](const core::Json& patch) {
    core::Json json = many_moves().to_json();
    json.merge_patch(patch);
    const auto read = MotionProgram::from_json(json, "p: ");
    return read ? std::string("taken") : read.error().what;
  };
  EXPECT_THAT(refused({{"format", "tractus-effect/1"}}), HasSubstr("p: format"));
  EXPECT_THAT(refused({{"rig", "palpation"}}), HasSubstr("p: rig"));
  EXPECT_THAT(refused({{"start_m", "far"}}), HasSubstr("p: start_m: a number"));
  EXPECT_THAT(refused({{"moves", core::Json::array()}}), HasSubstr("p: moves"));
  core::Json slow = one_move(0.02, 0.02, 0.0).to_json();
  slow["moves"][0]["speed_m_s"] = 0.0;
  EXPECT_THAT(MotionProgram::from_json(slow, "p: ").error().what, HasSubstr("moves/0/speed_m_s"));
  slow["moves"][0]["speed_m_s"] = 1e-5;  // 10 mm take 1000 s
  EXPECT_THAT(MotionProgram::from_json(slow, "p: ").error().what, HasSubstr("at most 600 s"));
}

}  // namespace
}  // namespace trial
}  // namespace tractus
