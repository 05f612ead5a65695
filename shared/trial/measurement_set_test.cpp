#include "trial/measurement_set.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/bytes.hpp"

namespace tractus {
namespace trial {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kHeader = "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";
constexpr const char* kSet =
    R"({"format":"tractus-measurements/1","rig":"palpation","volume":"v.nrrd","trials":[{"id":"a","file":"a.csv"}]})";

class PalpationSetTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tractus_set_" + core::new_id());
    fs::create_directories(folder_ / "set");
    write("set.json", kSet);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / "set" / name) << text;
  }
  core::Result<PalpationSet> read() { return read_palpation_set(folder_ / "set"); }
  /// What reading says about a.csv made of these rows, after "…/a.csv:".
  std::string said(const std::string& rows, const std::string& header = kHeader) {
    write("a.csv", header + rows);
    return said();
  }
  std::string said() {
    const auto set = read();
    if (set) return "";
    const std::string& what = set.error().what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    EXPECT_TRUE(what.starts_with((folder_ / "set").string())) << what;
    return what.substr((folder_ / "set").string().size());
  }
  fs::path folder_;
};

const std::string kRow0 = "0,0,0,0,1,0,0,0,1,2,3,4,5,6\n";
const std::string kRow1 = "0.01,0.1,0.2,0.3,0,1,0,0,-1,2e-3,+3,4,5,6\n";

