/// A measuring room from end to end: a SIMULATED force/torque sensor (RDT over UDP, its page over
/// HTTP) and a SIMULATED motion capture (libOpenIGTLink's own messages over TCP), whose motion,
/// forces and clocks are made by a generator that shares nothing with ours
/// (tests/support/netft/make_room.py), are recorded by `tractus record`, assembled, compared.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "trial/csv.hpp"
#include "trial/measurement_set.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;
using core::Json;
using math::Vec3;

const std::string kSupport = std::string(checkout::kSource) + "/tests/support/netft/";
const std::string kBin = checkout::kBin;

std::string text_of(const fs::path& path) {
  const auto bytes = core::read_file(path);
  return bytes ? std::string(core::text_of(*bytes)) : "";
}

/// A program that runs beside the test, its standard output in a file; it ends when its standard
/// input does, or with the test.
class Beside {
 public:
  Beside(const std::vector<std::string>& words, const fs::path& out) {
    int input[2];
    EXPECT_EQ(::pipe2(input, O_CLOEXEC), 0);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(input[0], STDIN_FILENO);
      const int file = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
      ::dup2(file, STDOUT_FILENO);
      ::dup2(file, STDERR_FILENO);
      std::vector<char*> argv;
      for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
      argv.push_back(nullptr);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    ::close(input[0]);
    input_ = input[1];
  }
  ~Beside() { end(); }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;
  void signal(int which) const { ::kill(pid_, which); }
  /// Its exit code; −1 when a signal ended it.
  int end() {
    if (pid_ == 0) return code_;
    ::close(input_);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = 0;
    return code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = 0;
  int input_ = -1, code_ = -1;
};

void wait_s(double s) {
  core::MonotonicClock clock;
  clock.sleep_until(clock.now() + core::Instant_ns(1e9 * s));
}

struct Told {
  int code = -1;
  std::string out;
};

class Room : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    const auto made = ran(fmt::format("/usr/bin/python3 {}make_room.py {}", kSupport, at("room")));
    ASSERT_EQ(made.code, 0) << "python3-numpy is needed\n" << made.out;
    const auto truth = core::read_json(folder_ / "room/truth.json");
    ASSERT_TRUE(truth);
    truth_ = *truth;
  }
  void TearDown() override {
    peer_.reset();
    fs::remove_all(folder_);
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  Told ran(const std::string& command) const {
    const auto log = folder_ / "ran.log";
    const int status = std::system(fmt::format("{} > {} 2>&1", command, log.string()).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(log)};
  }
  /// Starts the room's devices and says how to reach them.
  std::string play(const std::string& options) {
    peer_.reset();
    fs::remove(folder_ / "ports");
    std::vector<std::string> words{"/usr/bin/python3", kSupport + "peer.py", at("room"), "--igtl",
                                   kBin + "/../tests/igtl_room"};
    std::istringstream more(options);
    for (std::string word; more >> word;) words.push_back(word);
    peer_ = std::make_unique<Beside>(words, folder_ / "ports");
    for (int tries = 0; tries < 300 && text_of(folder_ / "ports").find('\n') == std::string::npos;
         ++tries)
      wait_s(0.1);
    const auto ports = core::read_json(folder_ / "ports");
    EXPECT_TRUE(ports) << text_of(folder_ / "ports");
    if (!ports) return "";
    return fmt::format(
        "--netft 127.0.0.1 --http-port {} --netft-port {} --igtl 127.0.0.1 "
        "--igtl-port {} --body probe --body vertebra",
        int(ports->at("http")), int(ports->at("rdt")), int(ports->at("igtl")));
  }
  /// A recording of the playing room; what it left is in rec/.
  Told record(const std::string& peers, double for_s, const std::string& more = "") {
    fs::remove_all(folder_ / "rec");
    return ran(fmt::format("{}/tractus record {} --for {} --out {} {}", kBin, peers, for_s,
                           at("rec"), more));
  }
  /// The room's own recipe for rec/, with fields of its one trial.
  void recipe(const Json& trial) {
    auto json = *core::read_json(folder_ / "room/assembly.json");
    json["trials"] = Json::array({trial});
    fs::copy_file(folder_ / "room/bone.nrrd", folder_ / "rec/bone.nrrd");
    ASSERT_TRUE(core::write_json(folder_ / "rec/assembly.json", json));
  }
  Json assembled(const std::string& recipe_file) {
    fs::remove_all(folder_ / "set");
    const auto told =
        ran(fmt::format("{}/tractus assemble --recipe {} --out {} --picture {} --json", kBin,
                        at(recipe_file), at("set"), at("taps.svg")));
    EXPECT_EQ(told.code, 0) << told.out;
    if (told.code != 0) return {};
    return Json::parse(told.out)["trials"][0];
  }
  std::size_t rows_of(const std::string& csv) const {
    const std::vector<std::string_view> t{"t_s"};
    const auto rows = trial::read_csv(folder_ / csv, t, [](auto, auto) { return std::string(); });
    EXPECT_TRUE(rows) << rows.error().what;
    return rows ? *rows : 0;
  }
  /// The set against the truth, which is at 100 Hz of the motion's clock: `offset_s` from a row's
  /// time to the room's.
  void expect_true(double first_s) const;

  fs::path folder_ = fs::temp_directory_path() / ("room-" + core::new_id());
  Json truth_;
  std::unique_ptr<Beside> peer_;
};

