/// A trial that is seen in a headset: `tractus-station --view headset` against the test runtime
/// (tests/support/openxr, SIMULATED: no headset stands behind it).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <checkout.hpp>
#include <cstdlib>
#include <filesystem>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "tests/support/openxr/control.hpp"

namespace tractus {
namespace {

namespace fs = std::filesystem;
using core::Json;

/// In one test program run after the other: they share a processor with whatever draws.
class HeadsetTrial : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    fs::create_directories(home());
    run(
        fmt::format("tractus carve --volume {}/tests/data/ct/tptbox_L3/sub-ct_label-22_ct.nii.gz "
                    "--entry 46,200,-61 --target 38.5,158,-61 --breach medial --key key --out case",
                    checkout::kSource));
    run("tractus-station trust --data station --case case");
  }
  static void TearDownTestSuite() {
    if (!std::getenv("TRACTUS_KEEP_PICTURES")) fs::remove_all(home());
  }
  void SetUp() override {
    ::setenv("TRACTUS_OPENXR_TEST", (home() / "control").c_str(), 1);
    ::setenv("XR_RUNTIME_JSON", (std::string(checkout::kStandIn) + "/openxr_runtime.json").c_str(),
             1);
    ::unsetenv("DISPLAY");
    control_ = support::mapped_in<fakexr::Control>(home() / "control");
    ASSERT_NE(control_, nullptr);
    new (control_) fakexr::Control;
    control_->width_px = control_->height_px = 64;  // a slow machine draws some frames too
    home().string().copy(control_->folder, sizeof(control_->folder) - 1);
  }
  void TearDown() override { EXPECT_EQ(control_->violations, 0) << control_->words; }

