/// The rig plays a program through a SIMULATED specimen, the set is diagnosed, the next recording is chosen and played, and the
/// set grows by it: as a person would do it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/file.hpp"
#include "core/json.hpp"

namespace tractus {
namespace {

namespace fs = std::filesystem;
using core::Json;
using testing::HasSubstr;

const std::string kTractus = std::string(checkout::kBin) + "/tractus",
                  kStation = std::string(checkout::kBin) + "/tractus-station";

struct Ran {
  int code;
  std::string out;  ///< standard output, then standard error
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

constexpr double kStiffness_N_per_m = 3000.0, kDamping_Ns_per_m = 900.0, kFriction_N = 1.5,
                 kSurface_m = 0.002;

class ProgramPlayed : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("specimen.json", {{"format", "tractus-specimen/1"},
                            {"layers", Json::array({{{"from_m", kSurface_m},
                                                     {"to_m", 0.06},
                                                     {"stiffness_N_per_m", kStiffness_N_per_m},
                                                     {"damping_Ns_per_m", kDamping_Ns_per_m},
                                                     {"equilibrium_m", kSurface_m}}})},
                            {"friction_N", kFriction_N}});
    Json moves = Json::array();
    for (const double speed : {0.01, 0.03})
      for (const double to_m : {0.018, 0.006})
        moves.push_back({{"to_m", to_m},
                         {"speed_m_s", speed},
                         {"to_rad", 0.0},
                         {"speed_rad_s", 1.0},
                         {"hold_s", 0.2}});
    write("strokes.json", {{"format", "tractus-program/1"},
                           {"rig", "probing"},
                           {"name", "strokes"},
                           {"words", "strokes"},
                           {"start_m", 0.006},
                           {"start_rad", 0.0},
                           {"acceleration_m_s2", 0.4},
                           {"acceleration_rad_s2", 20.0},
                           {"moves", moves}});
    // A guess of the bone, without friction.
    write("model.json",
          {{"format", "tractus-model/1"},
           {"rig", "probing"},
           {"name", "guess"},
           {"base",
            {{"layers", Json::array({{{"start_m", kSurface_m},
                                      {"thickness_m", 0.05},
                                      {"stiffness_N_per_m", 2500.0},
                                      {"damping_Ns_per_m", 1000.0},
                                      {"equilibrium_m", kSurface_m}}})},
             {"rotary",
              {{"viscous_Nms_per_rad", 0.02}, {"detent_Nm", 0.01}, {"detent_pitch_rad", 0.35}}}}},
           {"effects", Json::array()}});
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const Json& json) const {
    ASSERT_TRUE(core::write_json(folder_ / name, json));
  }
  std::string playing(const std::string& program, const std::string& out) const {
    return kStation + " record --device sim-rig --program " + at(program) + " --specimen " +
           at("specimen.json") + " --out " + at(out);
  }

  fs::path folder_ = fs::temp_directory_path() / ("tractus_program_" + std::to_string(::getpid()));
};

TEST_F(ProgramPlayed, TellsWhatTheSpecimenIsMadeOf) {
  const Ran played = ran(playing("strokes.json", "set") + " --repetitions 5");
  ASSERT_EQ(played.code, 0) << played.out;
  EXPECT_THAT(played.out, HasSubstr("5 trials of \"strokes\", SIMULATED"));
  const Ran found = ran(kTractus + " diagnose --json --model " + at("model.json") +
                        " --measurements " + at("set") + " --out-model " + at("better.json"));
  ASSERT_EQ(found.code, 0) << found.out;
  const auto json = core::parse_json(found.out, "diagnosis");
  ASSERT_TRUE(json) << found.out;
  ASSERT_EQ((*json)["effects"].size(), 1u) << found.out;
  EXPECT_EQ((*json)["effects"][0]["id"], "coulomb_friction");
  EXPECT_NEAR((*json)["effects"][0]["parameters"]["friction_N"]["value"].get<double>(), kFriction_N,
              0.03 * kFriction_N);
  const auto better = core::read_json(at("better.json"));
  ASSERT_TRUE(better);
  const Json& layer = (*better)["base"]["layers"][0];
  EXPECT_NEAR(layer["stiffness_N_per_m"].get<double>(), kStiffness_N_per_m,
              0.02 * kStiffness_N_per_m);
  EXPECT_NEAR(layer["damping_Ns_per_m"].get<double>(), kDamping_Ns_per_m, 0.05 * kDamping_Ns_per_m);
}

TEST_F(ProgramPlayed, NewTrialsJoinTheSetBefore) {
  ASSERT_EQ(ran(playing("strokes.json", "first") + " --repetitions 1").code, 0);
  const Ran more =
      ran(playing("strokes.json", "both") + " --json --repetitions 2 --with " + at("first"));
  ASSERT_EQ(more.code, 0) << more.out;
  const auto said = core::parse_json(more.out, "record");
  ASSERT_TRUE(said) << more.out;
  EXPECT_EQ((*said)["all_trials"], 3);
  EXPECT_EQ((*said)["simulated"], true);
  const auto set = core::read_json(fs::path(at("both")) / "set.json");
  ASSERT_TRUE(set);
  EXPECT_EQ((*set)["trials"].size(), 3u);
  EXPECT_EQ((*set)["simulated"], true);
}

TEST_F(ProgramPlayed, ANameThatLooksLikeAPathStaysInItsFolder) {
  auto named = *core::read_json(at("strokes.json"));
  named["name"] = "../../escaped";
  write("named.json", named);
  const Ran played = ran(playing("named.json", "set") + " --repetitions 1");
  ASSERT_EQ(played.code, 0) << played.out;
  const auto set = core::read_json(fs::path(at("set")) / "set.json");
  ASSERT_TRUE(set);
  EXPECT_EQ((*set)["trials"][0]["file"], "------escaped-1.csv");
  EXPECT_TRUE(fs::exists(fs::path(at("set")) / "------escaped-1.csv"));
}

TEST_F(ProgramPlayed, RefusesWhatCannotBePlayed) {
  const auto refused = [&](const std::string& command) {
    const Ran result = ran(command);
    EXPECT_EQ(result.code, 2) << result.out;
    EXPECT_FALSE(fs::exists(at("set")));
    return result.out;
  };
  auto far = *core::read_json(at("strokes.json"));
  far["moves"][0]["to_m"] = 0.15;
  write("far.json", far);
  EXPECT_THAT(refused(playing("far.json", "set")), HasSubstr("this program asks for 0.15 m"));
  write("other.json", {{"format", "tractus-effect/1"}});
  EXPECT_THAT(refused(playing("other.json", "set")),
              HasSubstr("\"tractus-program/1\" is expected"));
  EXPECT_THAT(refused(playing("strokes.json", "set") + " --netft 127.0.0.1"),
              HasSubstr("without --netft"));
}

}  // namespace
}  // namespace tractus
