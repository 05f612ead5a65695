#include "trial/probing_set.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/bytes.hpp"
#include "trial/measurement_set.hpp"

namespace tractus {
namespace trial {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ProbingSetTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tractus_probing_" + core::new_id());
    fs::create_directories(folder_ / "set");
    write("set.json",
          R"({"format":"tractus-measurements/1","rig":"probing","noise":{"fz_N":0.05,"who":"me"},
              "trials":[{"id":"a","file":"a.csv","operator":"S1","notes":""}]})");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / "set" / name) << text;
  }
  /// What reading says about a.csv with this text, after the set's folder.
  std::string said(const std::string& text) {
    write("a.csv", text);
    const auto set = read_probing_set(folder_ / "set");
    return set ? "" : set.error().what.substr((folder_ / "set").string().size());
  }
  fs::path folder_;
};

TEST_F(ProbingSetTest, ReadsColumnsInAnyOrderAndLeavesOthersAlone) {
  write("a.csv",
        "fz_N,note,t_s,x_m,tz_Nm,theta_rad\n1,hello,0,0.001,0.1,3\n2,,0.001,0.002,0.2,4\n");
  const auto set = read_probing_set(folder_ / "set");
  ASSERT_TRUE(set) << set.error().what;
  const auto& trial = set->trials.at(0);
  EXPECT_THAT(trial.t_s, ElementsAre(0, 0.001));
  EXPECT_THAT(trial.x_m, ElementsAre(0.001, 0.002));
  EXPECT_THAT(trial.theta_rad, ElementsAre(3, 4));
  EXPECT_THAT(trial.fz_N, ElementsAre(1, 2));
  EXPECT_THAT(trial.tz_Nm, ElementsAre(0.1, 0.2));
  EXPECT_EQ(trial.operator_name, "S1");
  EXPECT_EQ(set->noise.fz_N, 0.05);
  EXPECT_FALSE(set->noise.x_m);
}

TEST_F(ProbingSetTest, TakesAStageThatOnlySlidesAndOneThatOnlyTurns) {
  write("a.csv", "t_s,x_m,fz_N\n0,0.001,1\n0.001,0.002,2\n");
  const auto slides = read_probing_set(folder_ / "set");
  ASSERT_TRUE(slides) << slides.error().what;
  EXPECT_THAT(slides->trials[0].theta_rad, IsEmpty());
  EXPECT_THAT(slides->trials[0].tz_Nm, IsEmpty());
  write("a.csv", "t_s,theta_rad,tz_Nm\n0,0.001,1\n0.001,0.002,2\n");
  const auto turns = read_probing_set(folder_ / "set");
  ASSERT_TRUE(turns) << turns.error().what;
  EXPECT_THAT(turns->trials[0].x_m, IsEmpty());
}

TEST_F(ProbingSetTest, NamesWhatIsWrongByFileAndLine) {
  EXPECT_THAT(said("t_s,x_m,theta_rad\n0,0,0\n1,0,0\n"),
              HasSubstr("/a.csv:1: column fz_N is missing"));
  EXPECT_THAT(said("x_m,fz_N\n0,0\n"), HasSubstr("/a.csv:1: column t_s is missing"));
  EXPECT_EQ(said("t_s,x_m,fz_N\n0,0,1\n0,0,1\n"), "/a.csv:3: column t_s: 0 is there twice");
  EXPECT_EQ(said("t_s,x_m,fz_N\n0,12,1\n"), "/a.csv:2: column x_m: 12 is over 10 m");
  EXPECT_EQ(said("t_s,x_m,fz_N\n0,0,nan\n"), "/a.csv:2: column fz_N: 'nan' is not a finite number");
  EXPECT_EQ(said("t_s,x_m,fz_N\n0,0,1\n"), "/a.csv: 1 rows, at least 2 are expected");
}

TEST_F(ProbingSetTest, SaysWhichRigASetIsOf) {
  const auto rig = rig_of_set(folder_ / "set");
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_EQ(*rig, "probing");
  const auto palpation = read_palpation_set(folder_ / "set");
  ASSERT_FALSE(palpation);
  EXPECT_THAT(palpation.error().what, HasSubstr("\"palpation\" is expected here"));
  write("set.json", R"({"format":"tractus-measurements/1","rig":"drill","trials":[]})");
  EXPECT_THAT(rig_of_set(folder_ / "set").error().what, HasSubstr("set.json: /rig"));
}

TEST_F(ProbingSetTest, IsReadBackToTheSameBits) {
  ProbingSet set;
  set.trials.push_back(
      {"b", "b.csv", "", "simulated", {0, 1.0 / 3.0}, {0.1, 0.2}, {}, {1e-9, 3.1}, {}});
  ASSERT_TRUE(write_probing_set(folder_ / "out", set));
  const auto back = read_probing_set(folder_ / "out");
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->trials[0].t_s, set.trials[0].t_s);
  EXPECT_EQ(back->trials[0].x_m, set.trials[0].x_m);
  EXPECT_EQ(back->trials[0].fz_N, set.trials[0].fz_N);
  EXPECT_THAT(back->trials[0].theta_rad, IsEmpty());
}

}  // namespace
}  // namespace trial
}  // namespace tractus