TEST_F(PalpationSetTest, ReadsColumnsInAnyOrderWithMarkAndCarriageReturns) {
  write("a.csv",
        "\xef\xbb\xbfnote,t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tz_Nm,ty_Nm,tx_Nm\r\n"
        "\"a, \"\"b\"\"\",0, 0.1 ,0.2,0.3,0.5,0.5,0.5,0.5,1,2,3,6,5,4\r\n"
        ",0.01,0.1,0.2,0.3,1.005,0,0,0,1,2,+3.5e0,6,5,4\r\n\r\n");
  const auto set = read();
  ASSERT_TRUE(set) << set.error().what;
  const auto& trial = set->trials.at(0);
  ASSERT_EQ(trial.t_s.size(), 2u);
  EXPECT_EQ(trial.X_VH[0].p, math::Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(trial.wrench_H[0].torque_Nm, math::Vec3(4, 5, 6));
  EXPECT_EQ(trial.wrench_H[1].force_N.z(), 3.5);
  EXPECT_DOUBLE_EQ(trial.X_VH[1].q.w(), 1.0);  // 1.005 is within 1 %: normalised
  EXPECT_EQ(set->volume, "v.nrrd");
}

TEST_F(PalpationSetTest, NamesFileLineAndColumnOfABadCell) {
  EXPECT_EQ(said(kRow0 + "0.01,0,0,0,1,0,0,0,abc,2,3,4,5,6\n"),
            "/a.csv:3: column fx_N: 'abc' is not a number");
  EXPECT_EQ(said(kRow0 + "0.01,0,0,0,1,0,0,0,,2,3,4,5,6\n"),
            "/a.csv:3: column fx_N: the cell is empty, a number is expected");
  EXPECT_EQ(said(kRow0 + "0.01,0,0,0,1,0,0,0,1,2,NaN,4,5,6\n"),
            "/a.csv:3: column fz_N: 'NaN' is not a finite number");
  EXPECT_EQ(said(kRow0 + "0.01,0,0,0,1,0,0,0,1,-inf,3,4,5,6\n"),
            "/a.csv:3: column fy_N: '-inf' is not a finite number");
  EXPECT_EQ(said(kRow0 + "0.01,0,0,0,1,0,0,0,1,1e999,3,4,5,6\n"),
            "/a.csv:3: column fy_N: '1e999' is beyond what a number can hold");
  EXPECT_EQ(said(kRow0 + "0.01,0,0,0,1,0,0,0,1,1.5 2,3,4,5,6\n"),
            "/a.csv:3: column fy_N: '1.5 2' is not a number");
  EXPECT_EQ(said(kRow0 + "0.01,0,0,0,1,0,0,0,1,0x1p3,3,4,5,6\n"),
            "/a.csv:3: column fy_N: '0x1p3' is not a number");
  EXPECT_THAT(said(kRow0 + "0.01,0,0,0,1,0,0,0,1," + std::string(5000, 'x') + ",3,4,5,6\n"),
              HasSubstr("'" + std::string(40, 'x') + "…' is not a number"));
}

TEST_F(PalpationSetTest, RefusesTimeThatDoesNotRunForward) {
  EXPECT_EQ(said(kRow0 + kRow1 + kRow1), "/a.csv:4: column t_s: 0.01 is there twice");
  EXPECT_EQ(said(kRow1 + kRow0), "/a.csv:3: column t_s: time runs backwards, 0 after 0.01");
}

TEST_F(PalpationSetTest, RefusesRowsThatAreNotAsTheHeaderSays) {
  EXPECT_EQ(said(kRow0 + "0.01,0,0\n"), "/a.csv:3: 3 cells, the header has 14");
  EXPECT_EQ(said(kRow0 + "0.01,0,0,0,1,0,0,0,1,2,3,4,5,6,7\n"),
            "/a.csv:3: 15 cells, the header has 14");
  EXPECT_EQ(said(kRow0 + "\n" + kRow1), "/a.csv:3: the line is empty, a row is expected");
  EXPECT_EQ(said(kRow0), "/a.csv: 1 rows, at least 2 are expected");
  EXPECT_EQ(said("", ""), "/a.csv:1: the file is empty, a header is expected");
  EXPECT_EQ(said(kRow0, "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,tx_Nm,ty_Nm,tz_Nm\n"),
            "/a.csv:1: column fz_N is missing");
  EXPECT_EQ(said(kRow0, std::string("t_s,") + kHeader), "/a.csv:1: column t_s stands there twice");
  EXPECT_EQ(said("", "t_s;px_m;py_m\n"),
            "/a.csv:1: column t_s is missing; cells must be separated by commas");
  EXPECT_EQ(said("", kRow0),
            "/a.csv:1: column t_s is missing; the first line must name the columns");
}

TEST_F(PalpationSetTest, RefusesWrongUnitsAndQuaternions) {
  EXPECT_EQ(said(kRow0 + "0.01,0,0,0,0.9,0,0,0,1,2,3,4,5,6\n"),
            "/a.csv:3: columns qw to qz: the quaternion's length is 0.9, 1 is expected");
  EXPECT_EQ(said("0,0,0,0,0,0,0,0,1,2,3,4,5,6\n"),
            "/a.csv:2: columns qw to qz: the quaternion's length is 0, 1 is expected");
  EXPECT_EQ(said("0,0,150,0,1,0,0,0,1,2,3,4,5,6\n"),
            "/a.csv:2: column py_m: 150 is over 100 m; metres are expected");
}

TEST_F(PalpationSetTest, RefusesALineWithoutEndInBoundedMemory) {
  EXPECT_THAT(said(std::string(1 << 20, '1')),
              HasSubstr("/a.csv:2: the line is longer than 65536 bytes"));
}

TEST_F(PalpationSetTest, RefusesPathsThatLeaveTheFolder) {
  const auto with_file = [&](const std::string& file) {
    write("set.json",
          R"({"format":"tractus-measurements/1","rig":"palpation","trials":[{"id":"a","file":")" +
              file + "\"}]}");
    return said();
  };
  std::ofstream(folder_ / "secret.csv") << kHeader << kRow0 << kRow1;
  fs::create_symlink(folder_ / "secret.csv", folder_ / "set" / "link.csv");
  EXPECT_EQ(with_file("../secret.csv"),
            "/set.json: /trials/0/file: '../secret.csv' leaves the set's folder");
  EXPECT_EQ(with_file("link.csv"), "/set.json: /trials/0/file: 'link.csv' leaves the set's folder");
  EXPECT_THAT(with_file("/etc/passwd"), HasSubstr("is an absolute path"));
  EXPECT_EQ(with_file("gone.csv"), "/gone.csv: cannot open: No such file or directory");
  EXPECT_EQ(with_file("."), "/set.json: /trials/0/file: '.' is not a file");
}

