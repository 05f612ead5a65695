/// Self-test and calibration as a technician runs them: the program, the stand-in for the lambda.6
/// behind a USB of umockdev's making, a rig behind Modbus, a real server.
#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <checkout.hpp>
#include <fstream>
#include <future>
#include <set>
#include <thread>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "station/rig/modbus_peer.hpp"
#include "tests/support/dhd/control.hpp"
#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"

extern char** environ;

namespace tractus {
namespace {
namespace fs = std::filesystem;
using world::Headers;
using Names = std::set<std::string>;

/// What depends on how busy this machine is, and on its graphics: reported, never a gate.
const Names kOfThisMachine{"wake-ups of the loop", "device round trip",
                           "disk, to be safe",     "display",
                           "link, answers lost",   "link round trip"};

struct Said {
  int code = -1;
  core::Json json;    ///< standard output
  std::string words;  ///< standard error
};

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The checks of a report that did not pass, but for those of this machine.
Names failed(const core::Json& checks) {
  Names out;
  for (const core::Json& one : checks)
    if (!one["passed"].get<bool>() && !kOfThisMachine.contains(one["name"].get<std::string>()))
      out.insert(one["name"].get<std::string>());
  return out;
}

class Technician : public testing::Test {
 protected:
  Technician() { fs::create_directories(folder_); }
  ~Technician() override { fs::remove_all(folder_); }