void Room::expect_true(double first_s) const {
  const auto set = trial::read_palpation_set(folder_ / "set");
  ASSERT_TRUE(set) << set.error().what;
  const auto& trial = set->trials.at(0);
  std::vector<trial::PalpationMeasurement> truth(1);
  ASSERT_TRUE(trial::read_csv(
      folder_ / "room/truth.csv", trial::kPalpationColumns,
      [&](std::size_t, std::span<const double> v) {
        truth[0].X_VH.push_back({{v[1], v[2], v[3]}, math::Quat(v[4], v[5], v[6], v[7])});
        truth[0].wrench_H.push_back({{v[8], v[9], v[10]}, {v[11], v[12], v[13]}});
        return std::string();
      }));
  double off = 0.0, turned = 0.0, force = 0.0, torque = 0.0, strongest = 0.0;
  const double n = double(trial.t_s.size());
  for (std::size_t k = 0; k < trial.t_s.size(); ++k) {
    const auto of = std::size_t(std::lround(100.0 * (first_s + trial.t_s[k])));
    ASSERT_LT(of, truth[0].X_VH.size());
    off += (trial.X_VH[k].p - truth[0].X_VH[of].p).squaredNorm() / n;
    turned += std::pow(trial.X_VH[k].q.angularDistance(truth[0].X_VH[of].q), 2) / n;
    force += (trial.wrench_H[k].force_N - truth[0].wrench_H[of].force_N).squaredNorm() / n;
    torque += (trial.wrench_H[k].torque_Nm - truth[0].wrench_H[of].torque_Nm).squaredNorm() / n;
    strongest = std::max(strongest, truth[0].wrench_H[of].force_N.norm());
  }
  EXPECT_GT(strongest, 1.5);  // the walls were touched
  // Noise: 0.05 mm and 0.2 mrad for each of two bodies, which lie 0.2 m apart; 0.03 N for each of
  // three axes over ten samples a row, 0.6 mN·m of torque, carried over 30 mm.
  EXPECT_LT(std::sqrt(off), 0.2e-3);
  EXPECT_LT(std::sqrt(turned), 1e-3);
  EXPECT_LT(std::sqrt(force), 0.03);
  EXPECT_LT(std::sqrt(torque), 0.002);
}

TEST_F(Room, IsRecordedAssembledAndComparedAndTheTruthComesBack) {
  const auto peers = play("--type TDATA");
  const auto told = record(peers, 18.5);
  ASSERT_EQ(told.code, 0) << told.out;
  EXPECT_TRUE(fs::exists(folder_ / "rec/force.csv"));
  recipe({{"id", "trial1"}, {"motion", "motion.csv"}, {"force", "force.csv"}});
  const auto trial = assembled("rec/assembly.json");
  ASSERT_FALSE(trial.is_null());
  // Both clocks were measured by this computer's, so what is left of the drift is small; the force
  // began truth.ahead_s before the motion.
  ASSERT_EQ(trial["tap_runs"].size(), 2u);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_NEAR(trial["tap_runs"][r]["offset_s"].get<double>(), truth_["ahead_s"].get<double>(),
                1e-3);
    const auto& tapped = truth_[r == 0 ? "first_taps_s" : "last_taps_s"];
    for (std::size_t k = 0; k < 5; ++k)
      EXPECT_NEAR(trial["tap_runs"][r]["taps_s"][k].get<double>(), tapped[k].get<double>(), 0.02);
  }
  EXPECT_LT(std::abs(trial["clock_drift"].get<double>()), 1e-4);
  expect_true(3.82);  // the first frame half a second after the last of the first taps
  EXPECT_NE(text_of(folder_ / "taps.svg").find("<svg"), std::string::npos);
  const auto compared = ran(fmt::format("{}/tractus compare --model {} --measurements {} --json",
                                        kBin, at("room/model.json"), at("set")));
  ASSERT_EQ(compared.code, 0) << compared.out;
  const auto judged = Json::parse(compared.out);
  EXPECT_EQ(judged["channels"][0]["name"], "force_N");
}

