/// The station on the probing rig, program against program: the tuned scenarios, a peer that lies,
/// the e-stop, the loss of the bus, a kill in the middle. Real time where the bus is at stake.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <thread>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "tests/e2e/lying_peer.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;
namespace registers = devices::rig;
using lying::Lie;
using testing::HasSubstr;

struct Ended {
  int code = -1;
  std::string said;
};

Ended ended(const std::string& command) {
  Ended out;
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "re");
  std::array<char, 4096> part{};
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe))
    out.said.append(part.data(), n);
  const int status = ::pclose(pipe);
  out.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return out;
}

class ProbingTrial : public testing::Test {
 protected:
  ~ProbingTrial() override { fs::remove_all(data_); }

  std::string station(const std::string& more) const {
    return std::string(checkout::kBin) + "/tractus-station --data " + data_.string() + " " + more;
  }
  Ended on_rig(int port, const std::string& duration_s = "20") const {
    return ended(station("--device rig --scenario soft --address 127.0.0.1:" +
                         std::to_string(port) + " --duration " + duration_s));
  }
  /// Runs the station on a peer until the computer lets an honest bus answer in time, five times at
  /// most: where one of them is held up for longer, the station stops the trial, rightly, and all is
  /// made anew. What the last attempt's runs said.
  std::vector<Ended> undisturbed(
      Lie lie, int honest, const std::function<std::vector<Ended>(lying::Peer&)>& attempt) const {
    std::vector<Ended> runs;
    for (int k = 0; k < 5; ++k) {
      fs::remove_all(data_);
      lying::Peer peer(lie, honest);
      runs = attempt(peer);
      const bool held_up = std::ranges::any_of(runs, [](const Ended& run) {
        return run.said.find("did not answer in time") != std::string::npos ||
               run.said.find("it does not answer") != std::string::npos;
      });
      if (!held_up || !peer.is_honest()) break;
    }
    return runs;
  }
  std::vector<trial::Trial> trials() const {
    std::vector<trial::Trial> out;
    for (const auto& entry : fs::directory_iterator(data_ / "trials")) {
      auto read = trial::read_trial(entry.path());
      EXPECT_TRUE(read) << read.error().what;
      out.push_back(std::move(*read));
    }
    return out;
  }
  const fs::path data_ = fs::temp_directory_path() / ("tractus_rig_" + core::new_id());
};

TEST_F(ProbingTrial, OnTheBusClockIsWholeFastAndTheSameForTheSameSeed) {
  for (const char* seed : {"5", "5", "6"}) {
    const Ended run = ended(station(
        std::string("--device sim-rig --scenario lateral_breach --speed fast --json --seed ") +
        seed));
    ASSERT_EQ(run.code, 0) << run.said;
    const auto json = core::Json::parse(run.said);
    EXPECT_EQ(json["trials"][0]["simulated"], true);
    std::optional<double> breaches;
    for (const auto& metric : json["trials"][0]["metrics"])
      if (metric["id"] == "breaches") breaches = metric["value"].get<double>();
    EXPECT_EQ(breaches, 1.0);
  }
  auto all = trials();
  ASSERT_EQ(all.size(), 3u);
  std::map<std::uint64_t, std::vector<std::vector<trial::ProbingSample>>> by_seed;
  for (auto& trial : all) {
    EXPECT_TRUE(trial.complete && trial.sealed);
    EXPECT_TRUE(trial.header.simulated);
    const auto counts = trial::count_ticks(trial.block());
    EXPECT_EQ(counts.skipped + counts.missed + counts.bus_lost, 0u);
    EXPECT_EQ(counts.samples, trial.events.back().detail["ticks"].get<std::uint64_t>());
    EXPECT_NEAR(trial.probing.back().x_m, trial.header.probe["travel_m"].get<double>(), 5e-5);
    for (auto& sample : trial.probing)
      sample.round_trip_s = 0.0f;  // the computer's, not the trial's
    by_seed[trial.header.extra["simulated_surgeon"]["seed"].get<std::uint64_t>()].push_back(
        trial.probing);
  }
  const auto& twice = by_seed[5];
  ASSERT_EQ(twice.size(), 2u);
  ASSERT_EQ(twice[0].size(), twice[1].size());
  EXPECT_EQ(std::memcmp(twice[0].data(), twice[1].data(), twice[0].size() * sizeof twice[0][0]), 0);
  EXPECT_NE(by_seed[6][0].size(), twice[0].size());
}

