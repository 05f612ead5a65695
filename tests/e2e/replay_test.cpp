/// `tractus replay` as its users run it, and against the independent oracle of
/// tests/golden/palpation.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <checkout.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/json.hpp"

namespace tractus {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kTractus = std::string(checkout::kBin) + "/tractus";
const std::string kGolden = std::string(checkout::kSource) + "/tests/golden/palpation";

struct Ran {
  int code;
  std::string out;  ///< standard output and standard error
};

Ran ran(const std::string& command) {
  Ran result{-1, ""};
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (!pipe) return result;
  char buffer[4096];
  while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe))
    result.out.append(buffer, n);
  const int status = ::pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

std::string text_of(const fs::path& path) {
  const auto bytes = core::read_file(path);
  return bytes ? std::string(core::text_of(*bytes)) : "cannot read " + path.string();
}

class Replay : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tractus_replay_" + core::new_id());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A set with volume and model in folder_/set, by the golden generator.
  void make_set(const std::string& options) {
    const auto made =
        ran(fmt::format("/usr/bin/python3 {}/make_set.py {} {}", kGolden, set().string(), options));
    ASSERT_EQ(made.code, 0) << "python3-numpy is needed\n" << made.out;
  }
  Ran replay(const std::string& out = "out") {
    return ran(fmt::format("{} replay --model {}/model.json --measurements {} --out {}", kTractus,
                           set().string(), set().string(), (folder_ / out).string()));
  }
  fs::path set() const { return folder_ / "set"; }
  void replace_in(const std::string& file, const std::string& what, const std::string& by) {
    std::string text = text_of(set() / file);
    const auto at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
    ASSERT_TRUE(core::write_file(set() / file, core::bytes_of(text)));
  }
  /// A refused replay: exit 2, one line that holds `why`, nothing left behind.
  void expect_refusal(const std::string& why) {
    const auto answer = replay();
    EXPECT_EQ(answer.code, 2) << answer.out;
    EXPECT_THAT(answer.out, HasSubstr(why));
    EXPECT_EQ(std::ranges::count(answer.out, '\n'), 1) << answer.out;
    for (const auto& entry : fs::directory_iterator(folder_))
      EXPECT_EQ(entry.path().filename(), "set");
  }
  /// Runs replay and oracle on a set, and holds one against the other.
  void expect_agreement(const std::string& options, double least_smooth) {
    make_set(options);
    const auto answer = replay();
    ASSERT_EQ(answer.code, 0) << answer.out;
    const auto checked = ran(fmt::format("/usr/bin/python3 {0}/check.py {1} {1}/model.json {2}",
                                         kGolden, set().string(), (folder_ / "out").string()));
    ASSERT_EQ(checked.code, 0) << checked.out;
    std::printf("%s", checked.out.c_str());
    const auto json = core::parse_json(checked.out, "check.py");
    ASSERT_TRUE(json) << checked.out;
    const auto number = [&](const char* key) { return json->at(key).get<double>(); };
    // Enough was compared, and most of it was fit to be.
    EXPECT_GE(number("in_contact"), 0.3 * number("samples"));
    EXPECT_GE(number("largest_force_N"), 0.5);
    EXPECT_GE(number("smooth"), least_smooth * number("samples"));
    EXPECT_GE(number("smooth_in_contact"), least_smooth * number("in_contact"));
    EXPECT_GE(number("converged"), 0.99 * number("samples"));
    // On smooth samples the answers are the same; everywhere the law is the same and the shank at
    // rest.
    EXPECT_LE(number("worst_smooth_force_N"), 1e-6);
    EXPECT_LE(number("worst_smooth_torque_Nm"), 1e-6);
    EXPECT_LE(number("worst_law_force_N"), 1e-6);
    EXPECT_LE(number("worst_law_torque_Nm"), 1e-6);
    EXPECT_LE(number("worst_rest_N"), 1e-3);
  }
  fs::path folder_;
};

