/// Whole bone assigned to a trainee: at an enrolled station the real programs let a SIMULATED hand
/// drill it after badge and PIN, then feel that very channel; also when the station was killed.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "core/bytes.hpp"
#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;
using core::Json;

/// A beam of bone along +z from z = 0, 16 mm wide, with 8 mm of marrow inside; whole. Its tract is
/// the middle of the marrow. Returns the case's id.
std::string make_whole_case(const fs::path& folder) {
  volume::Volume bone;
  bone.geometry.dims = {64, 64, 96};
  bone.geometry.spacing_m = volume::Vec3::Constant(5e-4);
  bone.geometry.origin_m = volume::Vec3(-0.01575, -0.01575, -0.008);
  bone.intercept = -1024.0;
  for (int k = 0; k < 96; ++k)
    for (int j = 0; j < 64; ++j)
      for (int i = 0; i < 64; ++i) {
        const volume::Vec3 p = bone.geometry.position_of({double(i), double(j), double(k)});
        const double aside_m = std::max(std::abs(p.x()), std::abs(p.y()));
        const bool marrow = aside_m < 0.004 && p.z() > 0.002;
        const bool solid = aside_m < 0.008 && p.z() >= 0.0 && !marrow;
        bone.counts.push_back(solid ? 2024 : 1054);  // 1000 and 30 HU
      }
  cases::NewCase made{.definition = {}, .truth = {}, .volume = bone, .meta = {}, .draw = {}};
  made.definition.title = "Whole beam";
  made.definition.source = "made by a test, no patient";
  made.definition.made_utc_us = kStarted_utc_us;
  made.definition.tract.length_m = 0.03;
  made.definition.tract.radius_m = 0.0015;
  made.definition.planned = true;
  auto opened = cases::write_case(folder, std::move(made), core::KeyPair::generate());
  EXPECT_TRUE(opened) << (opened ? "" : opened.error().what);
  return opened ? opened->id : std::string();
}