/// The samples of a whole trial on the bus' clock and of one in real time are of one kind: the same
/// layout, the same modes in the same order.
TEST_F(ProbingTrial, InRealTimeHasTheSameCourseAsOnTheBusClock) {
  const auto course = [](const trial::Trial& trial) {
    std::vector<trial::ProbingMode> modes;
    for (const auto& sample : trial.probing)
      if (sample.mode != trial::ProbingMode::holding &&
          (modes.empty() || modes.back() != sample.mode))
        modes.push_back(sample.mode);
    return modes;
  };
  for (const char* speed : {"fast", "real"}) {
    const Ended run = ended(station(
        std::string("--device sim-rig --scenario lateral_breach --seed 2 --speed ") + speed));
    ASSERT_EQ(run.code, 0) << run.said;
  }
  const auto both = trials();
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(course(both[0]), course(both[1]));
  for (const auto& trial : both)
    EXPECT_NEAR(trial.probing.back().x_m, trial.header.probe["travel_m"].get<double>(), 5e-5);
}

class ALyingPeer : public ProbingTrial,
                   public testing::WithParamInterface<std::pair<Lie, const char*>> {};

TEST_P(ALyingPeer, StopsTheTrialWithOneLineAndTheTrialIsKeptAndMarked) {
  const Ended run = undisturbed(GetParam().first, 700, [&](lying::Peer& peer) {
    return std::vector{on_rig(peer.port())};
  })[0];
  EXPECT_EQ(run.code, 1) << run.said;
  EXPECT_THAT(run.said, HasSubstr(GetParam().second));
  const auto kept = trials();
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_TRUE(kept[0].sealed);
  EXPECT_FALSE(kept[0].complete);
  EXPECT_EQ(kept[0].events.back().kind, "fault");
  EXPECT_THAT(kept[0].events.back().detail["what"].get<std::string>(),
              HasSubstr(GetParam().second));
  EXPECT_GT(kept[0].probing.size(), 600u);  // what was honest is there
}
INSTANTIATE_TEST_SUITE_P(Peers, ALyingPeer,
                         testing::Values(std::pair{Lie::rubbish, "is no answer"},
                                         std::pair{Lie::exception, "is no answer"},
                                         std::pair{Lie::absurd, "is no answer"},
                                         std::pair{Lie::silence, "did not answer in time"},
                                         std::pair{Lie::late, "did not answer in time"},
                                         std::pair{Lie::hang_up, "was closed"}));

TEST_F(ProbingTrial, APeerThatIsNoRigIsRefusedInOneLineAndNothingIsLeft) {
  const Ended nobody = on_rig(1);
  EXPECT_EQ(nobody.code, 2);
  EXPECT_THAT(nobody.said, HasSubstr("127.0.0.1:1"));
  lying::Peer peer(Lie::rubbish, 0);
  const Ended liar = on_rig(peer.port());
  EXPECT_EQ(liar.code, 2);
  EXPECT_THAT(liar.said, HasSubstr("does not answer as a rig"));
  EXPECT_EQ(std::ranges::count(liar.said, '\n'), 1);
  EXPECT_TRUE(trials().empty());
}

struct Standstill {
  double after_s = 0.0;      ///< the first reading at rest, after the last honest answer
  double between_s = 0.0;    ///< from the reading before it
  double fastest_m_s = 0.0;  ///< while the bus was whole
};

/// The stage's way to a standstill after the peer went silent, read every half millisecond by the
/// machine's own clock.
Standstill standstill(lying::Peer& peer, const std::stop_token& ended) {
  std::array<std::uint16_t, registers::kRegisterCount> image{};
  const auto wide_at = [&](int address) { return registers::wide(image.data() + address); };
  Standstill out;
  for (double last_s = 0.0; out.after_s == 0.0 && !ended.stop_requested();) {
    peer.electronics().read(registers::kUnit, image);
    const double now_s = 1e-4 * double(static_cast<std::uint32_t>(wide_at(registers::kTime_100us)));
    const double v_m_s = 1e-6 * wide_at(registers::kVelocity_um_s);
    if (peer.is_honest())
      out.fastest_m_s = std::max(out.fastest_m_s, v_m_s);
    else if (v_m_s == 0.0)
      out.after_s = now_s - peer.last_honest_s(), out.between_s = now_s - last_s;
    last_s = now_s;
    ::usleep(500);
  }
  return out;
}

TEST_F(ProbingTrial, AfterTheLossOfTheBusTheStageStandsWithinTenMilliseconds) {
  Standstill seen;
  // A reading that came more than 2 ms after the one before it says nothing of 10 ms: once more.
  for (int k = 0; k < 5 && (seen.after_s == 0.0 || seen.between_s > 0.002); ++k) {
    fs::remove_all(data_);
    lying::Peer peer(Lie::silence, 3000);
    std::jthread reader([&](const std::stop_token& ended) { seen = standstill(peer, ended); });
    on_rig(peer.port());
  }
  EXPECT_GT(seen.fastest_m_s, 0.001);
  ASSERT_GT(seen.after_s, 0.0);
  ASSERT_LE(seen.between_s, 0.002);
  RecordProperty("stood_after_ms", std::to_string(1e3 * seen.after_s));
  EXPECT_LE(seen.after_s, 0.010);
}