  Said run(const std::string& before, const std::string& words) const {
    const fs::path out = folder_ / "out", err = folder_ / "err";
    const std::string command = before + std::string(checkout::kBin) + "/tractus-station " + words +
                                " --data " + (folder_ / "st").string() + " --json </dev/null >" +
                                out.string() + " 2>" + err.string();
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            core::Json::parse(text_of(out), nullptr, false), text_of(err)};
  }
  Said station(const std::string& words) const { return run("", words); }
  std::vector<fs::path> reports() const {
    std::vector<fs::path> out;
    std::error_code none;
    for (const auto& file : fs::directory_iterator(folder_ / "st/reports", none))
      out.push_back(file.path());
    return out;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("technician-" + core::new_id());
};

/// The lambda.6's stand-in, on a USB of its own.
class TechnicianAtTheLambda6 : public Technician {
 protected:
  TechnicianAtTheLambda6() {
    control_ = support::mapped_in<standin::Control>(control_file());
    control_->step_ns = 250'000;  // a read moves its time: a busy machine is no fault of it
    control_->roaming_m = 0.06;
  }
  std::string control_file() const { return (folder_ / "control").string(); }
  std::string on_usb() const {
    return "TRACTUS_DHD_STANDIN=" + control_file() + " umockdev-run --device " +
           std::string(checkout::kSource) + "/tests/support/dhd/lambda6.umockdev -- ";
  }
  Said lambda6(const std::string& words) const {
    return run(on_usb(), words + " --device lambda6 --sdk " + checkout::kStandIn);
  }
  double force_N() const {
    return std::hypot(control_->force_N[0].load(), control_->force_N[1].load(),
                      control_->force_N[2].load());
  }
  /// Waits for the program's doing, at most a minute.
  template <class Holds>
  static bool eventually(const Holds& holds) {
    for (int k = 0; k < 6000 && !holds(); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return holds();
  }
  standin::Control* control_;
};

TEST_F(TechnicianAtTheLambda6, AHealthyOnePassesOnceItIsCalibrated) {
  control_->initialised = 0;  // it was switched off
  const Said lost = lambda6("self-test --for 1 --view none");
  EXPECT_EQ(lost.code, 1);
  EXPECT_TRUE(failed(lost.json["self_test"]["checks"]).contains("device")) << lost.json.dump(2);
  EXPECT_EQ(control_->homings, 0) << "nothing moves by itself unasked";

  const Said alone = lambda6("calibrate --who Ada");
  EXPECT_EQ(alone.code, 2) << "nobody at the terminal, nobody said to stand by";
  EXPECT_NE(alone.words.find("keep hands off"), std::string::npos) << alone.words;
  EXPECT_EQ(control_->homings, 0);

  const Said made = lambda6("calibrate --who Ada --stand-by");
  ASSERT_EQ(made.code, 0) << made.words;
  EXPECT_EQ(control_->homings, 1);
  EXPECT_NE(made.json["calibration"]["words"].get<std::string>().find("by Ada"), std::string::npos);

  const Said whole = lambda6("self-test --for 1 --view none --page " + (folder_ / "p").string());
  EXPECT_EQ(failed(whole.json["self_test"]["checks"]), Names{"time of day"})
      << whole.json.dump(2) << whole.words;
  EXPECT_EQ(force_N(), 0.0);
  EXPECT_EQ(control_->force_on, 0);
  EXPECT_NE(text_of(folder_ / "p").find("SIMULATED lambda.6"), std::string::npos);
  EXPECT_EQ(reports().size(), 3u) << "they wait for a server";
}

TEST_F(TechnicianAtTheLambda6, AReversedMotorAndAJammedJointFailTheirOwnChecks) {
  control_->motor[1] = -1.0;
  control_->jammed = 1u << 3;
  const Said found = lambda6("calibrate --who Ada --stand-by");
  EXPECT_EQ(found.code, 1);
  EXPECT_EQ(failed(found.json["checks"]),
            (Names{"direction along y (to the right)", "direction about x (to the operator)"}))
      << found.json.dump(2);
  EXPECT_NE(found.json.dump().find("WRONG WAY"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "st/calibration/lambda6.json")) << "nothing is noted";
}

TEST_F(TechnicianAtTheLambda6, OneWithoutForceFailsAllThatNeedsForceAndNothingElse) {
  for (auto& motor : control_->motor) motor = 0.0;
  const Said found = lambda6("calibrate --who Ada --stand-by");
  EXPECT_EQ(found.code, 1);
  const Names names = failed(found.json["checks"]);
  EXPECT_EQ(names.size(), 7u) << found.json.dump(2);
  EXPECT_TRUE(names.contains("step response, delay"));
  EXPECT_FALSE(names.contains("rest at zero force"));
}

TEST_F(TechnicianAtTheLambda6, AFaultInTheMiddleEndsAtZeroForceWithItsWord) {
  Said found;
  std::thread program([&] { found = lambda6("calibrate --who Ada --stand-by"); });
  EXPECT_TRUE(eventually([&] { return force_N() > 0.9; }));
  control_->force_off_cause = 2;  // its velocity guard
  program.join();
  EXPECT_EQ(found.code, 1);
  EXPECT_EQ(force_N(), 0.0);
  EXPECT_TRUE(failed(found.json["checks"]).contains("device")) << found.json.dump(2);
}

TEST_F(TechnicianAtTheLambda6, CtrlCEndsAtZeroForceAndLeavesNoReport) {
  const std::string log = (folder_ / "log").string();
  const std::string command = "exec >" + log + " 2>&1; " + on_usb() + std::string(checkout::kBin) +
                              "/tractus-station self-test --for 1 --device lambda6 "
                              "--sdk " +
                              std::string(checkout::kStandIn) + " --data " +
                              (folder_ / "st").string();
  pid_t shell = -1;
  const char* words[] = {"sh", "-c", command.c_str(), nullptr};
  posix_spawnattr_t own_group;
  posix_spawnattr_init(&own_group);
  posix_spawnattr_setflags(&own_group, POSIX_SPAWN_SETPGROUP);
  ASSERT_EQ(::posix_spawnp(&shell, "sh", nullptr, &own_group, const_cast<char**>(words), environ),
            0);
  EXPECT_TRUE(eventually([&] { return force_N() > 0.9; })) << text_of(log);
  ::kill(-shell, SIGINT);  // as a terminal does: the whole group
  int status = 0;
  ::waitpid(shell, &status, 0);
  EXPECT_TRUE(eventually([&] { return control_->opened == 0; })) << text_of(log);
  EXPECT_EQ(force_N(), 0.0);
  EXPECT_EQ(control_->force_on, 0);
  EXPECT_TRUE(reports().empty());
  EXPECT_NE(text_of(log).find("stopped: zero force"), std::string::npos) << text_of(log);
}

/// A rig behind Modbus, in real time.
class TechnicianAtTheRig : public Technician {
 protected:
  void set_up(const rig::World& world) {
    std::promise<int> listening;
    thread_ = std::thread([&, this] {
      const sched_param urgent{.sched_priority = 70};  // as tractus-rig; a refusal is no error
      static_cast<void>(pthread_setschedparam(pthread_self(), SCHED_FIFO, &urgent));
      electronics_.emplace(rig::MachineParameters{}, world, clock_);
      auto made = rig::listen_tcp(*electronics_, traffic_, "127.0.0.1", 0);
      if (made) peer_ = std::move(*made);
      listening.set_value(peer_ ? peer_->port() : 0);
      for (core::Instant_ns next = clock_.now(); !stop_; clock_.sleep_until(next += 1'000'000))
        electronics_->advance();
    });
    port_ = listening.get_future().get();
    ASSERT_NE(port_, 0);
  }
  ~TechnicianAtTheRig() override {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    peer_.reset();
  }
  Said rig(const std::string& words) const {
    return station(words + " --device rig --address 127.0.0.1:" + std::to_string(port_));
  }

