/// Two servers on one PostgreSQL database and one folder, one of them killed (SIGKILL) at random
/// moments while a station hands trials over: the other goes on with the upload where it was
/// acknowledged, nothing is lost, nothing is there twice. And one killed in the middle of a job:
/// the other does it, once. The same with objects in an S3 bucket, whose server is killed too.
#include <gtest/gtest.h>
#include <signal.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

#include "kills.hpp"
#include "tests/fault/hand_over.hpp"
#include "tests/support/postgres/postgres_server.hpp"
#include "tests/support/s3/s3_server.hpp"

namespace tractus {
namespace {
using namespace fault;
using test_support::Durable;
using test_support::PostgresServer;
using test_support::s3_server;

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

/// A station hands trials over to two servers, of which one is killed again and again.
void hand_over_to_killed_servers(KilledServer& station, int most_kills) {
  const auto& data = station.world().data;
  std::array servers{started(data), started(data)};
  std::array<Client, 2> clients;
  for (int i = 0; i < 2; ++i) clients[i].speak_to(servers[i]->port());
  station.sign_in(clients[0]);  // the other knows the session too
  std::mt19937 random(20260302);
  for (int kill = 0; kill < most_kills && !::testing::Test::HasFailure(); ++kill) {
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
  std::printf("%d kills, %d trials handed over\n", most_kills, station.trials_done());
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

TEST(TwoServers, OneKilledInAnUploadLosesNothingAndTheOtherGoesOn) {
  PostgresServer postgres(Durable::yes);
  KilledServer station(postgres.address(postgres.add_database()));
  hand_over_to_killed_servers(station, kKills);
}

/// Data folders that are made meanwhile have their objects in a bucket.
class ObjectsInS3 {
 public:
  explicit ObjectsInS3(const std::string& prefix) {
    ::setenv("TRACTUS_OBJECTS", s3_server().address(prefix).c_str(), 1);
  }
  ~ObjectsInS3() { ::unsetenv("TRACTUS_OBJECTS"); }
  ObjectsInS3(const ObjectsInS3&) = delete;
  ObjectsInS3& operator=(const ObjectsInS3&) = delete;
};

/// Leaves the objects of a data folder to the bucket alone.
void empty_cache(const std::filesystem::path& data) {
  for (const auto& entry : std::filesystem::directory_iterator(data / "objects"))
    std::filesystem::remove_all(entry);
}

/// Every object that the records name is in the bucket, its bytes those of its SHA-256.
void expect_verified(const std::filesystem::path& data) {
  const Ended verified = run_program("tractus-server", {"verify", "--data", data});
  EXPECT_EQ(verified.code, 0) << verified.out;
}

TEST(TwoServersOnAnObjectStore, OneKilledInAnUploadLosesNothingAndTheOtherGoesOn) {
  const ObjectsInS3 there("killed-servers");
  PostgresServer postgres(Durable::no);  // it is not killed
  KilledServer station(postgres.address(postgres.add_database()));
  hand_over_to_killed_servers(station, kKills / 2);
  empty_cache(station.world().data);
  expect_verified(station.world().data);
  EXPECT_TRUE(std::filesystem::is_empty(station.world().data / "objects"));
  const auto server = started(station.world().data);
  Client client;
  client.speak_to(server->port());
  station.check(client);  // a trial's samples are read, hence fetched
  EXPECT_FALSE(std::filesystem::is_empty(station.world().data / "objects"));
}

/// A trial whose pieces are all there, without its commit.
std::string hand_over_pieces(Client& client, const ServedWorld& world, std::uint32_t samples) {
  const std::string id = core::new_id();
  const std::string file = trial_bytes(world.folder, id, world.case_id, samples);
  EXPECT_EQ(announce(client, world.station_1, id, world.case_id, file).status, 200);
  constexpr std::size_t kMost = 4u << 20;
  for (std::size_t at = 0; at < file.size(); at += kMost)
    EXPECT_EQ(send_piece(client, world.station_1, id, at, file.substr(at, kMost)).status, 200);
  return id;
}

TEST(TwoServersOnAnObjectStore, TheStoreKilledInACommitIsSaidToBeAwayAndLosesNothing) {
  const ObjectsInS3 there("killed-store");
  PostgresServer postgres(Durable::no);  // it is not killed
  const ServedWorld world(postgres.address(postgres.add_database()));
  auto server = started(world.data);
  Client client;
  client.speak_to(server->port());
  const Headers admin = world.admin(client);
  std::mt19937 random(20261127);
  int refused = 0;
  std::vector<std::string> acknowledged;
  for (int kill = 0; kill < kKills / 6 && !::testing::Test::HasFailure(); ++kill) {
    const std::string id = hand_over_pieces(client, world, kSamples);
    const std::chrono::milliseconds within(std::uniform_int_distribution<int>(0, 30)(random));
    std::thread killer([&] {
      std::this_thread::sleep_for(within);
      s3_server().kill_gateway();
    });
    const Answer first = commit(client, world.station_1, id);
    killer.join();
    s3_server().start();
    if (first.status != 200) {
      ++refused;
      EXPECT_EQ(first.status, 503) << first.body;
      const Answer second = commit(client, world.station_1, id);
      EXPECT_EQ(second.status, 200) << second.body;
    }
    acknowledged.push_back(id);
  }
  std::printf("%d kills of the store, %d commits that were refused\n", kKills / 6, refused);
  EXPECT_GT(refused, 0) << "no kill met a commit: the test shows nothing";
  server.reset();  // its jobs fetch files into the cache
  empty_cache(world.data);
  expect_verified(world.data);
  server = started(world.data);
  client.speak_to(server->port());
  for (const std::string& id : acknowledged) {
    const Answer signals = client.ask("GET", "/api/v1/trials/" + id + "/signals?points=400", admin);
    EXPECT_EQ(signals.json()["t_s"].size(), kSamples) << signals.body.substr(0, 400);
  }
}

/// A trial long enough that scoring it takes a while.
std::string hand_over_long_trial(Client& client, const ServedWorld& world) {
  const std::string id = hand_over_pieces(client, world, 60'000);
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

TEST(TwoServersOnAnObjectStore, AJobWhoseFileIsAwayWaitsAndIsDoneWhenTheStoreIsBack) {
  const ObjectsInS3 there("waiting-job");
  PostgresServer postgres(Durable::no);  // it is not killed
  const ServedWorld world(postgres.address(postgres.add_database()));
  bool caught = false;
  for (int tries = 0; tries < 20 && !caught && !::testing::Test::HasFailure(); ++tries) {
    auto server = started(world.data);
    Client client;
    client.speak_to(server->port());
    hand_over_long_trial(client, world);
    server->kill_now();
    caught = number_from(world, "select count(*) from jobs where state <> 'done'") == 1;
    if (!caught) continue;
    empty_cache(world.data);
    s3_server().kill_gateway();
    server = started(world.data);
    std::this_thread::sleep_for(std::chrono::seconds(5));  // its lease ends, it is tried
    EXPECT_EQ(number_from(world, "select count(*) from jobs where state = 'failed'"), 0);
    EXPECT_EQ(number_from(world, "select count(*) from trials where state = 'failed'"), 0);
    s3_server().start();
    EXPECT_TRUE(becomes_zero(world, "select count(*) from jobs where state <> 'done'"));
    EXPECT_EQ(number_from(world, "select count(*) from trials where state <> 'assessed'"), 0);
  }
  EXPECT_TRUE(caught) << "no kill met a job: the test shows nothing";
}

}  // namespace
}  // namespace tractus
