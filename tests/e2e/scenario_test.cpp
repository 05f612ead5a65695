/// `tractus scenario` as an expert uses it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <checkout.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/json.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

class ScenarioCommand : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = "/tmp/tractus-scenario-XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  /// Exit status; both outputs in `said_`.
  int run(const std::string& arguments) {
    const std::string command = std::string(checkout::kBin) + "/tractus scenario " + arguments +
                                " > " + path("said") + " 2>&1";
    const int status = std::system(command.c_str());
    said_ = text_of(path("said"));
    return WEXITSTATUS(status);
  }
  static std::string text_of(const fs::path& file) {
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  std::string folder_, said_;
};

TEST_F(ScenarioCommand, MakesAVersionChecksItAndDrawsIt) {
  ASSERT_EQ(run("new --kind lateral_breach --who 'R. Z.' --out " + path("a.json")), 0) << said_;
  ASSERT_EQ(run("new --from " + path("a.json") +
                " --set breach/breach_damping_Ns_per_m=1500 --who 'R. Z.' --out " + path("b.json")),
            0)
      << said_;
  ASSERT_EQ(run("check --json " + path("b.json")), 0) << said_;
  const auto b = core::parse_json(said_, "check");
  ASSERT_TRUE(b) << said_;
  // (D v + K (L − x0)) (1 + R_f R_i) = (25 + 64) · 1.63 = 145.07 N; / 1500 = 0.0967 m/s
  EXPECT_NEAR((*b)["walls"][0]["threshold_N"].get<double>(), 145.07, 0.01);
  EXPECT_NEAR((*b)["walls"][0]["speed_behind_m_s"].get<double>(), 0.0967, 1e-4);
  ASSERT_EQ(run("check --json " + path("a.json")), 0);
  EXPECT_EQ((*b)["parent"], (*core::parse_json(said_, "check"))["id"]);
  ASSERT_EQ(run("plot " + path("b.json") + " --out " + path("b.svg")), 0) << said_;
  const std::string svg = text_of(path("b.svg"));
  EXPECT_THAT(svg, testing::StartsWith("<svg"));
  EXPECT_THAT(svg, HasSubstr("breach"));
  EXPECT_THAT(svg, HasSubstr("10 mm/s"));
}

TEST_F(ScenarioCommand, SaysNoToWhatASurgeonCannotDo) {
  ASSERT_EQ(run("new --kind hard --set density=3 --who me --out " + path("a.json")), 0) << said_;
  EXPECT_EQ(run("check " + path("a.json")), 1);
  EXPECT_THAT(said_, HasSubstr("too much: the bone takes up to"));
}

TEST_F(ScenarioCommand, RefusesInOneLineAndLeavesNothingBehind) {
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    EXPECT_EQ(run(arguments), 2) << arguments;
    EXPECT_THAT(said_, HasSubstr(why));
    EXPECT_EQ(std::ranges::count(said_, '\n'), 1) << said_;
  };
  const std::string out = " --who me --out " + path("x.json");
  refused("new --set bone/stiffness_N_per_m=-1" + out, "/bone/stiffness_N_per_m: -1 is outside");
  refused("new --set bone/stiffness_N_per_m=1e9" + out, "/bone/stiffness_N_per_m: 1");
  refused("new --kind in_out_in --set 'walls_m=[0.047]'" + out,
          "/walls_m/0: 0.047 plus the breach");
  refused("new --kind medial" + out, "--kind");
  refused("new --from " + path("none.json") + out, "none.json: cannot open");
  EXPECT_FALSE(fs::exists(path("x.json")));
  std::ofstream(path("bad.json")) << "{\"format\":";
  refused("check " + path("bad.json"), "bad.json: not valid JSON");
  refused("plot " + path("bad.json") + " --out " + path("x.svg"), "bad.json");
  EXPECT_FALSE(fs::exists(path("x.svg")));
  ASSERT_EQ(run("new" + out), 0);
  refused("new" + out, "x.json: exists already");
}

}  // namespace
}  // namespace tractus