  static fs::path home() {
    static const fs::path at = fs::temp_directory_path() / ("tractus_headset_" + core::new_id());
    return at;
  }
  static std::string text_of(const char* name) {
    const auto bytes = core::read_file(home() / name);
    return bytes ? std::string(core::text_of(*bytes)) : "";
  }
  /// Exit status; what it said is in `out` and `err`.
  static int run(const std::string& command) {
    const int status = std::system(
        fmt::format("cd {} && {}/{} >out 2>err", home().string(), checkout::kBin, command).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  static int trial(const std::string& more) {
    return run(
        "tractus-station --device sim-lambda6 --data station --case case --duration 3 "
        "--json --view " +
        more);
  }
  /// The one trial of what was said.
  static Json report() {
    const auto said = core::parse_json(text_of("out"), "out");
    EXPECT_TRUE(said) << text_of("err");
    return said ? said->at("trials").at(0) : Json();
  }
  static std::ptrdiff_t trials() {
    return std::ranges::count_if(fs::directory_iterator(home() / "station/trials"),
                                 [](const auto&) { return true; });
  }
  fakexr::Control* control_ = nullptr;
};

TEST_F(HeadsetTrial, IsAlignedSeenByBothEyesAndReported) {
  ASSERT_TRUE(core::write_json(home() / "table.json",
                               {{"format", "tractus-fixture/1"},
                                {"points",
                                 {{{"name", "A"}, {"stage_m", {0.1, 0.9, -0.5}}},
                                  {{"name", "B"}, {"stage_m", {0.22, 0.9, -0.5}}},
                                  {{"name", "C"}, {"stage_m", {0.1, 0.9, -0.7}}}}}}));
  ASSERT_EQ(run("tractus-station align --device sim-lambda6 --data station --fixture table.json"),
            0)
      << text_of("err");
  EXPECT_NE(text_of("out").find("aligned (SIMULATED)"), std::string::npos) << text_of("out");
  // The simulated device stands 0.95 m up, 0.6 m ahead: somebody leans over it.
  control_->head_m[0] = 0.2;
  control_->head_m[1] = 1.15;
  control_->head_m[2] = -0.45;
  control_->head_yaw_rad = 0.5;
  control_->width_px = control_->height_px = 160;
  control_->head_pitch_rad = -0.55;
  control_->outward_rad = 0.35;
  control_->inward_rad = 0.3;
  control_->up_rad = control_->down_rad = 0.3;
  control_->keep_at = 6;
  ASSERT_EQ(trial("headset"), 0) << text_of("err");
  const Json one = report();
  const Json headset = one.at("headset");
  EXPECT_EQ(one.at("complete"), true);
  EXPECT_EQ(headset.at("runtime"), "Tractus test runtime, SIMULATED");
  EXPECT_EQ(headset.at("simulated"), true);
  EXPECT_EQ(headset.at("aligned"), true);
  EXPECT_EQ(headset.at("ended"), "");
  EXPECT_EQ(headset.at("frames"), control_->shown.load());
  EXPECT_GT(headset.at("frames"), 2);
  EXPECT_GT(headset.at("frame_p99_ms"), 0.0);
  for (const char* eye : {"left.png", "right.png"}) EXPECT_TRUE(fs::exists(home() / eye));
  EXPECT_GT(control_->lit_px[0], 500u);
  EXPECT_GT(control_->lit_px[1], 500u);
  // The trial's file says so too.
  ASSERT_EQ(run("tractus trial show " + one.at("file").get<std::string>() + " --json"), 0);
  EXPECT_NE(text_of("out").find("dropped_frames"), std::string::npos) << text_of("out");
}

TEST_F(HeadsetTrial, GoesOnWhenTheSessionIsLost) {
  control_->lose_session_at = 2;  // a busy machine draws few frames
  ASSERT_EQ(trial("headset"), 0) << text_of("err");
  const Json one = report();
  EXPECT_EQ(one.at("complete"), true);
  EXPECT_GT(one.at("ticks").get<int>() + one.at("skipped_ticks").get<int>(), 11'900);  // 3 s
  EXPECT_EQ(one.at("headset").at("ended"), "the runtime lost the session");
  EXPECT_LT(one.at("headset").at("frames"), 3);
  EXPECT_NE(text_of("err").find("its view is over; the trial goes on"), std::string::npos);
}

TEST_F(HeadsetTrial, SaysThatTrackingIsLostAndGoesOn) {
  control_->untracked_from = 2;
  control_->untracked_to = 1'000'000;
  ASSERT_EQ(trial("headset"), 0) << text_of("err");
  EXPECT_GT(report().at("headset").at("untracked_frames"), 0);
  EXPECT_EQ(report().at("complete"), true);
  EXPECT_NE(text_of("err").find("tracking lost; the trial goes on"), std::string::npos);
}

TEST_F(HeadsetTrial, WithoutAHeadsetIsRefusedInOneLineAndLeavesNothing) {
  control_->no_system = 1;
  const auto before = trials();
  EXPECT_EQ(trial("headset"), 2);
  const std::string said = text_of("err");
  EXPECT_NE(said.find("sees no headset"), std::string::npos) << said;
  EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
  EXPECT_EQ(trials(), before);
  // The window only when asked for; here there is no display either.
  EXPECT_EQ(trial("headset-or-window"), 2);
  EXPECT_NE(text_of("err").find("a window instead"), std::string::npos);
  EXPECT_NE(text_of("err").find("no X display answers"), std::string::npos);
  EXPECT_EQ(trials(), before);
}

TEST_F(HeadsetTrial, ABadFixtureIsRefusedInOneLineAndKeepsTheOldAlignment) {
  ASSERT_TRUE(
      core::write_json(home() / "line.json", {{"format", "tractus-fixture/1"},
                                              {"points",
                                               {{{"name", "A"}, {"stage_m", {0.0, 0.9, -0.5}}},
                                                {{"name", "B"}, {"stage_m", {0.1, 0.9, -0.5}}},
                                                {{"name", "C"}, {"stage_m", {0.3, 0.9, -0.5}}}}}}));
  ASSERT_TRUE(core::write_file(home() / "station/alignment.json", core::bytes_of("{\"old\":1}")));
  EXPECT_EQ(run("tractus-station align --device sim-lambda6 --data station --fixture line.json"),
            2);
  EXPECT_NE(text_of("err").find("on a line"), std::string::npos) << text_of("err");
  EXPECT_EQ(text_of("station/alignment.json"), "{\"old\":1}");
  // And such a file stops a trial that would rely on it.
  EXPECT_EQ(trial("headset"), 2);
  EXPECT_NE(text_of("err").find("alignment.json"), std::string::npos) << text_of("err");
  fs::remove(home() / "station/alignment.json");
}

}  // namespace
}  // namespace tractus
