/// The network as its people meet it: TLS, a station that enrols, a trainee at it, backup, and what
/// a tampered folder is told.
#include <gtest/gtest.h>

#include <fstream>

#include "core/bytes.hpp"
#include "db/store/store.hpp"
#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

core::Json parsed(const Ended& ended) { return core::Json::parse(ended.out, nullptr, false); }

class Network : public ::testing::Test {
 protected:
  fs::path authority() const { return world_.data / "tls/authority.pem"; }
  Ended server_does(const std::string& command, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{command, "--data", world_.data.string(), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program("tractus-server", arguments);
  }
  /// Changes the database behind everybody's back.
  void tamper(const std::string& sql) {
    const auto database = world_.connection();
    ASSERT_TRUE(database && database->script(sql));
  }
  const ServedWorld world_;
};

/// From an empty server to an assessed, assigned trial, every step over TLS.
TEST_F(Network, ATraineeAtAnEnrolledStationDoesTheAssignedCaseOverTls) {
  ServerProcess server(world_.data, {}, Transport::tls);
  Client client;
  client.trust(authority());
  client.speak_to(server.port());
  Headers admin = world_.admin(client);
  admin["Content-Type"] = "application/json";
  const auto post = [&](const std::string& path, const core::Json& body) {
    return client.ask("POST", "/api/v1" + path, admin, body.dump());
  };
  const auto tom = post("/accounts", {{"name", "tom"},
                                      {"role", "trainee"},
                                      {"password", "a first password"},
                                      {"badge", "4711"},
                                      {"pin", "2468"}});
  ASSERT_EQ(tom.status, 201) << tom.body;
  const auto task = post("/assignments", {{"title", "Week 1"},
                                          {"people", {"tom"}},
                                          {"repeats", 2},
                                          {"cases", {{{"case", world_.case_id}}}}});
  ASSERT_EQ(task.status, 201) << task.body;
  const auto code = post("/stations/codes", {{"name", "room 3"}});
  ASSERT_EQ(code.status, 201) << code.body;

  const std::string url = "https://127.0.0.1:" + std::to_string(server.port());
  const fs::path token = world_.folder / "room3.token", data = world_.folder / "room3";
  const Ended untrusted =
      run_program("tractus-station",
                  {"enrol", "--server", url, "--code", code.json()["code"], "--token-file", token});
  EXPECT_EQ(untrusted.code, 2) << "an authority nobody named is not trusted";
  EXPECT_FALSE(fs::exists(token));
  const std::vector<std::string> there{"--server",     url,   "--authority", authority(),
                                       "--token-file", token, "--json"};
  const auto station_does = [&](std::vector<std::string> words) {
    words.insert(words.end(), there.begin(), there.end());
    return run_program("tractus-station", words);
  };
  const Ended in = station_does({"enrol", "--code", code.json()["code"]});
  ASSERT_EQ(in.code, 0) << in.out;
  EXPECT_EQ(parsed(in)["station"], "room 3");
  ASSERT_EQ(
      run_program("tractus-station", {"trust", "--data", data, "--case", world_.folder / "case"})
          .code,
      0);
  std::ofstream(world_.folder / "pin") << "2468\n";
  const Ended done = station_does({"assigned", "--badge", "4711", "--pin-file",
                                   world_.folder / "pin", "--data", data, "--speed", "fast",
                                   "--duration", "4", "--trials", "5", "--answer", "medial"});
  ASSERT_EQ(done.code, 0) << done.out;
  const auto said = core::Json::parse(done.out.substr(done.out.find('{')), nullptr, false);
  EXPECT_EQ(said["left"], 0) << done.out;
  EXPECT_EQ(said["trials"].size(), 2u) << done.out;

  const auto seen =
      client.ask("GET", "/api/v1/assignments/" + task.json()["id"].get<std::string>(), admin)
          .json();
  EXPECT_EQ(seen["done"], 2) << seen;
  const auto trial = client.ask(
      "GET", "/api/v1/trials/" + seen["trials"][0]["trial_id"].get<std::string>(), admin);
  EXPECT_EQ(trial.json()["operator_name"], seen["trainees"][0]["participant"]);
  EXPECT_EQ(trial.json()["case_id"], world_.case_id);
  EXPECT_EQ(server.stop(), 0);
}

TEST_F(Network, ABackupTakenWhileServingIsPutBackAndServes) {
  const fs::path backup = world_.folder / "backup", again = world_.folder / "again";
  {
    ServerProcess server(world_.data);
    const Ended made = server_does("backup", {"--out", backup});
    ASSERT_EQ(made.code, 0) << made.out;
    EXPECT_EQ(server_does("backup", {"--out", backup}).code, 2) << "never over another";
    EXPECT_EQ(server.stop(), 0);
  }
  const Ended put_back =
      run_program("tractus-server", {"restore", "--from", backup, "--data", again, "--json"});
  ASSERT_EQ(put_back.code, 0) << put_back.out;
  EXPECT_EQ(parsed(put_back)["holds"], true);
  ServerProcess server(again);
  Client client;
  client.speak_to(server.port());
  const auto cases = client.ask("GET", "/api/v1/cases", world_.admin(client)).json();
  ASSERT_EQ(cases["cases"].size(), 1u);
  EXPECT_EQ(cases["cases"][0]["id"], world_.case_id);
  EXPECT_EQ(client.ask("GET", "/api/v1/cases", world_.station_1).status, 200);
}

TEST_F(Network, ABackupThatWasTamperedWithIsNotPutBack) {
  const fs::path backup = world_.folder / "backup", again = world_.folder / "again";
  ASSERT_EQ(server_does("backup", {"--out", backup}).code, 0);
  std::ofstream(backup / "secret.key", std::ios::app) << "x";
  const Ended refused =
      run_program("tractus-server", {"restore", "--from", backup, "--data", again});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.out.find("secret.key"), std::string::npos) << refused.out;
  EXPECT_FALSE(fs::exists(again));
}