class AssignedDrilling : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string whole = make_whole_case(world_.folder / "whole");
    const Ended published =
        run_program("tractus-server", {"publish", "--data", world_.data, world_.folder / "whole"});
    ASSERT_EQ(published.code, 0) << published.out;
    server_.emplace(world_.data);
    client_.speak_to(server_->port());
    admin_ = world_.admin(client_);
    admin_["Content-Type"] = "application/json";
    const auto tom = post("/accounts", {{"name", "tom"},
                                        {"role", "trainee"},
                                        {"password", "a first password"},
                                        {"badge", "4711"},
                                        {"pin", "2468"}});
    ASSERT_EQ(tom.status, 201) << tom.body;
    const auto task = post("/assignments", {{"title", "Week 2"},
                                            {"people", {"tom"}},
                                            {"cases", {{{"case", whole}, {"name", "Case A"}}}}});
    ASSERT_EQ(task.status, 201) << task.body;
    id_ = task.json()["id"];
    ASSERT_EQ(run_program("tractus-station",
                          {"trust", "--data", station_, "--case", world_.folder / "whole"})
                  .code,
              0);
    std::ofstream(world_.folder / "pin") << "2468\n";
  }
  Answer post(const std::string& path, const Json& body) {
    return client_.ask("POST", "/api/v1" + path, admin_, body.dump());
  }
  Json asked(const std::string& path) {
    return client_.ask("GET", "/api/v1" + path, admin_).json();
  }
  Json assignment() { return asked("/assignments/" + id_); }
  std::vector<std::string> assigned(std::vector<std::string> more) const {
    std::vector<std::string> words{"assigned",
                                   "--badge",
                                   "4711",
                                   "--pin-file",
                                   world_.folder / "pin",
                                   "--data",
                                   station_,
                                   "--server",
                                   "http://127.0.0.1:" + std::to_string(server_->port()),
                                   "--token-file",
                                   world_.folder / "station-1",
                                   "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// Signs in and does so many trials in simulated time; the station's report.
  Json done(int trials) const {
    const Ended ended = run_program(
        "tractus-station",
        assigned({"--speed", "fast", "--duration", "12", "--trials", std::to_string(trials)}));
    EXPECT_EQ(ended.code, 0) << ended.out;
    return Json::parse(ended.out.substr(ended.out.find('{')), nullptr, false);
  }
  trial::Trial trial_on_disk(const std::string& trial_id) const {
    auto read = trial::read_trial(station_ / "trials" / (trial_id + ".ttrial"));
    EXPECT_TRUE(read) << read.error().what;
    return std::move(*read);
  }
  /// A station in real time, killed once samples of its drilling are on the disk.
  void drill_and_kill() const {
    const auto words = assigned({"--duration", "60"});
    const pid_t child = ::fork();
    if (child == 0) {
      ::dup2(::open("/dev/null", O_WRONLY), 1);
      ::dup2(::open("/dev/null", O_WRONLY), 2);
      std::vector<char*> argv{const_cast<char*>("tractus-station")};
      for (const auto& word : words) argv.push_back(const_cast<char*>(word.c_str()));
      argv.push_back(nullptr);
      ::execv((std::string(checkout::kBin) + "/tractus-station").c_str(), argv.data());
      ::_exit(127);
    }
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    const auto recorded_bytes = [&] {
      std::uintmax_t most = 0;
      std::error_code none_yet;
      for (const auto& entry : fs::directory_iterator(station_ / "trials", none_yet))
        most = std::max(most, fs::file_size(entry, none_yet));
      return most;
    };
    while (recorded_bytes() < 100'000 && std::chrono::steady_clock::now() < until)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_GE(recorded_bytes(), 100'000u);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
  }

  const ServedWorld world_;
  const fs::path station_ = world_.folder / "room";
  std::optional<ServerProcess> server_;
  Client client_;
  Headers admin_;
  std::string id_;
};

TEST_F(AssignedDrilling, ATraineeDrillsTheChannelAndThenFeelsIt) {
  const Json said = done(5);
  EXPECT_EQ(said["left"], 0) << said;
  ASSERT_EQ(said["trials"].size(), 2u) << said;
  EXPECT_EQ(said["trials"][0]["tool"], "burr");
  EXPECT_EQ(said["trials"][1]["tool"], "probe");
  const std::string drilling = said["trials"][0]["trial_id"],
                    feeling = said["trials"][1]["trial_id"];
  const trial::Trial drilled = trial_on_disk(drilling), felt = trial_on_disk(feeling);
  EXPECT_FALSE(drilled.answer()) << "who drills is asked for no wall";
  EXPECT_TRUE(felt.answer());
  EXPECT_EQ(felt.header.extra["drilled"], drilling);
  EXPECT_EQ(felt.header.case_id, drilled.header.case_id);

  const Json seen = assignment();
  EXPECT_EQ(seen["done"], 1) << seen;
  EXPECT_EQ(seen["planned"], 1);
  EXPECT_EQ(seen["to_drill"], 1);
  ASSERT_EQ(seen["trials"].size(), 2u);
  for (const Json& trial : seen["trials"]) EXPECT_EQ(trial["state"], "counts") << trial;

  // Judged by what the burr left. The beam's walls are 4 mm to 8 mm from the tract: a hand that
  // keeps to it stays within them.
  Json judged = asked("/trials/" + feeling);
  for (int i = 0; i < 300 && judged["state"] == "assessing"; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    judged = asked("/trials/" + feeling);
  }
  ASSERT_TRUE(judged["truth"].is_object()) << judged["truth"];
  EXPECT_TRUE(judged["truth"]["breached"].is_null()) << judged["truth"];
  ASSERT_TRUE(judged["correct"].is_boolean());
  EXPECT_EQ(judged["correct"], !judged["answer"]["breach"].get<bool>());
}

TEST_F(AssignedDrilling, TheNextSignInGoesOnWithTheChannelThatWasDrilled) {
  const std::string drilling = done(1)["trials"][0]["trial_id"];
  EXPECT_EQ(assignment()["done"], 0);
  // As if killed before the kept state was on the disk: the trial's file is enough.
  ASSERT_TRUE(fs::remove(station_ / "drilled" / (drilling + ".tdrill")));
  const Json then = done(5);
  ASSERT_EQ(then["trials"].size(), 1u) << then;
  const trial::Trial felt = trial_on_disk(then["trials"][0]["trial_id"]);
  EXPECT_EQ(felt.header.extra["drilled"], drilling);
  EXPECT_EQ(assignment()["done"], 1);
}

TEST_F(AssignedDrilling, WhatIsGoneFromTheStationIsDrilledAnewOnceFreed) {
  const std::string drilling = done(1)["trials"][0]["trial_id"];
  fs::remove(station_ / "drilled" / (drilling + ".tdrill"));
  fs::remove(station_ / "trials" / (drilling + ".ttrial"));
  const Ended lost = run_program("tractus-station", assigned({"--speed", "fast"}));
  EXPECT_EQ(lost.code, 2) << lost.out;
  EXPECT_NE(lost.out.find("freed"), std::string::npos) << lost.out;
  const std::string tom = assignment()["trainees"][0]["account_id"];
  ASSERT_EQ(post("/assignments/" + id_ + "/people/" + tom + "/free", Json::object()).status, 200);
  const Json again = done(5);
  EXPECT_EQ(again["trials"].size(), 2u) << again;
  EXPECT_EQ(assignment()["done"], 1);
}

TEST_F(AssignedDrilling, ADrillingThatWasKilledIsDoneAgain) {
  drill_and_kill();
  const Json again = done(5);
  ASSERT_EQ(again["trials"].size(), 2u) << again;
  EXPECT_EQ(again["trials"][0]["tool"], "burr");
  const Json seen = assignment();
  EXPECT_EQ(seen["done"], 1);
  ASSERT_EQ(seen["trials"].size(), 3u);
  EXPECT_EQ(seen["trials"][0]["state"], "invalid");
  EXPECT_EQ(seen["trials"][0]["tool"], "burr");
}

}  // namespace
}  // namespace tractus