TEST_F(PalpationSetTest, NamesTheFieldOfSetJsonThatIsWrong) {
  const auto with = [&](const std::string& text) {
    write("set.json", text);
    return said();
  };
  EXPECT_THAT(with("{"), HasSubstr("/set.json: not valid JSON"));
  EXPECT_THAT(with("[]"), HasSubstr("/set.json: : a JSON object is expected"));
  EXPECT_THAT(with(R"({"format":"x","rig":"palpation","trials":[]})"),
              HasSubstr("/set.json: /format: 'x'"));
  EXPECT_THAT(with(R"({"format":"tractus-measurements/1","rig":"probing","trials":[]})"),
              HasSubstr("/set.json: /rig: 'probing', \"palpation\" is expected here"));
  EXPECT_THAT(with(R"({"format":"tractus-measurements/1","rig":"palpation","trials":[]})"),
              HasSubstr("/set.json: /trials: an array of 1 to 10000 trials is expected"));
  EXPECT_THAT(with(R"({"format":"tractus-measurements/1","rig":"palpation","trails":[]})"),
              HasSubstr("/set.json: /trials: is missing"));
  EXPECT_THAT(
      with(
          R"({"format":"tractus-measurements/1","rig":"palpation","colour":1,"trials":[{"id":"a","file":"a"}]})"),
      HasSubstr("/set.json: /colour: this field is not known"));
  EXPECT_THAT(
      with(
          R"({"format":"tractus-measurements/1","rig":"palpation","trials":[{"id":"../x","file":"a.csv"}]})"),
      HasSubstr("/set.json: /trials/0/id: letters, digits"));
  EXPECT_THAT(
      with(
          R"({"format":"tractus-measurements/1","rig":"palpation","tract":{"entry_m":[0,0,0],"axis":[0,0,2],)"
          R"("length_m":0.03},"trials":[{"id":"a","file":"a.csv"}]})"),
      HasSubstr("/set.json: /tract/axis: has length 2, a unit vector is expected"));
}

TEST_F(PalpationSetTest, ReadsBackWhatItWroteToTheSameBits) {
  PalpationSet set;
  set.volume = "v.nrrd";
  set.tract = StatedTract{{0.1, 0.2, 0.3}, math::Vec3(0.6, 0, 0.8), 0.03};
  set.stated["simulated"] = true;
  PalpationMeasurement trial;
  trial.id = "t1";
  trial.file = "t1.csv";
  trial.operator_name = "S1";
  for (int k = 0; k < 50; ++k) {
    trial.t_s.push_back(k / 3.0);
    trial.X_VH.push_back({{k / 7.0, -k / 9.0, 1e-17 * k}, math::Quat::Identity()});
    trial.wrench_H.push_back({{k / 11.0, 0, -1e-9}, {k / 13.0, 5e-324, 0}});
  }
  set.trials.push_back(trial);
  ASSERT_TRUE(write_palpation_set(folder_ / "out", set));
  const auto back = read_palpation_set(folder_ / "out");
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->trials[0].t_s, trial.t_s);
  EXPECT_EQ(back->trials[0].operator_name, "S1");
  EXPECT_EQ(back->stated["simulated"], true);
  EXPECT_EQ(back->tract->axis, set.tract->axis);
  for (std::size_t k = 0; k < 50; ++k) {
    EXPECT_EQ(back->trials[0].X_VH[k].p, trial.X_VH[k].p);
    EXPECT_EQ(back->trials[0].wrench_H[k].force_N, trial.wrench_H[k].force_N);
    EXPECT_EQ(back->trials[0].wrench_H[k].torque_Nm, trial.wrench_H[k].torque_Nm);
  }
  const auto again = write_palpation_set(folder_ / "out", set);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, core::Errc::conflict);
}

}  // namespace
}  // namespace trial
}  // namespace tractus
