/// `tractus-station align` with the lambda.6's driver: a scripted hand moves the stand-in's handle
/// (tests/support/dhd, SIMULATED) from point to point and presses its button.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <checkout.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "tests/support/dhd/control.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;
using Point = std::array<double, 3>;

class AlignLambda6 : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    ::setenv("TRACTUS_DHD_STANDIN", (folder_ / "control").c_str(), 1);
    control_ = support::mapped_in<standin::Control>(folder_ / "control");
    ASSERT_NE(control_, nullptr);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string text_of(const char* name) const {
    const auto bytes = core::read_file(folder_ / name);
    return bytes ? std::string(core::text_of(*bytes)) : "";
  }
  /// The hand goes there once it is asked for that point, waits until the handle has followed, and
  /// presses.
  void touch(const std::string& name, const Point& at_D_m) {
    using namespace std::chrono_literals;
    for (int i = 0; i < 3000 && text_of("err").find("Touch " + name) == std::string::npos; ++i)
      std::this_thread::sleep_for(10ms);
    for (std::size_t axis = 0; axis < 3; ++axis) control_->hand_m[axis] = at_D_m[axis];
    std::this_thread::sleep_for(1s);
    control_->buttons = 1;
    std::this_thread::sleep_for(500ms);
    control_->buttons = 0;
  }
  int align() {
    const int status = std::system(
        fmt::format("cd {} && umockdev-run --device {}/tests/support/dhd/lambda6.umockdev -- "
                    "{}/tractus-station align --device lambda6 --sdk {}/../standin --data st "
                    "--fixture f.json --json >out 2>err </dev/null",
                    folder_.string(), checkout::kSource, checkout::kBin, checkout::kBin)
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  standin::Control* control_ = nullptr;
  const fs::path folder_ = fs::temp_directory_path() / ("tractus_align_" + core::new_id());
};

// The device's x points along the room's z, its y along x, its z along y (upwards), its middle is
// at (0.1, 0.9, -0.5): D (x, y, z) is S (0.1 + y, 0.9 + z, -0.5 + x). As a quaternion: a third of a
// turn back about (1, 1, 1), w = 1/2, x = y = z = -1/2.
TEST_F(AlignLambda6, FindsWhereTheDeviceStandsFromThreeTouches) {
  const core::Json a = {{"name", "A"}, {"stage_m", {0.07, 0.9, -0.5}}};
  const core::Json b = {{"name", "B"}, {"stage_m", {0.13, 0.9, -0.5}}};
  const core::Json c = {{"name", "C"}, {"stage_m", {0.07, 0.94, -0.5}}};
  ASSERT_TRUE(core::write_json(folder_ / "f.json", {{"format", "tractus-fixture/1"},
                                                    {"points", core::Json::array({a, b, c})}}));
  int code = -1;
  std::thread program([&] { code = align(); });
  touch("A", {0.0, -0.03, 0.0});
  touch("B", {0.0, 0.03, 0.0});
  touch("C", {0.0, -0.03, 0.04});
  program.join();
  ASSERT_EQ(code, 0) << text_of("err");
  const auto kept = core::read_json(folder_ / "st/alignment.json");
  ASSERT_TRUE(kept) << kept.error().what;
  EXPECT_EQ(kept->at("device"), "lambda6");
  EXPECT_EQ(kept->at("simulated"), true);
  EXPECT_LT(kept->at("residual_worst_m"), 5e-4);
  const Point where{0.1, 0.9, -0.5};
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(kept->at("p_SD_m").at(axis).get<double>(), where[axis], 1e-3);
  const double w = kept->at("q_SD").at(0).get<double>();
  EXPECT_NEAR(std::abs(w), 0.5, 0.01);
  for (std::size_t axis = 1; axis < 4; ++axis)
    EXPECT_NEAR(kept->at("q_SD").at(axis).get<double>() / w, -1.0, 0.03);
  EXPECT_EQ(control_->force_on, 0);  // closed
}

}  // namespace
}  // namespace tractus
