/// A trial that a station felt and recorded, its motion put through `tractus replay` again: what a
/// replay says of a motion is what a hand would feel of it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <checkout.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "trial/csv.hpp"

namespace tractus {
namespace {

namespace fs = std::filesystem;
using core::Json;

constexpr std::array<std::string_view, 7> kFelt{"t_s",   "fx_N",  "fy_N", "fz_N",
                                                "tx_Nm", "ty_Nm", "tz_Nm"};
using Row = std::array<double, 7>;

std::vector<Row> rows_of(const fs::path& csv) {
  std::vector<Row> rows;
  const auto read = trial::read_csv(csv, kFelt, [&](std::size_t, std::span<const double> values) {
    std::copy(values.begin(), values.end(), rows.emplace_back().begin());
    return std::string();
  });
  EXPECT_TRUE(read) << read.error().what;
  return rows;
}

class RecordedTrial : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "set");
    log_ = (folder_ / "log").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Runs a program of ours; its words go to a log that a failure shows.
  void run(const std::string& command) {
    const int status = std::system(
        fmt::format("cd {} && {}/{} >>{} 2>&1", folder_.string(), checkout::kBin, command, log_)
            .c_str());
    const auto words = core::read_file(log_);
    ASSERT_EQ(status, 0) << command << "\n" << (words ? core::text_of(*words) : "");
  }

  /// The trial's table and the case's own model and volume, as a set of measurements.
  void make_set() {
    const auto manifest = core::read_json(folder_ / "case/case.json");
    ASSERT_TRUE(manifest) << manifest.error().what;
    Json model = manifest->at("model");
    model["volume"] = "volume.tvol";
    ASSERT_TRUE(core::write_json(folder_ / "set/model.json", model));
    fs::create_hard_link(folder_ / "case/volume.tvol", folder_ / "set/volume.tvol");
    const Json trial = {{"id", "felt"}, {"file", "felt.csv"}, {"operator", ""}, {"notes", ""}};
    ASSERT_TRUE(core::write_json(folder_ / "set/set.json", {{"format", "tractus-measurements/1"},
                                                            {"rig", "palpation"},
                                                            {"trials", Json::array({trial})}}));
    for (const auto& entry : fs::directory_iterator(folder_ / "station/trials"))
      run(fmt::format("tractus trial show {} --csv set/felt.csv", entry.path().string()));
  }

  const fs::path folder_ = fs::temp_directory_path() / ("tractus_recorded_" + core::new_id());
  std::string log_;
};

// The same model, the same poses, from the same start, step by step: what differs is the rounding
// of the recorded forces to single precision and, through the walk to the rest, of the poses in
// their splines. That is far below the 0.001 N at which the law calls the shank at rest.
TEST_F(RecordedTrial, IsFeltTheSameByTheStationAndByAReplay) {
  run(
      fmt::format("tractus carve --volume {}/tests/data/ct/tptbox_L3/sub-ct_label-22_ct.nii.gz "
                  "--entry 46,200,-61 --target 38.5,158,-61 --breach medial --key key --out case",
                  checkout::kSource));
  run("tractus-station trust --data station --case case");
  run("tractus-station --data station --case case --speed fast --seed 4 --duration 15");
  ASSERT_NO_FATAL_FAILURE(make_set());
  run("tractus replay --model set/model.json --measurements set --out out");

  const auto felt = rows_of(folder_ / "set/felt.csv");
  const auto replayed = rows_of(folder_ / "out/trials/felt.csv");
  ASSERT_EQ(felt.size(), replayed.size());
  ASSERT_GE(felt.size(), 60000u);  // 15 s at 4 kHz
  double hardest_N = 0.0, worst_N = 0.0, worst_Nm = 0.0;
  for (std::size_t i = 0; i < felt.size(); ++i) {
    ASSERT_EQ(felt[i][0], replayed[i][0]);
    for (std::size_t c = 1; c < 4; ++c) {
      hardest_N = std::max(hardest_N, std::abs(felt[i][c]));
      worst_N = std::max(worst_N, std::abs(felt[i][c] - replayed[i][c]));
      worst_Nm = std::max(worst_Nm, std::abs(felt[i][c + 3] - replayed[i][c + 3]));
    }
  }
  std::printf("%zu samples, up to %.2f N: force within %.1e N, torque within %.1e N m\n",
              felt.size(), hardest_N, worst_N, worst_Nm);
  EXPECT_GT(hardest_N, 0.2);
  EXPECT_LT(worst_N, 1e-5);
  EXPECT_LT(worst_Nm, 1e-6);
}

}  // namespace
}  // namespace tractus
