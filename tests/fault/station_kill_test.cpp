/// The real station is killed (SIGKILL) at random moments of trials and uploads, with the real
/// server up, and started again: what it said was on the disk is there, no half trial is left, and
/// every trial arrives once. A killed process loses nothing that it gave to the system, so this
/// tests the order of steps; what a loss of power would cost is bounded by the flushes, not seen
/// from here.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <chrono>
#include <limits>
#include <random>
#include <sstream>
#include <thread>

#include "core/file.hpp"
#include "kills.hpp"
#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;
using namespace world;
using Clock = std::chrono::steady_clock;
const int kKills = kills(60);

/// A station on the served case, and what it promised so far.
class KilledStation {
 public:
  KilledStation() {
    const std::string bearer = world_.station_1.begin()->second;
    const auto token = bearer.substr(bearer.find(' ') + 1);
    EXPECT_TRUE(core::write_file(world_.folder / "st.token", core::bytes_of(token)));
  }
  fs::path data() const { return world_.folder / "station"; }
  const ServedWorld& world() const { return world_; }

  std::vector<std::string> arguments(int port, int seed) const {
    return {"--data",       data(),
            "--case",       world_.case_id,
            "--speed",      "fast",
            "--duration",   "4",
            "--trials",     "2",
            "--follow",     "--json",
            "--seed",       std::to_string(seed),
            "--server",     "http://127.0.0.1:" + std::to_string(port),
            "--token-file", world_.folder / "st.token"};
  }
  Ended ask(const std::string& stamp, int port) const {
    return run_program("tractus-station", {stamp, "--data", data(), "--server",
                                           "http://127.0.0.1:" + std::to_string(port),
                                           "--token-file", world_.folder / "st.token"});
  }

  /// Runs until killed; notes what it said had reached the disk. False: it ended before.
  bool run_and_kill(int port, int seed, std::chrono::microseconds after) {
    int pipe_ends[2];
    EXPECT_EQ(::pipe(pipe_ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      ::dup2(pipe_ends[1], STDERR_FILENO);
      ::dup2(pipe_ends[1], STDOUT_FILENO);
      ::close(pipe_ends[0]);
      ::close(pipe_ends[1]);
      auto words = arguments(port, seed);
      words.insert(words.begin(), std::string(checkout::kBin) + "/tractus-station");
      std::vector<char*> argv;
      for (auto& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    ::close(pipe_ends[1]);
    std::string said;
    std::thread reader([&] {
      std::array<char, 4096> part;
      for (ssize_t n; (n = ::read(pipe_ends[0], part.data(), part.size())) > 0;)
        said.append(part.data(), static_cast<std::size_t>(n));
    });
    std::this_thread::sleep_for(after);
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    reader.join();
    ::close(pipe_ends[0]);
    note(said);
    killed_ += WIFSIGNALED(status);
    return WIFSIGNALED(status);
  }

  void note(const std::string& said) {
    std::istringstream lines(said);
    for (std::string line; std::getline(lines, line);) {
      const auto json = core::Json::parse(line, nullptr, false);
      if (!json.is_object() || !json.contains("samples_safe")) continue;
      auto& safe = safe_[json["trial_id"].get<std::string>()];
      safe = std::max(safe, json["samples_safe"].get<std::uint64_t>());
    }
  }

  /// Every sample that was promised is in a whole file; every whole file is on the server, once.
  void check(Client& client) {
    std::map<std::string, std::uint64_t> here;
    interrupted_ = 0;
    for (const auto& entry : fs::directory_iterator(data() / "trials")) {
      EXPECT_NE(entry.path().extension(), ".part");
      if (entry.path().extension() != ".ttrial") continue;
      const auto trial = trial::scan_trial(entry.path(), [&](const trial::Block& part) {
        here[entry.path().stem()] += part.size();
      });
      ASSERT_TRUE(trial) << trial.error().what;
      EXPECT_TRUE(trial->sealed) << entry.path();
      interrupted_ += !trial->complete;
    }
    for (const auto& [id, safe] : safe_) EXPECT_GE(here[id], safe) << id;

    std::map<std::string, std::uint64_t> there;
    const auto admin = world_.admin(client);
    bool more = true;
    for (std::string cursor; more;) {
      const Answer list = client.ask("GET", "/api/v1/trials?limit=200" + cursor, admin);
      ASSERT_EQ(list.status, 200) << list.body;
      const auto trials = list.json()["trials"];
      for (const auto& trial : trials) {
        const auto id = trial["id"].get<std::string>();
        EXPECT_FALSE(there.contains(id)) << id << " arrived twice";
        there[id] = trial["samples"].get<std::uint64_t>();
      }
      more = list.json()["more"].get<bool>();
      if (more) cursor = "&cursor=" + list.json()["next"].get<std::string>();
    }
    EXPECT_EQ(there, here);
  }
  int killed() const { return killed_; }
  int interrupted() const { return interrupted_; }
  std::size_t promised() const { return safe_.size(); }

 private:
  ServedWorld world_;
  std::map<std::string, std::uint64_t> safe_;
  int killed_ = 0, interrupted_ = 0;
};

constexpr int kFewestInterrupted = 10;

TEST(KilledAtAnyMoment, TheStationLosesNothingItPromisedAndEveryTrialArrivesOnce) {
  KilledStation station;
  ServerProcess server(station.world().data);
  const auto trusted = run_program("tractus-station", {"trust", "--data", station.data(), "--case",
                                                       station.world().folder / "case"});
  ASSERT_EQ(trusted.code, 0) << trusted.out;
  ASSERT_EQ(station.ask("sync", server.port()).code, 0);

  long length = std::numeric_limits<long>::max();  // of the shortest whole run
  for (int run = 0; run < 3; ++run) {
    const auto began = Clock::now();
    const auto whole = run_program("tractus-station", station.arguments(server.port(), 1));
    ASSERT_EQ(whole.code, 0) << whole.out;
    length = std::min<long>(
        length,
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - began).count());
  }

  // A run that ends before its kill shows that runs have become shorter: the next ones are killed
  // sooner. On a busy machine most of a run is starting and handing over: more are killed then, for
  // enough to meet a running trial.
  std::mt19937 random(20260302);
  Client client;
  client.speak_to(server.port());
  int runs = 0;
  for (int round = 1; round <= 3 && station.interrupted() <= kFewestInterrupted; ++round) {
    for (; station.killed() < round * kKills && runs < 3 * round * kKills && !HasFailure();
         ++runs) {
      const std::chrono::microseconds after(std::uniform_int_distribution<long>(0, length)(random));
      if (!station.run_and_kill(server.port(), 2 + runs, after)) length = after.count();
    }
    const auto last = station.ask("upload", server.port());
    EXPECT_EQ(last.code, 0) << last.out;
    EXPECT_EQ(station.ask("upload", server.port()).code, 0);  // again changes nothing
    station.check(client);
  }
  std::printf("%d runs, %d killed, %d trials interrupted, %zu with promised samples\n", runs,
              station.killed(), station.interrupted(), station.promised());
  EXPECT_GE(station.killed(), kKills);
  EXPECT_GT(station.interrupted(), kFewestInterrupted) << "too few kills met a running trial";
}

}  // namespace
}  // namespace tractus
