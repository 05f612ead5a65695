#include <gtest/gtest.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "station/check/device_check.hpp"
#include "station/check/machine_check.hpp"
#include "station/devices/catalogue.hpp"

namespace tractus {
namespace check {
namespace {
using devices::Status;
using math::Vec3;

/// A handle on springs of 400 N/m and 5 N·m/rad with a lag of 10 ms; what is wrong with it is said.
class Springy final : public devices::Device {
 public:
  core::Result<devices::Limits> open() override { return devices::Limits{20, 0.2, 4000}; }
  Status read(core::Instant_ns now, devices::Sample& out) noexcept override {
    past_.push_back(wrench_);
    const math::Wrench& felt = past_[past_.size() > late ? past_.size() - 1 - late : 0];
    p_ += 0.025 * (sign.cwiseProduct(felt.force_N) / 400.0 - p_);  // 0.25 ms of 10 ms
    turn_ += 0.025 * (felt.torque_Nm / 5.0 - turn_);
    wander_ += drift_m_s * 0.00025;
    out = {};
    out.stamp = now;
    out.X_DH.p = p_ + Vec3(wander_, 0, 0);
    if (turn_.norm() > 0) out.X_DH.q = Eigen::AngleAxisd(turn_.norm(), turn_.normalized());
    return ++reads == fault_at ? Status::fault : Status::ok;
  }
  Status write(const math::Wrench& w) noexcept override {
    wrench_ = w;
    most_N = std::max(most_N, w.force_N.norm());
    return Status::ok;
  }
  void close() noexcept override {}
  Vec3 sign = Vec3::Ones();
  double drift_m_s = 0.0, most_N = 0.0;
  std::size_t late = 0;  ///< ticks until a wrench is felt
  int fault_at = -1, reads = 0;
  math::Wrench wrench_;

