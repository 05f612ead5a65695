/// Where the device stands, from touched points: by hand, with noise, and what is refused.
#include "station/headset/alignment.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "station/headset/touching.hpp"
#include "station/headset/touching_hand.hpp"

namespace tractus {
namespace headset {
namespace {
namespace fs = std::filesystem;

// A triangle of 120, 200 and 233.2 mm on a table.
const std::vector<FixturePoint> kTable{
    {"A", {0.1, 0.9, -0.5}}, {"B", {0.22, 0.9, -0.5}}, {"C", {0.1, 0.9, -0.7}}};

// A quarter turn about y takes (x, y, z) to (z, y, -x); then (1, 2, 3) is added. So
// A (0.1, 0.9, -0.5) was at D: p_D = (-(z_S - 3), y_S - 2, x_S - 1) = (3.5, -1.1, -0.9).
TEST(Align, FindsAQuarterTurnAndAShiftByHand) {
  const std::vector<Touched> touched{{kTable[0], {3.5, -1.1, -0.9}},
                                     {kTable[1], {3.5, -1.1, -0.78}},
                                     {kTable[2], {3.7, -1.1, -0.9}}};
  const auto found = align(touched, 0.005);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_LT((found->X_SD.p - math::Vec3(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT((found->X_SD.q * math::Vec3::UnitX() + math::Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((found->X_SD.q * math::Vec3::UnitY() - math::Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT(found->worst_m, 1e-12);
}

// Sides 300 and 400 mm at a right angle, touched as 300 and 404: the far corner is 4 mm long. Only
// lengths can be wrong; least squares shares them among the points, so no point is 4 mm off and the
// worst one is at least a third of it.
TEST(Align, SharesWhatDoesNotFitAndRefusesWhatIsTooMuch) {
  const std::vector<Touched> touched{{{"A", {0, 0, 0}}, {0, 0, 0}},
                                     {{"B", {0.3, 0, 0}}, {0.3, 0, 0}},
                                     {{"C", {0, 0.4, 0}}, {0, 0.404, 0}}};
  const auto found = align(touched, 0.005);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_LT(found->worst_m, 0.004);
  EXPECT_GT(found->worst_m, 0.0013);
  EXPECT_EQ(found->worst, "C");
  const auto refused = align(touched, 0.001);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("point C"), std::string::npos) << refused.error().what;
  EXPECT_NE(refused.error().what.find("1.0 mm are allowed"), std::string::npos);
}

TEST(Align, PointsInTheWrongOrderDoNotFit) {
  std::vector<Touched> touched;
  const std::array<std::size_t, 3> order{1, 0, 2};
  for (std::size_t i = 0; i < 3; ++i) touched.push_back({kTable[i], kTable[order[i]].p_S_m});
  EXPECT_FALSE(align(touched, 0.005));
}

TEST(Align, PointsOnALineAndTooFewAreRefused) {
  std::vector<Touched> line;
  for (int i = 0; i < 4; ++i)
    line.push_back({{"P", {0.1 * i, 0.001 * (i % 2), 0}}, {0.1 * i, 0.001 * (i % 2), 0}});
  const auto on_a_line = align(line, 0.005);
  ASSERT_FALSE(on_a_line);
  EXPECT_NE(on_a_line.error().what.find("lie on a line"), std::string::npos);
  EXPECT_FALSE(align(std::span(line).first(2), 0.005));
}

// The residual of n noisy points: rms^2 = 3 sigma^2 (1 - 6 / 3n) on average; eight points of
// 0.5 mm an axis: 0.75 mm.
TEST(Align, LeavesTheResidualThatNoiseLeaves) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 5e-4), place(0.0, 0.2);
  const math::Pose X_SD{{0.3, 1.1, -0.4},
                        math::Quat(Eigen::AngleAxisd(2.0, math::Vec3(1, 2, 3).normalized()))};
  double squares = 0.0, worst_place_m = 0.0;
  constexpr int kRounds = 200;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Touched> touched;
    for (int i = 0; i < 8; ++i) {
      const math::Vec3 p_D(place(random), place(random), place(random));
      const math::Vec3 off(noise(random), noise(random), noise(random));
      touched.push_back({{"P", X_SD * p_D + off}, p_D});
    }
    const auto found = align(touched, 0.01);
    ASSERT_TRUE(found) << found.error().what;
    squares += found->rms_m * found->rms_m;
    worst_place_m = std::max(worst_place_m, (found->X_SD.p - X_SD.p).norm());
  }
  EXPECT_NEAR(std::sqrt(squares / kRounds), 7.5e-4, 0.4e-4);
  EXPECT_LT(worst_place_m, 1.5e-3);
}

class AlignmentFiles : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::string refusal(const std::string& points) {
    const std::string text = R"({"format":"tractus-fixture/1","points":)" + points + "}";
    EXPECT_TRUE(core::write_file(folder_ / "f.json", core::bytes_of(text)));
    const auto read = read_fixture(folder_ / "f.json");
    return read ? "read" : read.error().what;
  }
  const fs::path folder_ = fs::temp_directory_path() / ("tractus_align_" + core::new_id());
};

TEST_F(AlignmentFiles, AFixtureWhosePointsTellEachOtherApartIsReadOthersAreRefused) {
  const auto three = [](const char* c) {
    return std::string(R"([{"name":"A","stage_m":[0,0,0]},{"name":"B","stage_m":[0.3,0,0]},)") +
           R"({"name":"C","stage_m":)" + c + "}]";
  };
  EXPECT_EQ(refusal(three("[0,0.2,0]")), "read");
  EXPECT_NE(refusal(three("[0,0.3,0]")).find("taken for each other"), std::string::npos);
  EXPECT_NE(refusal(three("[0.15,0.001,0]")).find("on a line"), std::string::npos);
  EXPECT_NE(refusal(three("[0,200,0]")).find("/points/2"), std::string::npos);
  EXPECT_NE(refusal(three("[0,0.2]")).find("stage_m"), std::string::npos);
  EXPECT_NE(refusal("[]").find("json: /points: a list of 3 … 8 points"), std::string::npos);
  std::string twice = three("[0,0.2,0]");
  twice.replace(twice.find("\"B\""), 3, "\"A\"");
  EXPECT_NE(refusal(twice).find("/points/1/name: 'A' is there twice"), std::string::npos);
}

TEST_F(AlignmentFiles, WhatIsKeptIsReadAgainAndAMeddledOneIsRefused) {
  const auto none = kept_alignment(folder_);
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->has_value());
  KeptAlignment kept;
  kept.alignment.X_SD = {{0.1, 0.2, 0.3}, math::Quat(Eigen::AngleAxisd(1, math::Vec3::UnitZ()))};
  kept.alignment.worst_m = 0.002;
  kept.device = "lambda6";
  kept.made_utc_us = 1'770'000'000'000'000;
  ASSERT_TRUE(keep_alignment(folder_, kept, {}));
  const auto again = kept_alignment(folder_);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ((*again)->alignment.X_SD.p, kept.alignment.X_SD.p);
  EXPECT_EQ((*again)->alignment.X_SD.q.coeffs(), kept.alignment.X_SD.q.coeffs());
  EXPECT_EQ((*again)->device, "lambda6");
  EXPECT_EQ((*again)->made_utc_us, kept.made_utc_us);
  auto json = core::read_json(folder_ / "alignment.json");
  (*json)["q_SD"] = {1, 1, 0, 0};
  ASSERT_TRUE(core::write_json(folder_ / "alignment.json", *json));
  const auto meddled = kept_alignment(folder_);
  ASSERT_FALSE(meddled);
  EXPECT_NE(meddled.error().what.find("q_SD"), std::string::npos) << meddled.error().what;
}

TEST(Touch, IsTheMeanOfAMomentHeldStillAndNothingWhenItMoved) {
  Touch touch;
  EXPECT_EQ(touch.feed(0.0, {1, 2, 3}, false), Touch::State::waiting);
  EXPECT_EQ(touch.feed(0.1, {1, 2, 3}, true), Touch::State::holding);
  EXPECT_EQ(touch.feed(0.2, {1.002, 2, 3}, false), Touch::State::moved);  // 2 mm
  EXPECT_EQ(touch.feed(0.3, {1, 2, 3}, false), Touch::State::waiting);
  EXPECT_EQ(touch.feed(0.4, {1, 2, 3}, true), Touch::State::holding);
  EXPECT_EQ(touch.feed(0.5, {1.001, 2, 3}, false), Touch::State::holding);
  EXPECT_EQ(touch.feed(0.75, {1.0005, 2, 3}, false), Touch::State::done);
  EXPECT_TRUE(touch.tip_D_m().isApprox(math::Vec3(1.0005, 2, 3), 1e-12));
}

// The scripted hand knows where it pretends that the device stands; who aligns does not.
TEST(Touching, AScriptedHandLeadsToWhereTheDeviceStands) {
  const math::Vec3 tip_H(0, 0, 0.08);
  TouchingHand hand(kTable, tip_H);
  ASSERT_TRUE(hand.open());
  core::ManualClock clock;
  int asked = 0;
  const TouchExchange talk{.ask = [&](const FixturePoint&) { ++asked; },
                           .moved = [](const FixturePoint&) { FAIL(); },
                           .enter = [] { return false; },
                           .stop = [] { return false; }};
  const auto touched = touch_points(hand, clock, kTable, tip_H, talk);
  ASSERT_TRUE(touched) << touched.error().what;
  EXPECT_EQ(asked, 3);
  const auto found = align(*touched, 0.005);
  ASSERT_TRUE(found) << found.error().what;
  const math::Pose truth = TouchingHand::stands_at();
  EXPECT_LT((found->X_SD.p - truth.p).norm(), 1e-3);
  EXPECT_LT(found->X_SD.q.angularDistance(truth.q), 2e-3);
  EXPECT_LT(found->worst_m, 6e-4);  // the hand misses each point by up to 0.5 mm
}

// Its watchdog met a slow machine: there is no force, which nobody wanted, and a pose all the same.
TEST(Touching, GoesOnWithADeviceThatTookItsForcesAway) {
  class Forceless final : public devices::Device {
   public:
    core::Result<devices::Limits> open() override { return hand.open(); }
    devices::Status read(core::Instant_ns now, devices::Sample& out) noexcept override {
      const auto status = hand.read(now, out);
      return ++reads % 8 == 0 ? devices::Status::forces_off : status;
    }
    devices::Status write(const math::Wrench&) noexcept override {
      return devices::Status::forces_off;
    }
    void close() noexcept override {}
    TouchingHand hand{kTable, math::Vec3::Zero()};
    int reads = 0;
  } device;
  ASSERT_TRUE(device.open());
  core::ManualClock clock;
  const TouchExchange talk{.ask = [](const FixturePoint&) {},
                           .moved = [](const FixturePoint&) { FAIL(); },
                           .enter = [] { return false; },
                           .stop = [] { return false; }};
  const auto touched = touch_points(device, clock, kTable, math::Vec3::Zero(), talk);
  ASSERT_TRUE(touched) << touched.error().what;
  EXPECT_TRUE(align(*touched, 0.005));
}

TEST(Touching, EndsWhenAPersonSaysSoAndWhenTheDeviceIsGone) {
  TouchingHand hand(kTable, math::Vec3::Zero());
  ASSERT_TRUE(hand.open());
  core::ManualClock clock;
  TouchExchange talk{.ask = [](const FixturePoint&) {},
                     .moved = [](const FixturePoint&) {},
                     .enter = [] { return false; },
                     .stop = [&] { return clock.now() > 100'000'000; }};
  const auto stopped = touch_points(hand, clock, kTable, math::Vec3::Zero(), talk);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, core::Errc::cancelled);

  class Gone final : public devices::Device {
   public:
    core::Result<devices::Limits> open() override { return devices::Limits{}; }
    devices::Status read(core::Instant_ns, devices::Sample&) noexcept override {
      return devices::Status::gone;
    }
    devices::Status write(const math::Wrench&) noexcept override { return devices::Status::gone; }
    void close() noexcept override {}
  } gone;
  talk.stop = [] { return false; };
  const auto lost = touch_points(gone, clock, kTable, math::Vec3::Zero(), talk);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, core::Errc::unavailable);
}

}  // namespace
}  // namespace headset
}  // namespace tractus
