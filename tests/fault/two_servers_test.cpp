/// Two servers on one PostgreSQL database and one folder, one of them killed (SIGKILL) at random
/// moments while a station hands trials over: the other goes on with the upload where it was
/// acknowledged, nothing is lost, nothing is there twice. And one killed in the middle of a job:
/// the other does it, once.
#include <gtest/gtest.h>
#include <signal.h>

#include <array>
#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include "kills.hpp"
#include "tests/fault/hand_over.hpp"
#include "tests/support/postgres/postgres_server.hpp"

namespace tractus {
namespace {
using namespace fault;
using test_support::Durable;
using test_support::PostgresServer;

const int kKills = kills(60);

std::unique_ptr<ServerProcess> started(const std::filesystem::path& data) {
  return std::make_unique<ServerProcess>(data,
                                         std::vector<std::string>{"--job-lease-seconds", "1"});
}

/// One number that the database answers with.
std::int64_t number_from(const ServedWorld& world, const std::string& sql) {
  const auto connection = world.connection();
  if (!connection) return -1;
  auto rows = connection->query(sql, {});
  return rows && !rows->empty() ? rows->front().integer(0) : -1;
}

/// Waits, for at most a minute, until the database answers 0.
bool becomes_zero(const ServedWorld& world, const std::string& sql) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < until) {
    if (number_from(world, sql) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

TEST(TwoServers, OneKilledInAnUploadLosesNothingAndTheOtherGoesOn) {
  PostgresServer postgres(Durable::yes);
  KilledServer station(postgres.address(postgres.add_database()));
  const auto& data = station.world().data;
  std::array servers{started(data), started(data)};
  std::array<Client, 2> clients;
  for (int i = 0; i < 2; ++i) clients[i].speak_to(servers[i]->port());
  station.sign_in(clients[0]);  // the other knows the session too
  std::mt19937 random(20260302);
  for (int kill = 0; kill < kKills && !::testing::Test::HasFailure(); ++kill) {
    const int which = std::uniform_int_distribution<int>(0, 1)(random);
    station.check(clients[which]);
    const int request = std::uniform_int_distribution<int>(1, 8)(random);
    const std::chrono::microseconds within(std::uniform_int_distribution<int>(0, 3000)(random));
    std::atomic<int> steps = 0;
    std::thread killer([&] {
      while (steps < request) std::this_thread::sleep_for(std::chrono::microseconds(100));
      std::this_thread::sleep_for(within);
      ::kill(servers[which]->pid(), SIGKILL);
    });
    station.hand_over(clients[which], steps);
    steps = request;
    killer.join();
    station.check(clients[1 - which]);
    station.go_on(clients[1 - which], std::uniform_int_distribution<int>(1, 6)(random));
    servers[which].reset();
    servers[which] = started(data);
    clients[which].speak_to(servers[which]->port());
  }
  station.check(clients[0]);
  station.finish(clients[1]);
  std::printf("%d kills, %d trials handed over\n", kKills, station.trials_done());
  EXPECT_GT(station.trials_done(), 5) << "too few trials were finished to have met the commit";
  EXPECT_TRUE(becomes_zero(station.world(), "select count(*) from jobs where state <> 'done'"));
  EXPECT_EQ(number_from(station.world(), "select count(*) from trials where state <> 'assessed'"),
            0);
  EXPECT_EQ(
      number_from(station.world(),
                  "select count(*) from jobs group by subject order by count(*) desc limit 1"),
      1)
      << "a trial was given to be scored twice";
  const Answer audit = clients[0].ask("GET", "/api/v1/audit/check", station.admin());
  EXPECT_EQ(audit.json()["holds"], true) << audit.body;
}

/// A trial long enough that scoring it takes a while.
std::string hand_over_long_trial(Client& client, const ServedWorld& world) {
  constexpr std::uint32_t kLong = 60'000;
  const std::string id = core::new_id();
  const std::string file = trial_bytes(world.folder, id, world.case_id, kLong);
  EXPECT_EQ(announce(client, world.station_1, id, world.case_id, file).status, 200);
  constexpr std::size_t kMost = 4u << 20;
  for (std::size_t at = 0; at < file.size(); at += kMost)
    EXPECT_EQ(send_piece(client, world.station_1, id, at, file.substr(at, kMost)).status, 200);
  EXPECT_EQ(commit(client, world.station_1, id).status, 200);
  return id;
}

TEST(TwoServers, OneKilledInAJobLeavesItToTheOtherWhichDoesItOnce) {
  PostgresServer postgres(Durable::yes);
  const ServedWorld world(postgres.address(postgres.add_database()));
  int caught = 0;
  for (int tries = 0; tries < 20 && caught < 3 && !::testing::Test::HasFailure(); ++tries) {
    auto first = started(world.data);
    Client client;
    client.speak_to(first->port());
    const auto watching = world.connection();
    ASSERT_TRUE(watching);
    const std::string id = hand_over_long_trial(client, world);
    for (std::string state; state != "claimed" && state != "done";) {
      auto rows = watching->query("select state from jobs where subject = ?",
                                  std::vector<store::Value>{id});
      ASSERT_TRUE(rows && rows->size() == 1);
      state = rows->front().text(0);
    }
    first->kill_now();
    const bool half = number_from(world, "select count(*) from jobs where state = 'claimed'") == 1;
    caught += half ? 1 : 0;
    const auto second = started(world.data);
    EXPECT_TRUE(becomes_zero(world, "select count(*) from jobs where state <> 'done'"));
    EXPECT_EQ(number_from(world, "select attempts from jobs where subject = '" + id + "'"),
              half ? 2 : 1);
    EXPECT_EQ(number_from(world, "select count(*) from trials where state <> 'assessed'"), 0);
    EXPECT_GT(
        number_from(world, "select count(*) from trial_metrics where trial_id = '" + id + "'"), 5);
  }
  std::printf("%d killed in the middle of a job\n", caught);
  EXPECT_GE(caught, 1) << "no kill met a job: the test shows nothing";
}

}  // namespace
}  // namespace tractus