 private:
  std::vector<math::Wrench> past_;
  Vec3 p_ = Vec3::Zero(), turn_ = Vec3::Zero();
  double wander_ = 0.0;
};

Finding named(const std::vector<Finding>& all, const std::string& name) {
  for (const Finding& f : all)
    if (f.name == name) return f;
  ADD_FAILURE() << "no finding " << name;
  return {.name = name, .value = 1e9};
}

std::vector<std::string> failed(const std::vector<Finding>& all) {
  std::vector<std::string> out;
  for (const Finding& f : all)
    if (!f.passed) out.push_back(f.name);
  return out;
}

using Names = std::vector<std::string>;
const loop::HandLimits kLimits;

struct Rig {
  core::ManualClock clock;
  Springy device;
  loop::Limiter limiter{kLimits, 250'000};
  std::vector<Finding> found;
  core::Result<void> forces() {
    return check_forces({clock, clock, device, limiter}, DeviceGoals{}, found);
  }
};

TEST(DeviceCheck, PassesADeviceThatDoesWhatItIsTold) {
  Rig run;
  const auto ran = run.forces();
  ASSERT_TRUE(ran) << ran.error().what;
  ASSERT_EQ(run.found.size(), 11u);  // rest, six directions, three of the step, the round trip
  EXPECT_EQ(failed(run.found), Names{});
  EXPECT_NEAR(*named(run.found, "direction along y (to the right)").value, 1.0 / 400.0, 1e-5);
  EXPECT_NEAR(*named(run.found, "direction about z (up)").value, 0.03 / 5.0, 1e-5);
  // Of a lag of 10 ms: a tenth after 10 ms · ln(1/0.9) = 1.05 ms, and half of the slew's 0.5 ms;
  // from there to nine tenths 10 ms · ln 9 = 22 ms; no overshoot.
  EXPECT_NEAR(*named(run.found, "step response, delay").value, 0.0013, 0.0006);
  EXPECT_NEAR(*named(run.found, "step response, rise time").value, 0.022, 0.0006);
  EXPECT_NEAR(*named(run.found, "step response, overshoot").value, 0.0, 1e-6);
  EXPECT_LE(run.device.most_N, 1.0 + 1e-12);
  EXPECT_TRUE(run.device.wrench_.force_N.isZero(0.0));  // left at zero
  EXPECT_EQ(run.limiter.guard(), loop::Guard::off);
}

TEST(DeviceCheck, NamesTheAxisThatGoesTheWrongWayAndNoOther) {
  Rig run;
  run.device.sign = {1, -1, 1};
  ASSERT_TRUE(run.forces());
  EXPECT_EQ(failed(run.found), Names{"direction along y (to the right)"});
  EXPECT_NE(named(run.found, "direction along y (to the right)").words.find("WRONG WAY"),
            std::string::npos);
}

TEST(DeviceCheck, NamesTheAxisThatDoesNotMove) {
  Rig run;
  run.device.sign = {1, 1, 0};
  ASSERT_TRUE(run.forces());
  EXPECT_EQ(failed(run.found), Names{"direction along z (up)"});
  EXPECT_NE(named(run.found, "direction along z (up)").words.find("does not move"),
            std::string::npos);
}

TEST(DeviceCheck, FindsAHandleThatWandersAndOneThatAnswersLate) {
  Rig wanders;
  wanders.device.drift_m_s = 0.004;
  ASSERT_TRUE(wanders.forces());
  const Finding rest = named(wanders.found, "rest at zero force");
  EXPECT_FALSE(rest.passed);
  EXPECT_NEAR(*rest.value, 0.004, 1e-4);  // 4 mm/s over a second
  Rig late;
  late.device.late = 400;  // 0.1 s
  ASSERT_TRUE(late.forces());
  EXPECT_EQ(failed(late.found), Names{"step response, delay"});
}

TEST(DeviceCheck, EndsAtADevicesFaultWithItsWordAndKeepsWhatItFoundBefore) {
  Rig run;
  run.device.fault_at = 12'000;  // 3 s: past the rest
  const auto ran = run.forces();
  ASSERT_FALSE(ran);
  EXPECT_NE(ran.error().what.find("the device reported a fault"), std::string::npos);
  EXPECT_TRUE(named(run.found, "rest at zero force").passed);
  EXPECT_TRUE(run.device.wrench_.force_N.isZero(0.0));
}

TEST(DeviceCheck, EndsAtZeroForceWhenSomebodyStopsIt) {
  Rig run;
  int asked = 0;
  std::vector<Finding> found;
  const auto ran = check_forces({run.clock, run.clock, run.device, run.limiter, 4000.0,
                                 [&](double) { return ++asked < 95; }},  // in a push, at 3.1 s
                                DeviceGoals{}, found);
  ASSERT_FALSE(ran);
  EXPECT_EQ(ran.error().code, core::Errc::cancelled);
  EXPECT_NEAR(run.device.most_N, 1.0, 1e-9);
  EXPECT_TRUE(run.device.wrench_.force_N.isZero(0.0));
}

devices::MadeDevice simulated(double for_s) {
  auto made = devices::find("sim-lambda6")->make({.seed = 3, .duration_s = for_s});
  return std::move(*made);
}

TEST(DeviceCheck, PassesTheSimulatedLambda6InItsSimulatedHand) {
  const auto made = simulated(3600.0);
  ASSERT_TRUE(made.device->open());
  core::ManualClock clock;
  loop::Limiter limiter(kLimits, 250'000);
  std::vector<Finding> found;
  ASSERT_TRUE(check_forces({clock, clock, *made.device, limiter}, DeviceGoals{}, found));
  for (const Finding& f : found) EXPECT_TRUE(f.passed) << f.name << ": " << f.words;
}

TEST(DeviceCheck, MeasuresTheTravelOfAMovingHand) {
  const auto made = simulated(4.0);
  ASSERT_TRUE(made.device->open());
  core::ManualClock clock;
  loop::Limiter limiter(kLimits, 250'000);
  std::vector<Finding> found;
  ASSERT_TRUE(check_travel({clock, clock, *made.device, limiter}, {.travel_m = 0.002}, 4.0, found));
  EXPECT_TRUE(found.back().passed) << found.back().words;
  ASSERT_TRUE(check_travel({clock, clock, *made.device, limiter}, {}, 0.5, found));
  EXPECT_FALSE(found.back().passed);
}

TEST(Durations, GiveTheNearestRank) {
  Durations took(1000);
  for (int k = 100; k >= 1; --k) took.add(k * 1000);  // 1 … 100 µs
  EXPECT_DOUBLE_EQ(took.quantile_s(0.5), 50e-6);
  EXPECT_DOUBLE_EQ(took.quantile_s(0.99), 99e-6);
  EXPECT_DOUBLE_EQ(took.quantile_s(1.0), 100e-6);
  EXPECT_EQ(Durations(4).quantile_s(0.5), 0.0);
}

TEST(MachineCheck, LeavesNothingOnTheDisk) {
  const auto folder = std::filesystem::temp_directory_path() / core::new_id();
  std::filesystem::create_directories(folder);
  std::vector<Finding> found;
  ASSERT_TRUE(check_disk(folder, found));
  EXPECT_EQ(found.size(), 2u);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  EXPECT_FALSE(check_disk(folder / "no such", found));
  std::filesystem::remove_all(folder);
}

TEST(MachineCheck, HoldsTheDaysTimeAgainstTheServers) {
  EXPECT_TRUE(check_time_of_day(Offset{-0.9, 0.01}).passed);
  EXPECT_FALSE(check_time_of_day(Offset{2.0, 0.01}).passed);
  EXPECT_TRUE(check_time_of_day(Offset{2.0, 3.0}).passed) << "not known that well";
}

TEST(MachineCheck, SaysWhenCalibrationIsSoonDueAndOver) {
  constexpr std::int64_t kDay_us = 86'400'000'000;
  const Calibration last{.at_utc_us = 0, .due_utc_us = 30 * kDay_us, .kind = "lambda6", .who = "T"};
  EXPECT_FALSE(check_calibration(std::nullopt, 1000, Tested::machine).passed);
  EXPECT_TRUE(check_calibration(last, 30 * kDay_us - 1, Tested::machine).passed);
  EXPECT_FALSE(check_calibration(last, 30 * kDay_us, Tested::machine).passed);
  EXPECT_EQ(due_warning(last, 22 * kDay_us), "");
  EXPECT_NE(due_warning(last, 24 * kDay_us).find("is due on 1970-01-31"), std::string::npos);
  EXPECT_NE(due_warning(last, 30 * kDay_us).find("OVERDUE"), std::string::npos);
}

TEST(Report, HasTheServersFieldsAndOfACalibrationWhoDidIt) {
  const auto folder = std::filesystem::temp_directory_path() / core::new_id();
  Report report;
  report.self_test =
      SelfTest{.at_utc_us = 7, .device = "d", .findings = {{.name = "travel", .words = "a\nb"}}};
  report.calibration =
      Calibration{.at_utc_us = 1, .due_utc_us = 2, .kind = "k", .who = "Ada", .words = "w"};
  const auto file = report.leave(folder);
  ASSERT_TRUE(file);
  const auto json = core::read_json(*file);
  ASSERT_TRUE(json);
  const bool passed = (*json)["self_test"]["passed"].get<bool>();
  EXPECT_FALSE(passed);
  for (const char* key : {"name", "passed", "value", "unit", "limit", "words"})
    EXPECT_TRUE((*json)["self_test"]["checks"][0].contains(key)) << key;
  EXPECT_EQ((*json)["calibration"]["words"], "by Ada: w");
  std::filesystem::remove_all(folder);
}

TEST(Calibration, OfASimulationDoesNotCountForTheMachine) {
  const Calibration last{.at_utc_us = 1,
                         .due_utc_us = 1'000'000'000'000,
                         .kind = "rig",
                         .who = "Ada",
                         .words = "w",
                         .simulated = true};
  EXPECT_FALSE(check_calibration(last, 1000, Tested::machine).passed);
  EXPECT_TRUE(check_calibration(last, 1000, Tested::simulation).passed);
  EXPECT_NE(due_warning(last, 1000).find("SIMULATED"), std::string::npos);
  const auto back = Calibration::from_json(last.to_json(), "");
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_TRUE(back->simulated);
}

TEST(Calibration, ComesBackFromItsFileAndNamesAWrongField) {
  const Calibration one{.at_utc_us = 1,
                        .due_utc_us = 2,
                        .kind = "rig",
                        .who = "Ada",
                        .words = "w",
                        .zero_N = -1.25,
                        .zero_Nm = 0.003};
  const auto back = Calibration::from_json(one.to_json(), "");
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->to_json(), one.to_json());
  core::Json wrong = one.to_json();
  wrong["due_utc_us"] = "soon";
  const auto none = Calibration::from_json(wrong, "calibration.json: ");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("due_utc_us"), std::string::npos);
  EXPECT_FALSE(*Calibration::read("/no/such/calibration.json"));
}

TEST(Finding, IsSpelledForAPerson) {
  const Finding way{.value = 0.0028, .limit = 0.0005, .bound = Bound::at_least, .unit = "m"};
  EXPECT_EQ(found_of(way), "2.8 mm");
  EXPECT_EQ(wanted_of(way), "at least 0.5 mm");
  EXPECT_EQ(found_of({.value = 2.1e-5, .unit = "s"}), "21 µs");
  EXPECT_EQ(wanted_of({.limit = 0.001}), "at most 0.1 %");
  EXPECT_EQ(found_of({}) + wanted_of({}), "");
}

TEST(SelfTest, TellsTheServerWhatWasTestedAndThatItWasNoMachine) {
  SelfTest test{.device = "d 7", .simulated = true, .findings = {{.name = "travel"}}};
  const auto checks = test.to_json()["checks"];
  ASSERT_EQ(checks.size(), 2u);
  EXPECT_EQ(checks[0]["name"], "device");
  EXPECT_EQ(checks[0]["words"], "d 7 (SIMULATED: no machine was tested)");
  test.findings.push_back({.name = "device", .words = "it was unplugged"});
  EXPECT_EQ(test.to_json()["checks"].size(), 2u) << "what went wrong with it is told already";
}

TEST(Report, MarksTheCalibrationOfASimulatedDevice) {
  Report report;
  report.calibration = Calibration{.kind = "sim-lambda6", .who = "Ada"};
  EXPECT_EQ(report.to_html("st").find("class=mark"), std::string::npos);
  report.calibration->simulated = true;
  EXPECT_NE(report.to_html("st").find("class=mark>SIMULATED"), std::string::npos);
}

TEST(Report, EscapesWhatItPrints) {
  Report report;
  report.self_test = SelfTest{.device = "<script>&\"", .findings = {{.name = "<b>"}}};
  const std::string html = report.to_html("<station>");
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_EQ(html.find("<b>:"), std::string::npos);
  EXPECT_NE(html.find("&lt;script&gt;&amp;&quot;"), std::string::npos);
}

}  // namespace
}  // namespace check
}  // namespace tractus