TEST_F(Room, FilesGiveBackTheOffsetAndTheDriftOfTheClocks) {
  const auto trial = assembled("room/assembly.json");
  ASSERT_FALSE(trial.is_null());
  const double ahead_s = truth_["ahead_s"], drift = truth_["drift"];
  ASSERT_EQ(trial["tap_runs"].size(), 2u);
  for (const auto& run : trial["tap_runs"]) {
    const double tap_s = run["taps_s"][2];
    EXPECT_NEAR(run["offset_s"].get<double>(), (tap_s + ahead_s) * (1.0 + drift) - tap_s, 1e-3);
  }
  EXPECT_NEAR(trial["clock_drift"].get<double>(), drift, 5e-5);
  expect_true(3.82);
}

TEST_F(Room, ASensorThatSaysTheOppositeOrLiesOtherwiseIsSeenInTheTaps) {
  auto json = *core::read_json(folder_ / "room/assembly.json");
  const auto told_of = [&](const Json& recipe) {
    EXPECT_TRUE(core::write_json(folder_ / "room/x.json", recipe));
    fs::remove_all(folder_ / "set");
    return ran(fmt::format("{}/tractus assemble --recipe {} --out {}", kBin, at("room/x.json"),
                           at("set")));
  };
  EXPECT_EQ(told_of(json).out.find("warning"), std::string::npos);
  EXPECT_LT(assembled("room/assembly.json")["tap_force_off_way_rad"].get<double>(), 0.2);
  auto opposite = json;
  opposite["sensor"]["says"] =
      json["sensor"].value("says", "on_probe") == "on_probe" ? "by_probe" : "on_probe";
  const auto told = told_of(opposite);
  EXPECT_EQ(told.code, 0) << told.out;
  EXPECT_NE(told.out.find("does the sensor report the opposite force"), std::string::npos)
      << told.out;
  auto turned = json;
  turned["sensor"]["X_HS"]["q"] = {0.5, 0.5, 0.5, 0.5};  // x, y, z for y, z, x
  EXPECT_NE(told_of(turned).out.find("X_HS"), std::string::npos);
}

TEST_F(Room, APictureThatCannotBeDrawnIsRefusedBeforeTheSetIsMade) {
  const auto told = ran(fmt::format("{}/tractus assemble --recipe {} --out {} --picture {}", kBin,
                                    at("room/assembly.json"), at("set"), at("none/taps.svg")));
  EXPECT_EQ(told.code, 2);
  EXPECT_NE(told.out.find("none/taps.svg: cannot create"), std::string::npos) << told.out;
  EXPECT_FALSE(fs::exists(folder_ / "set"));
}

TEST_F(Room, AC3dFileHoldsBothAndNeedsNoTaps) {
  auto json = *core::read_json(folder_ / "room/assembly.json");
  for (const char* body : {"tool", "bone"})
    for (int k = 0; k < 4; ++k) {
      const std::string name = fmt::format("{}{}", json[body]["body"].get<std::string>(), k);
      json[body]["markers_m"][name] = truth_["markers_m"][name];
    }
  json["trials"] = Json::array({{{"id", "c"},
                                 {"motion", "motion.c3d"},
                                 {"force", "motion.c3d"},
                                 {"from_s", 4.0},
                                 {"to_s", 14.0}}});
  ASSERT_TRUE(core::write_json(folder_ / "room/c3d.json", json));
  const auto trial = assembled("room/c3d.json");
  ASSERT_FALSE(trial.is_null());
  EXPECT_EQ(trial["samples"], 1001);
  EXPECT_EQ(trial["clock_offset_s"], 0.0);
  expect_true(4.0);
}

TEST_F(Room, LossesFaultsAndDamageAreCountedAndSaid) {
  const auto peers = play(
      "--type QTDATA --fault lose=50 --fault swap=97 --fault status=0.5:1.0:80020000 --fault "
      "damage=10 --fault busy --fault pictures=25");
  const auto told = record(peers, 3.0, "--json --bias");
  ASSERT_EQ(told.code, 0) << told.out;
  const auto said = Json::parse(told.out);
  peer_.reset();  // writes what it did
  const auto did = core::read_json(folder_ / "room/peer.json");
  ASSERT_TRUE(did);
  EXPECT_EQ(said["force"]["faulty"], said["force"]["saturated"]);
  EXPECT_NEAR(said["force"]["faulty"].get<int>(), 490, 10);  // half a second less every 50th
  EXPECT_NE(said["force"]["status"].get<std::string>().find("the transducer is saturated"),
            std::string::npos);
  // Swapped ones come late and are lost to the table too; a few may be under way at the end.
  const int dropped = did->at("dropped"), swapped = did->at("swapped");
  EXPECT_GT(dropped, 50);
  EXPECT_NEAR(said["force"]["lost"].get<int>(), dropped + swapped, 20);
  EXPECT_NEAR(said["force"]["late"].get<int>(), swapped, 10);
  EXPECT_GT(said["motion"]["damaged_messages"].get<int>(), 15);
  EXPECT_EQ(said["motion"]["complaint"]["name"], "Busy");
  EXPECT_GT(said["motion"]["seen"]["vertebra"].get<int>(), 100);
  EXPECT_EQ(did->at("biases"), 1);
  EXPECT_EQ(did->at("stops"), 1);
  EXPECT_EQ(did->at("bad_requests"), 0);
}

