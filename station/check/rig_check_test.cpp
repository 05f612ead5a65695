#include "station/check/rig_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace tractus {
namespace check {
namespace {
namespace registers = devices::rig;
using devices::Exchange;
using devices::RigCommand;
using devices::RigReading;
using Names = std::vector<std::string>;

/// A stage that follows its command at once, with a watchdog of 6 ms; what is wrong with it is
/// said.
class Trolley final : public devices::RigDevice {
 public:
  explicit Trolley(core::ManualClock& clock) : clock_(clock), last_(clock.now()) {}
  core::Result<devices::RigIdentity> open() override { return devices::RigIdentity{}; }
  void close() noexcept override {}
  Exchange exchange(const RigCommand& command, RigReading& out) noexcept override {
    advance(1e-9 * double(clock_.now() - last_));
    last_ = clock_.now();
    if (++asked % 10 < lost_of_ten) return Exchange::silent;
    out = {.x_m = x_, .speed_m_s = v_, .angle_urad = std::int32_t(1e6 * theta_), .fz_N = zero_N};
    out.fault = fault_ ? registers::RigFault::watchdog : registers::RigFault::none;
    out.status = static_cast<std::uint16_t>((on_ ? registers::kEnabled : 0) |
                                            (fault_ ? registers::kFaulted : 0) |
                                            (emergency ? registers::kEmergency : 0));
    if (command.reset_fault && !was_.reset_fault) fault_ = false;
    if (command.enable && !was_.enable) on_ = !fault_ && !emergency;
    if (!command.enable) on_ = false;
    was_ = command;
    fastest_m_s = std::max(fastest_m_s, std::abs(command.speed_m_s));
    return Exchange::ok;
  }
  double way = 1.0, turning = 1.0, zero_N = 0.5, fastest_m_s = 0.0;
  bool emergency = false, watchdog = true;
  int lost_of_ten = 0, asked = 0;
  const RigCommand& last_command() const { return was_; }
  double x_m() const { return x_; }

