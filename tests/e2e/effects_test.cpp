/// `tractus effects` as a researcher uses it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

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

class EffectsCommand : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = "/tmp/tractus-effects-XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  /// Exit status; both outputs in `said_`.
  int run(const std::string& arguments) {
    const std::string command = std::string(checkout::kBin) + "/tractus effects " + arguments +
                                " > " + folder_ + "/said 2>&1";
    const int status = std::system(command.c_str());
    std::stringstream text;
    text << std::ifstream(folder_ + "/said").rdbuf();
    said_ = text.str();
    return WEXITSTATUS(status);
  }
  std::string file(const std::string& formula) {
    const core::Json c{{"unit", "N*s^2/m^2"}, {"initial", 1}, {"low", 0}, {"high", 1e4}};
    const core::Json json{{"format", "tractus-effect/1"},
                          {"id", "expression:my_drag"},
                          {"rig", "probing"},
                          {"adds_to", "fz_N"},
                          {"formula", formula},
                          {"parameters", {{"c", c}}}};
    std::ofstream(folder_ + "/own.json") << json;
    return folder_ + "/own.json";
  }
  std::string folder_, said_;
};

TEST_F(EffectsCommand, ListsBothRigsForPeopleAndMachines) {
  ASSERT_EQ(run(""), 0) << said_;
  EXPECT_THAT(said_, HasSubstr("coulomb_friction (probing, force)"));
  EXPECT_THAT(said_, HasSubstr("tip_ball (palpation, structure)"));
  ASSERT_EQ(run("--rig probing --json"), 0) << said_;
  const auto json = core::parse_json(said_, "effects");
  ASSERT_TRUE(json) << said_;
  EXPECT_GE((*json)["effects"].size(), 14u);
  for (const auto& effect : (*json)["effects"]) {
    EXPECT_EQ(effect["rig"], "probing");
    EXPECT_FALSE(effect["equation"].get<std::string>().empty());
    for (const auto& parameter : effect["parameters"])
      EXPECT_LT(parameter["low"].get<double>(), parameter["high"].get<double>());
  }
  ASSERT_EQ(run("rotation_coupling --json"), 0) << said_;
  const auto one = (*core::parse_json(said_, "effects"))["effects"][0];
  EXPECT_EQ(one["kind"], "structure");
  EXPECT_EQ(one["needs"][0], "omega_rad_s");
  EXPECT_EQ(one["parameters"][0]["unit"], "s/rad");
}

TEST_F(EffectsCommand, ChecksAUsersOwnEffect) {
  ASSERT_EQ(run("--check " + file("c * v_m_s * abs(v_m_s)")), 0) << said_;
  EXPECT_THAT(said_, HasSubstr("expression:my_drag (probing, force)"));
  EXPECT_EQ(run("--check " + file("c * v_m_s + x_m")), 2);
  EXPECT_THAT(said_, HasSubstr("own.json: /formula: `c * v_m_s + x_m`: N*s/m and m"));
  EXPECT_EQ(std::ranges::count(said_, '\n'), 1) << said_;
  EXPECT_EQ(run("--check " + folder_ + "/none.json"), 2);
  EXPECT_EQ(run("gravity"), 2);
  EXPECT_THAT(said_, HasSubstr("'gravity' is not an effect"));
}

}  // namespace
}  // namespace tractus
