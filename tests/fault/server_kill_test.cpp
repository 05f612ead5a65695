/// The server is killed (SIGKILL) at random moments while a station hands trials over, and started
/// again: what was acknowledged is there, a trial is whole or absent, and finishing gives it
/// exactly once. A killed process loses nothing that it gave to the system, so this tests the order
/// of steps; that the disk was asked to keep them (fdatasync before the acknowledgement) is in the
/// code and cannot be seen from here.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <random>
#include <thread>

#include "kills.hpp"
#include "tests/fault/hand_over.hpp"

namespace tractus {
namespace {
using namespace fault;

const int kKills = kills(90);

TEST(KilledAtAnyMoment, TheServerLosesNothingItAcknowledgedAndKeepsNoHalfTrial) {
  KilledServer station;
  Client client;
  {
    ServerProcess first(station.world().data);
    client.speak_to(first.port());
    station.sign_in(client);
  }
  std::mt19937 random(20260301);
  for (int kill = 0; kill < kKills && !::testing::Test::HasFailure(); ++kill) {
    ServerProcess server(station.world().data);
    client.speak_to(server.port());
    station.check(client);
    // Within one of the next requests, wherever the machine is by then.
    const int request = std::uniform_int_distribution<int>(1, 8)(random);
    const std::chrono::microseconds within(std::uniform_int_distribution<int>(0, 3000)(random));
    std::atomic<int> steps = 0;
    std::thread killer([&] {
      while (steps < request) std::this_thread::sleep_for(std::chrono::microseconds(100));
      std::this_thread::sleep_for(within);
      ::kill(server.pid(), SIGKILL);
    });
    station.hand_over(client, steps);
    steps = request;
    killer.join();
  }
  const Ended verified =
      run_program("tractus-server", {"verify", "--data", station.world().data.string()});
  EXPECT_EQ(verified.code, 0) << verified.out;
  ServerProcess last(station.world().data);
  client.speak_to(last.port());
  station.check(client);
  station.finish(client);
  std::printf("%d kills, %d trials handed over\n", kKills, station.trials_done());
  EXPECT_GT(station.trials_done(), 5) << "too few trials were finished to have met the commit";
}

}  // namespace
}  // namespace tractus