TEST_F(Network, VerifyingFindsWhatWasDoneToAFolder) {
  EXPECT_EQ(server_does("verify", {}).code, 0);
  { ServerProcess(world_.data).stop(); }  // notes the trail's end
  const Ended fine = server_does("verify", {});
  EXPECT_EQ(fine.code, 0) << fine.out;
  EXPECT_GE(parsed(fine)["audit_rows"].get<int>(), 4) << "init, two stations, a case";

  tamper("create table kept as select * from audit");
  const auto found_after = [&](const std::string& sql) {
    tamper(sql);
    const Ended ended = server_does("verify", {});
    EXPECT_EQ(ended.code, 1) << sql << ended.out;
    const std::string found = parsed(ended)["findings"].dump();
    tamper("delete from audit; insert into audit select * from kept");
    return found;
  };
  EXPECT_NE(found_after("update audit set who = 'nobody' where number = 2").find("row 2"),
            std::string::npos);
  EXPECT_NE(found_after("delete from audit where number = 1").find("row 1"), std::string::npos);
  EXPECT_NE(found_after("delete from audit where number = (select max(number) from audit)")
                .find("cut off"),
            std::string::npos);
  EXPECT_EQ(server_does("verify", {}).code, 0);

  for (const auto& entry : fs::recursive_directory_iterator(world_.data / "objects")) {
    if (!entry.is_regular_file()) continue;
    fs::permissions(entry.path(), fs::perms::owner_write, fs::perm_options::add);
    std::fstream(entry.path(), std::ios::in | std::ios::out | std::ios::binary).put('!');
    break;
  }
  const Ended broken = server_does("verify", {});
  EXPECT_EQ(broken.code, 1);
  EXPECT_NE(broken.out.find("its bytes changed"), std::string::npos) << broken.out;
}

TEST_F(Network, PlainHttpIsForThisMachineAlone) {
  const Ended refused = run_program(
      "tractus-server", {"serve", "--data", world_.data, "--listen", "0.0.0.0:0", "--plain"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.out.find("--behind-proxy"), std::string::npos) << refused.out;
}

/// A word planted wherever people type is in no line of the log and no metric.
TEST_F(Network, LogAndMetricsHoldNothingThatSomebodyTyped) {
  const fs::path log = world_.folder / "log";
  const std::string planted = "Plantagenet";
  std::string metrics;
  {
    ServerProcess server(world_.data, {"--log-requests"});
    Client client;
    client.speak_to(server.port());
    Headers admin = world_.admin(client);
    admin["Content-Type"] = "application/json";
    client.ask("POST", "/api/v1/session", {{"Content-Type", "application/json"}},
               core::Json{{"name", planted}, {"password", planted}}.dump());
    client.ask("POST", "/api/v1/accounts", admin,
               core::Json{{"name", planted}, {"role", "trainee"}}.dump());
    client.ask("GET", "/api/v1/trials/" + planted, admin);
    client.ask("GET", "/" + planted, admin);
    metrics = client.ask("GET", "/api/v1/server/metrics", admin).body;
    EXPECT_EQ(client.ask("GET", "/api/v1/health").status, 200);
    EXPECT_EQ(server.stop(), 0);
    std::ofstream(log) << server.output();
  }
  const std::string said = bytes_of(log);
  EXPECT_NE(said.find("\"route\":\"addAccount\""), std::string::npos) << said;
  EXPECT_EQ(said.find(planted), std::string::npos) << said;
  EXPECT_NE(metrics.find("tractus_requests_total{route=\"signIn\",status=\"401\"} 1"),
            std::string::npos)
      << metrics;
  EXPECT_EQ(metrics.find(planted), std::string::npos);
  for (const std::string secret : {"admin", "127.0.0.1", "station-1"})
    EXPECT_EQ(said.find(secret), std::string::npos) << secret;
}

}  // namespace
}  // namespace tractus
