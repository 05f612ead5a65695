/// A trial in real time on the lambda.6's driver: the program, the stand-in library, a USB of
/// umockdev's.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <checkout.hpp>
#include <cstdlib>
#include <filesystem>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/json.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;

class Lambda6Trial : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    ASSERT_EQ(run(fmt::format("tractus carve --volume {}/tests/data/ct/tptbox_L3/sub-ct_label-22_"
                              "ct.nii.gz --entry 46,200,-61 --target 38.5,158,-61 --key key "
                              "--out case",
                              checkout::kSource)),
              0)
        << words();
    ASSERT_EQ(run("tractus-station trust --data st --case case"), 0) << words();
  }
  void TearDown() override { fs::remove_all(folder_); }

  int run(const std::string& command, const std::string& before = "") {
    const int status = std::system(fmt::format("cd {} && {} {}/{} >out 2>err", folder_.string(),
                                               before, checkout::kBin, command)
                                       .c_str());
    return WEXITSTATUS(status);
  }
  std::string words() const {
    const auto said = core::read_file(folder_ / "err");
    return said ? std::string(core::text_of(*said)) : "";
  }
  const std::string trial_ = fmt::format(
      "tractus-station --device lambda6 --sdk {}/../standin --case case --data st "
      "--duration 1 --answer none --json",
      checkout::kBin);
  const std::string plugged_ = fmt::format(
      "umockdev-run --device {}/tests/support/dhd/lambda6.umockdev --", checkout::kSource);
  const fs::path folder_ = fs::temp_directory_path() / ("tractus_lambda6_" + core::new_id());
};

// In real time: a machine that stands still for over 10 ms trips the watchdog, which ends the trial
// as it should. Five times in a row that is no chance.
TEST_F(Lambda6Trial, RunsToItsEndAndSaysThatNoMachineWasThere) {
  int left = 5, code = 1;
  while (left-- > 0 && code == 1) code = run(trial_, plugged_);
  ASSERT_EQ(code, 0) << words();
  const auto out = core::read_json(folder_ / "out");
  ASSERT_TRUE(out) << out.error().what;
  const core::Json& trial = out->at("trials").at(0);
  EXPECT_EQ(trial.at("fault"), "");
  EXPECT_EQ(trial.at("complete"), true);
  EXPECT_EQ(trial.at("simulated"), true);
  // One second at 4 kHz; a stalled machine skips some.
  EXPECT_EQ(trial.at("ticks").get<int>() + trial.at("skipped_ticks").get<int>(), 4000);
}

TEST_F(Lambda6Trial, WithoutTheDeviceOnTheUsbIsRefusedInOneLine) {
  EXPECT_EQ(run(trial_), 2);
  EXPECT_EQ(words(),
            "lambda6: nothing of vendor 1451 is on the USB: plug it in and switch it on\n");
  EXPECT_TRUE(fs::is_empty(folder_ / "st/trials"));
}

}  // namespace
}  // namespace tractus