TEST_F(Room, AStreamThatBreaksOffEndsTheRecordingAndWhatCameIsKept) {
  const std::map<std::string, std::string> ends{{"--fault stall=1", "fell silent"},
                                                {"--fault die=1", "fell silent"},
                                                {"--fault close=1", "closed the connection"},
                                                {"--fault hush=1", "capture fell silent"}};
  for (const auto& [fault, words] : ends) {
    const auto told = record(play(fault), 20.0);
    EXPECT_EQ(told.code, 1) << told.out;
    EXPECT_NE(told.out.find(words), std::string::npos) << told.out;
    EXPECT_GT(rows_of("rec/force.csv"), 900u) << fault;
    const auto state = core::read_json(folder_ / "rec/recording.json");
    ASSERT_TRUE(state);
    EXPECT_EQ(state->at("state"), "done");
    EXPECT_NE(state->at("ended_by"), "");
  }
}

TEST_F(Room, WhatWasRecordedBeforeAKillIsKept) {
  const auto peers = play("");
  std::vector<std::string> words{kBin + "/tractus-station", "record"};
  std::istringstream more(peers);
  for (std::string word; more >> word;) words.push_back(word);
  for (const char* word : {"--for", "60", "--out"}) words.emplace_back(word);
  words.push_back(at("rec"));
  Beside recorder(words, folder_ / "recorder.log");
  for (int tries = 0; tries < 200 && !fs::exists(folder_ / "rec"); ++tries) wait_s(0.05);
  wait_s(4.0);
  recorder.signal(SIGKILL);
  EXPECT_EQ(recorder.end(), -1);
  EXPECT_EQ(core::read_json(folder_ / "rec/recording.json")->at("state"), "recording");
  // Four seconds less the half that may wait, and less what a busy computer takes.
  EXPECT_GT(rows_of("rec/force.csv"), 2500u);
  EXPECT_GT(rows_of("rec/motion.csv"), 200u);
  recipe({{"id", "t"}, {"motion", "motion.csv"}, {"force", "force.csv"}, {"offset_s", 0.7321}});
  const auto trial = assembled("rec/assembly.json");
  ASSERT_FALSE(trial.is_null());
  EXPECT_GT(trial["samples"].get<int>(), 200);
}

TEST_F(Room, WhatCannotBeRecordedIsRefusedInOneLineAndNothingIsLeft) {
  const auto refused = [&](const std::string& peers, const std::string& words) {
    const auto told = record(peers, 5.0);
    EXPECT_EQ(told.code, 2) << told.out;
    EXPECT_NE(told.out.find(words), std::string::npos) << told.out;
    EXPECT_EQ(std::ranges::count(told.out, '\n'), 1) << told.out;
    for (const auto& entry : fs::directory_iterator(folder_))
      EXPECT_EQ(entry.path().filename().string().find("rec."), std::string::npos) << entry.path();
    EXPECT_FALSE(fs::exists(folder_ / "rec"));
  };
  refused("--netft 127.0.0.1 --http-port 1", "http://127.0.0.1:1/netftapi2.xml");
  refused(play("--fault rdt=Disabled"), "RDT is switched off");
  refused(play("--fault fu=stone"), "'stone'");
  auto other = play("");
  other.replace(other.find("--body probe --body vertebra"), 28, "--body nobody");
  refused(other, "'probe'");  // those that there are
  auto one = play("");
  one.replace(one.find("--body vertebra"), 15, "--body vertebr");
  refused(one, "sends nothing of 'vertebr'; it sends 'vertebra'");
  refused(play("") + " --body probe", "each body once");
  refused("--netft http://127.0.0.1", "a host's name or address alone");
}

TEST_F(Room, TheToolSaysWhereToRecordWhenTheStationIsNotBesideIt) {
  fs::copy_file(kBin + "/tractus", folder_ / "tractus");
  const auto told = ran(at("tractus") + " record --netft x --out y");
  EXPECT_EQ(told.code, 2);
  EXPECT_NE(told.out.find("tractus-station record"), std::string::npos) << told.out;
  EXPECT_EQ(std::ranges::count(told.out, '\n'), 1) << told.out;
}

}  // namespace
}  // namespace tractus