TEST_F(Replay, AgreesWithTheOracleOnThePublishedField) {
  expect_agreement("--trials 4 --seconds 0.25 --field paper", 0.9);
}

// The potential's valleys are finer than the averaged vectors of the published field: more places
// to rest.
TEST_F(Replay, AgreesWithTheOracleOnThePotentialField) {
  expect_agreement("--trials 8 --seconds 0.125 --field potential", 0.25);
}

TEST_F(Replay, WritesAllItPromisesAndTheSameTwice) {
  make_set("--trials 2 --seconds 0.3");
  const auto answer = replay();
  ASSERT_EQ(answer.code, 0) << answer.out;
  EXPECT_THAT(answer.out, HasSubstr("F_xy [N]"));
  EXPECT_THAT(answer.out, HasSubstr("did not reach the equilibrium"));
  EXPECT_THAT(answer.out, HasSubstr("its measurements are simulated"));
  ASSERT_EQ(replay("again").code, 0);
  for (const char* name : {"trials/t00.csv", "trials/t00.svg", "trials/t01.csv", "trials/t01.svg",
                           "distributions.svg", "table.csv", "summary.json"}) {
    ASSERT_TRUE(fs::exists(folder_ / "out" / name)) << name;
    EXPECT_EQ(text_of(folder_ / "out" / name), text_of(folder_ / "again" / name)) << name;
  }
  EXPECT_THAT(text_of(folder_ / "out/trials/t00.csv"),
              testing::StartsWith("t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,"
                                  "deflection_x_m,deflection_y_m,converged\n"));
  const auto summary = core::read_json(folder_ / "out/summary.json");
  ASSERT_TRUE(summary);
  EXPECT_EQ((*summary)["trials"][0]["steps"], 1201);
}

TEST_F(Replay, PrintsTheSummaryAsJson) {
  make_set("--trials 1 --seconds 0.2");
  const auto answer =
      ran(fmt::format("{0} replay --model {1}/model.json --measurements {1} --out {2} --json",
                      kTractus, set().string(), (folder_ / "out").string()));
  ASSERT_EQ(answer.code, 0) << answer.out;
  const auto json = core::parse_json(answer.out, "stdout");
  ASSERT_TRUE(json) << answer.out;
  EXPECT_EQ((*json)["steps"], 801);
  EXPECT_EQ((*json)["table"].size(), 6u);  // all, operator, trial; measured and simulated
}

TEST_F(Replay, RefusesBadInputInOneLineAndLeavesNothing) {
  make_set("--trials 1 --seconds 0.2");
  const auto whole = text_of(set() / "t00.csv");
  replace_in("t00.csv", "\n0.01", "\nsoon");
  expect_refusal("set/t00.csv:3: column t_s: 'soon");
  ASSERT_TRUE(core::write_file(set() / "t00.csv", core::bytes_of(whole)));
  replace_in("t00.csv", "pz_m", "z_m");
  expect_refusal("set/t00.csv:1: column pz_m is missing");
  ASSERT_TRUE(core::write_file(set() / "t00.csv", core::bytes_of(whole)));
  replace_in("set.json", "bone.nrrd", "gone.nrrd");
  expect_refusal("gone.nrrd");
  replace_in("set.json", "gone.nrrd", "../../etc/passwd");
  expect_refusal("/volume: '../../etc/passwd' leaves the set's folder");
  replace_in("set.json", "../../etc/passwd", "bone.nrrd");
  replace_in("model.json", "palpation", "probing");
  expect_refusal("model.json: /base/layers: is missing");
  fs::remove(set() / "model.json");
  expect_refusal("model.json: cannot open: No such file or directory");
}

TEST_F(Replay, LeavesAnExistingFolderAlone) {
  make_set("--trials 1 --seconds 0.2");
  fs::create_directories(folder_ / "out");
  const auto answer = replay();
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.out, HasSubstr("exists already"));
  EXPECT_TRUE(fs::is_empty(folder_ / "out"));
}

}  // namespace
}  // namespace tractus
