/// Geometry, the life of a session and the report's figures, without a runtime.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "station/headset/eyes.hpp"
#include "station/headset/figures.hpp"
#include "station/headset/session_lifecycle.hpp"
#include "station/headset/xr.hpp"

namespace tractus {
namespace headset {
namespace {

// l = -1, r = 0.5, d = -0.5, u = 1 as tangents; near 0.1, far 10.
TEST(Projection, TakesTheCornersOfAnUnevenViewToTheCornersOfTheCube) {
  const Fov fov{.left_rad = std::atan(-1.0),
                .right_rad = std::atan(0.5),
                .up_rad = std::atan(1.0),
                .down_rad = std::atan(-0.5)};
  const Eigen::Matrix4d P = projection(fov, 0.1, 10.0);
  const auto clip = [&](double x, double y, double z) {
    const Eigen::Vector4d c = P * Eigen::Vector4d(x, y, z, 1.0);
    return Eigen::Vector3d(c.head<3>() / c.w());
  };
  EXPECT_TRUE(clip(-0.1, -0.05, -0.1).isApprox(Eigen::Vector3d(-1, -1, -1)));
  EXPECT_TRUE(clip(5.0, 10.0, -10.0).isApprox(Eigen::Vector3d(1, 1, 1)));
  // Straight ahead is not the middle: (0 + 1) / 1.5 of the width from the left.
  EXPECT_NEAR(clip(0, 0, -1).x(), 2.0 / 3.0 * 2.0 - 1.0, 1e-12);
  EXPECT_NEAR(pixel_of({0, 0, -1}, fov, 300, 300).x(), 200.0, 1e-9);
  EXPECT_NEAR(pixel_of({0, 0, -1}, fov, 300, 300).y(), 100.0, 1e-9);
}

TEST(DeviceAhead, StandsLevelBeforeThePersonWhoeverLooksWherever) {
  // Looks along -z and down: level all the same. x to the person, y to the right, z up.
  const math::Pose X_SW{{1.0, 1.6, 2.0}, math::Quat(Eigen::AngleAxisd(-0.5, math::Vec3::UnitX()))};
  const math::Pose X_SD = device_ahead_of(X_SW);
  EXPECT_TRUE(X_SD.p.isApprox(math::Vec3(1.0, 1.38, 1.55), 1e-12));
  EXPECT_TRUE((X_SD.q * math::Vec3::UnitX()).isApprox(math::Vec3::UnitZ(), 1e-12));
  EXPECT_TRUE((X_SD.q * math::Vec3::UnitY()).isApprox(math::Vec3::UnitX(), 1e-12));
  EXPECT_TRUE((X_SD.q * math::Vec3::UnitZ()).isApprox(math::Vec3::UnitY(), 1e-12));
  // Straight down at the feet: ahead is where the top of the head points.
  const math::Pose down{math::Vec3::Zero(), math::Quat(Eigen::AngleAxisd(-0.5 * std::numbers::pi,
                                                                         math::Vec3::UnitX()))};
  EXPECT_NEAR(device_ahead_of(down).p.z(), -0.45, 1e-12);
  const math::Pose up{math::Vec3::Zero(),
                      math::Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, math::Vec3::UnitX()))};
  EXPECT_NEAR(device_ahead_of(up).p.z(), -0.45, 1e-12);
}

TEST(SessionLifecycle, BeginsOnReadyEndsOnStoppingAndMayBeginAgain) {
  SessionLifecycle lifecycle;
  EXPECT_EQ(lifecycle.on_state_changed(XR_SESSION_STATE_IDLE), LifecycleAction::none);
  EXPECT_FALSE(lifecycle.running());
  EXPECT_EQ(lifecycle.on_state_changed(XR_SESSION_STATE_READY), LifecycleAction::begin);
  EXPECT_TRUE(lifecycle.running());
  EXPECT_FALSE(lifecycle.visible());
  EXPECT_EQ(lifecycle.on_state_changed(XR_SESSION_STATE_SYNCHRONIZED), LifecycleAction::none);
  EXPECT_FALSE(lifecycle.visible());
  lifecycle.on_state_changed(XR_SESSION_STATE_VISIBLE);
  EXPECT_TRUE(lifecycle.visible());
  EXPECT_FALSE(lifecycle.focused());
  lifecycle.on_state_changed(XR_SESSION_STATE_FOCUSED);
  EXPECT_TRUE(lifecycle.focused());
  EXPECT_EQ(lifecycle.on_state_changed(XR_SESSION_STATE_STOPPING), LifecycleAction::end);
  EXPECT_FALSE(lifecycle.running());
  EXPECT_EQ(lifecycle.on_state_changed(XR_SESSION_STATE_STOPPING), LifecycleAction::none);
  lifecycle.on_state_changed(XR_SESSION_STATE_IDLE);
  EXPECT_EQ(lifecycle.on_state_changed(XR_SESSION_STATE_READY), LifecycleAction::begin);
}

TEST(SessionLifecycle, IsOverForGoodWhateverComesAfterwards) {
  for (const auto last : {XR_SESSION_STATE_EXITING, XR_SESSION_STATE_LOSS_PENDING}) {
    SessionLifecycle lifecycle;
    lifecycle.on_state_changed(XR_SESSION_STATE_READY);
    EXPECT_EQ(lifecycle.on_state_changed(last), LifecycleAction::leave);
    EXPECT_TRUE(lifecycle.over());
    EXPECT_FALSE(lifecycle.running());
    EXPECT_FALSE(lifecycle.why().empty());
    for (const auto later : {XR_SESSION_STATE_READY, XR_SESSION_STATE_FOCUSED})
      EXPECT_EQ(lifecycle.on_state_changed(later), LifecycleAction::none);
    EXPECT_FALSE(lifecycle.running());
    EXPECT_FALSE(lifecycle.visible());
  }
}

TEST(Figures, AreTheFramesThatWereDueAndTheTimesThatWereTaken) {
  DueFrames due;
  for (const std::int64_t at : {1000, 1011, 1022, 1055, 1066}) due.add(at, 11);
  EXPECT_EQ(due.missed(), 2u);  // 1033 and 1044
  due.pause();
  due.add(9000, 11);
  EXPECT_EQ(due.missed(), 2u);
  FrameTimes times;
  EXPECT_EQ(times.quantile_ms(0.5), 0.0);
  for (int k = 100; k >= 1; --k) times.add(1e-3 * k);
  EXPECT_NEAR(times.quantile_ms(0.5), 50.0, 1e-4);
  EXPECT_NEAR(times.quantile_ms(0.99), 99.0, 1e-4);
  EXPECT_NEAR(times.quantile_ms(1.0), 100.0, 1e-4);
}

TEST(Words, OfARuntimesAnswersAreTheSpecifications) {
  EXPECT_EQ(name_of(XR_ERROR_SESSION_LOST), "XR_ERROR_SESSION_LOST");
  EXPECT_EQ(name_of(static_cast<XrResult>(-4711)), "XrResult -4711");
}

}  // namespace
}  // namespace headset
}  // namespace tractus