 private:
  int port_ = 0;
  core::MonotonicClock clock_;
  std::optional<rig::Electronics> electronics_;
  rig::Traffic traffic_;
  std::unique_ptr<rig::ModbusPeer> peer_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

// In real time: a machine that is held up for over 6 ms trips the rig's watchdog on the way, and
// the travel is short. Five times in a row that is no chance.
TEST_F(TechnicianAtTheRig, AHealthyOneIsCalibratedAndItsZeroNoted) {
  set_up({});
  const auto calibrated = [&](const std::string& who) {
    Said said;
    for (int left = 5; left-- > 0 && said.code != 0;) said = rig("calibrate --who " + who);
    return said;
  };
  const Said first = calibrated("Ada");
  ASSERT_EQ(first.code, 0) << first.json.dump(2) << first.words;
  const auto kept = core::read_json(folder_ / "st/calibration/rig.json");
  ASSERT_TRUE(kept);
  // The sensor's bias of the simulated rig is well below a newton (station/rig/sensor.hpp).
  EXPECT_LT(std::abs((*kept)["zero_N"].get<double>()), 3.0);
  EXPECT_NE(calibrated("Bo").json.dump().find(" N since "), std::string::npos);
}

TEST_F(TechnicianAtTheRig, OneWhoseEmergencyStopIsLatchedIsNotMoved) {
  rig::World world;
  world.panel.stop_pressed = true;
  set_up(world);
  const Said found = rig("self-test --for 1");
  EXPECT_EQ(found.code, 1);
  const core::Json& checks = found.json["self_test"]["checks"];
  EXPECT_TRUE(failed(checks).contains("emergency stop")) << found.json.dump(2);
  EXPECT_EQ(checks.dump().find("small travel"), std::string::npos);
}

TEST_F(TechnicianAtTheRig, OneThatIsNotThereFailsAsSuch) {
  const Said found = station("self-test --for 1 --device rig --address 127.0.0.1:1");
  EXPECT_EQ(found.code, 1);
  EXPECT_TRUE(failed(found.json["self_test"]["checks"]).contains("device"));
}

/// With a real server, and simulated devices: nobody is asked.
class TechnicianWithAServer : public Technician {
 protected:
  TechnicianWithAServer() {
    client_.speak_to(server_.port());
    admin_ = world_.admin(client_);
    std::ofstream(folder_ / "token") << world_.station_1.at("Authorization").substr(7) << "\n";
  }
  Said with_server(const std::string& words) const {
    return station(words + " --server http://127.0.0.1:" + std::to_string(server_.port()) +
                   " --token-file " + (folder_ / "token").string());
  }
  core::Json page() {
    const core::Json fleet = client_.ask("GET", "/api/v1/stations", admin_).json();
    for (const core::Json& one : fleet["stations"])
      if (one["name"] == "station-1")
        return client_.ask("GET", "/api/v1/stations/" + one["id"].get<std::string>(), admin_)
            .json();
    return {};
  }
  world::ServedWorld world_;
  world::ServerProcess server_{world_.data};
  world::Client client_;
  Headers admin_;
};

TEST_F(TechnicianWithAServer, ASelfTestStandsOnTheStationsPage) {
  const Said run = with_server("self-test --for 2 --device sim-lambda6");
  ASSERT_TRUE(run.json.is_object()) << run.words;
  EXPECT_EQ(failed(run.json["self_test"]["checks"]), Names{}) << run.json.dump(2);
  EXPECT_EQ(run.code, run.json["self_test"]["passed"].get<bool>() ? 0 : 1);
  EXPECT_TRUE(reports().empty()) << "handed over";
  const core::Json station = page();
  ASSERT_EQ(station["self_tests"].size(), 1u) << station.dump(2);
  EXPECT_EQ(station["self_tests"][0], run.json["self_test"]) << "as it was printed";
  EXPECT_EQ(station["self_test"]["passed"], run.json["self_test"]["passed"]);
  EXPECT_EQ(station["free_disk_bytes"].is_number(), true);
}

TEST_F(TechnicianWithAServer, ACalibrationHasItsDateThereAndTrialsWarnWhenItIsOver) {
  const Said waits = station("calibrate --device sim-lambda6 --who Ada --due-days 3");
  ASSERT_EQ(waits.code, 0) << waits.words;
  EXPECT_EQ(reports().size(), 1u);
  const Said again = with_server("calibrate --device sim-lambda6 --who Ada --due-days 4");
  ASSERT_EQ(again.code, 0) << again.words;
  EXPECT_TRUE(reports().empty()) << "the one that waited went along";
  const core::Json there = page();
  ASSERT_EQ(there["calibrations"].size(), 2u) << there.dump(2);
  EXPECT_EQ(there["calibration_due_utc_us"], again.json["calibration"]["due_utc_us"]);

  const fs::path case_folder = world_.folder / "case";
  ASSERT_EQ(world::run_program("tractus-station",
                               {"trust", "--data", folder_ / "st", "--case", case_folder})
                .code,
            0);
  const std::string trial = "--speed fast --duration 2 --case " + case_folder.string();
  EXPECT_NE(station(trial).words.find("warning: the calibration of sim-lambda6 is due on "),
            std::string::npos);
  const fs::path file = folder_ / "st/calibration/sim-lambda6.json";
  auto kept = core::read_json(file);
  ASSERT_TRUE(kept);
  (*kept)["due_utc_us"] = 1'000'000;
  ASSERT_TRUE(core::write_json(file, *kept));
  EXPECT_NE(station(trial).words.find("is OVERDUE since 1970-01-01"), std::string::npos);
  (*kept)["due_utc_us"] = "soon";
  ASSERT_TRUE(core::write_json(file, *kept));
  EXPECT_NE(station(trial).words.find("sim-lambda6.json: /due_utc_us"), std::string::npos);
}

TEST_F(Technician, IsToldOfBadUseInOneLine) {
  for (const char* words :
       {"self-test --device lambda7", "self-test --for 0", "calibrate --device sim-lambda6",
        "calibrate --device sim-lambda6 --who A --due-days 0", "self-test --view 3d",
        "self-test --for nan", "self-test --view headset",
        "self-test --page /no/such/folder/page.html", "align --fixture f --limit nan"}) {
    const Said said = station(words);
    EXPECT_EQ(said.code, 2) << words;
    EXPECT_EQ(std::ranges::count(said.words, '\n'), 1) << said.words;
  }
  EXPECT_FALSE(fs::exists(folder_ / "st")) << "nothing is left behind";
}
}  // namespace
}  // namespace tractus