TEST_F(ProbingTrial, RunsAModelWithAnEffectWhoseBoneGoesDeeperThanTheRig) {
  fs::create_directories(data_);
  const fs::path model = data_ / "rubbing.json";
  std::ofstream(model) << R"json({"format":"tractus-model/1","rig":"probing","name":"rubbing",
"base":{"layers":[{"start_m":0,"thickness_m":0.09,"stiffness_N_per_m":4000,
"damping_Ns_per_m":4000,"equilibrium_m":0}],"rotary":{"viscous_Nms_per_rad":0.02,
"detent_Nm":0.01,"detent_pitch_rad":0.35}},
"effects":[{"id":"coulomb_friction","parameters":{"friction_N":8}}]})json";
  const Ended run = ended(
      station("--device sim-rig --scenario soft --speed fast --seed 4 --model " + model.string()));
  EXPECT_EQ(run.code, 0) << run.said;
  // While it goes in: F = K x + D v + 8 N, as written in the model, of force and speed of the law.
  const auto all = trials();
  ASSERT_EQ(all.size(), 1u);
  int judged = 0;
  for (const auto& sample : all[0].probing) {
    if (sample.mode != trial::ProbingMode::bone || sample.law_m_s < 0.002F) continue;
    EXPECT_NEAR(sample.fz_N, 4000.0 * sample.x_m + 4000.0 * double(sample.law_m_s) + 8.0, 0.1);
    ++judged;
  }
  EXPECT_GT(judged, 1000);
}

TEST_F(ProbingTrial, AnEmergencyStopNeedsAPersonAtTheMachine) {
  const auto runs = undisturbed(Lie::none, 0, [&](lying::Peer& peer) {
    const auto button = [&](int which, std::uint16_t pressed) {
      EXPECT_TRUE(peer.electronics().write(registers::kWorldUnit, which, std::array{pressed}));
    };
    std::jthread hand([&](const std::stop_token& ended) {
      while (peer.answered() < 1500 && !ended.stop_requested()) ::usleep(1000);
      button(registers::kStopButton, 1);
    });
    const Ended stopped = on_rig(peer.port());
    hand = {};
    button(registers::kStopButton, 0);
    const Ended refused = on_rig(peer.port());
    button(registers::kResetButton, 1);
    return std::vector{stopped, refused, on_rig(peer.port(), "1")};
  });
  EXPECT_EQ(runs[0].code, 1);
  EXPECT_THAT(runs[0].said, HasSubstr("emergency stop"));
  EXPECT_EQ(runs[1].code, 2) << runs[1].said;
  EXPECT_THAT(runs[1].said, HasSubstr("emergency stop"));
  EXPECT_EQ(runs[2].code, 0) << runs[2].said;  // the stage was brought back to the entry first
  EXPECT_EQ(trials().size(), 2u);
}

/// A station in the background, its output in a file.
pid_t started(const std::string& command, const fs::path& output) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::execl("/bin/sh", "sh", "-c", ("exec " + command + " >" + output.string() + " 2>&1").c_str(),
          nullptr);
  ::_exit(127);
}

TEST_F(ProbingTrial, SurvivesAKillOfTheStationAndSoDoesNotTheSimulatedRig) {
  const fs::path said = data_.string() + ".said";
  const pid_t child = started(station("--device sim-rig --scenario hard --follow --seed 4"), said);
  std::uint64_t safe = 0;
  for (int k = 0; k < 400 && safe < 1500; ++k) {
    ::usleep(20'000);
    const auto bytes = core::read_file(said);
    const std::string text = bytes ? std::string(core::text_of(*bytes)) : "";
    const auto at = text.rfind("\"samples_safe\":");
    if (at != std::string::npos) safe = std::strtoull(text.c_str() + at + 15, nullptr, 10);
  }
  ASSERT_GE(safe, 1500u);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  fs::remove(said);
  const Ended next = ended(station("--device sim-rig --scenario hard --speed fast --seed 4"));
  EXPECT_EQ(next.code, 0) << next.said;
  EXPECT_THAT(next.said, HasSubstr("an interrupted trial was kept"));
  int interrupted = 0;
  for (const auto& trial : trials()) {
    EXPECT_TRUE(trial.sealed);
    if (trial.complete) continue;
    ++interrupted;
    EXPECT_GE(trial.probing.size(), safe);
    EXPECT_EQ(trial.events.back().kind, "interrupted");
  }
  EXPECT_EQ(interrupted, 1);
}

}  // namespace
}  // namespace tractus