 private:
  void advance(double for_s) {
    const double moves_s = on_ && watchdog ? std::min(for_s, 0.006) : for_s;
    v_ = on_ ? way * was_.speed_m_s : 0.0;
    x_ = std::max(0.0, x_ + v_ * moves_s);
    if (was_.rotary_on) theta_ += turning * for_s * (spin_ += was_.torque_Nm / 2e-4 * for_s);
    if (on_ && watchdog && for_s > 0.006) on_ = false, fault_ = true, v_ = 0.0;
  }
  core::ManualClock& clock_;
  core::Instant_ns last_;
  RigCommand was_;
  double x_ = 0.0, v_ = 0.0, theta_ = 0.0, spin_ = 0.0;
  bool on_ = false, fault_ = false;
};

struct RigCheck : testing::Test {
  core::ManualClock clock;
  Trolley trolley{clock};
  std::vector<Finding> found;
  RigBench bench() { return {.clock = clock, .wall = clock, .device = trolley}; }
  Names failed() const {
    Names out;
    for (const Finding& f : found)
      if (!f.passed) out.push_back(f.name);
    return out;
  }
  double value_of(const std::string& name) const {
    const auto at = std::ranges::find(found, name, &Finding::name);
    EXPECT_NE(at, found.end()) << name;
    return at == found.end() ? -1.0 : at->value.value_or(-1.0);
  }
};

TEST_F(RigCheck, PassesARigThatDoesWhatItIsTold) {
  const auto may_move = check_rig_at_rest(bench(), {}, found);
  ASSERT_TRUE(may_move) << may_move.error().what;
  EXPECT_TRUE(*may_move);
  const auto moved = check_rig_motion(bench(), {}, found);
  ASSERT_TRUE(moved) << moved.error().what;
  EXPECT_EQ(failed(), Names{});
  EXPECT_NEAR(value_of("sensor zero, push"), 0.5, 1e-9);
  EXPECT_NEAR(value_of("small travel"), 0.0, 5e-5);  // a period's way is 20 µm
  EXPECT_NEAR(value_of("watchdog of the rig"), 0.006, 1e-6);
  // 100 rad/s² for 0.05 s and back: 0.125 rad each.
  EXPECT_NEAR(value_of("direction of the rotary motor"), 0.25, 0.01);
  EXPECT_LE(trolley.fastest_m_s, 0.02);
  EXPECT_FALSE(trolley.last_command().enable);  // left off
  EXPECT_LT(trolley.x_m(), 2e-4);
}

TEST_F(RigCheck, FindsAStageThatGoesTheWrongWay) {
  trolley.way = -1.0;
  static_cast<void>(check_rig_motion(bench(), {}, found));
  EXPECT_EQ(failed().front(), "small travel");
}

TEST_F(RigCheck, FindsAMotorThatTurnsTheWrongWay) {
  trolley.turning = -1.0;
  ASSERT_TRUE(check_rig_motion(bench(), {}, found));
  EXPECT_EQ(failed(), Names{"direction of the rotary motor"});
}

TEST_F(RigCheck, FindsAMachineThatGoesOnWithoutAWordFromUs) {
  trolley.watchdog = false;
  ASSERT_TRUE(check_rig_motion(bench(), {}, found));
  EXPECT_EQ(failed(), Names{"watchdog of the rig"});
}

TEST_F(RigCheck, DoesNotMoveARigWhoseEmergencyStopIsLatched) {
  trolley.emergency = true;
  const auto may_move = check_rig_at_rest(bench(), {}, found);
  ASSERT_TRUE(may_move);
  EXPECT_FALSE(*may_move);
  EXPECT_EQ(failed(), Names{"emergency stop"});
  const auto moved = check_rig_motion(bench(), {}, found);
  ASSERT_FALSE(moved);
  EXPECT_NE(moved.error().what.find("emergency stop"), std::string::npos);
  EXPECT_EQ(trolley.fastest_m_s, 0.0);
}

TEST_F(RigCheck, FindsALinkThatLosesAnswersAndAnOverloadedSensor) {
  trolley.lost_of_ten = 1;
  trolley.zero_N = 14.0;
  const auto may_move = check_rig_at_rest(bench(), {}, found);
  ASSERT_TRUE(may_move);
  EXPECT_EQ(failed(), (Names{"link, answers lost", "sensor zero, push"}));
  EXPECT_NEAR(value_of("link, answers lost"), 0.1, 1e-9);
}

TEST_F(RigCheck, ARigThatNeverAnswersIsNotMoved) {
  trolley.lost_of_ten = 10;
  const auto may_move = check_rig_at_rest(bench(), {}, found);
  ASSERT_TRUE(may_move);
  EXPECT_FALSE(*may_move);
  EXPECT_EQ(failed().front(), "link, answers lost");
}

TEST_F(RigCheck, EndsWithTheDriveOffWhenSomebodyStopsIt) {
  RigBench stopped = bench();
  int asked = 0;
  stopped.progress = [&](double) { return ++asked < 12; };  // in the small travel
  const auto moved = check_rig_motion(stopped, {}, found);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().code, core::Errc::cancelled);
  EXPECT_GT(trolley.x_m(), 0.0);
  EXPECT_FALSE(trolley.last_command().enable);
  EXPECT_EQ(trolley.last_command().speed_m_s, 0.0);
}

TEST_F(RigCheck, WaitsForAPersonToPressAndToReset) {
  std::vector<std::string> told;
  const auto pressed = check_emergency_stop(bench(), 1.0, [&](const char* what) {
    told.push_back(what);
    trolley.emergency = told.size() == 1;
  });
  ASSERT_TRUE(pressed);
  EXPECT_TRUE(pressed->passed) << pressed->words;
  EXPECT_EQ(told.size(), 2u);
  const auto ignored = check_emergency_stop(bench(), 1.0, [](const char*) {});
  ASSERT_TRUE(ignored);
  EXPECT_FALSE(ignored->passed);
}

}  // namespace
}  // namespace check
}  // namespace tractus
