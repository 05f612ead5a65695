/// The wall of those who look on, and stations at work, as processes over sockets.
#include "wire/live.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <thread>

#include "core/clock.hpp"
#include "station/uplink/server_socket.hpp"
#include "tests/support/server/web_socket.hpp"
#include "tests/support/server/world.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

wire::StationStatus at_work(double t_s) {
  wire::StationStatus told;
  told.state = wire::StationState::trial;
  told.version = "test";
  told.device = "sim-lambda6";
  told.simulated = true;
  wire::LiveTrial& trial = told.trial.emplace();
  trial.trial_id = std::string(32, 'a');
  trial.rig = trial::Rig::palpation;
  trial.case_id = std::string(64, 'b');
  trial.t_s = t_s;
  trial.samples = static_cast<std::uint64_t>(t_s * 4000);
  trial.force_N = 1.5;
  trial.depth_m = 0.012;
  return told;
}

/// The states that a frame holds.
std::vector<core::Json> states_of(const core::Json& frame) {
  if (frame.value("kind", "") == "stations")
    return frame["stations"].get<std::vector<core::Json>>();
  return {frame.value("station", core::Json::object())};
}

/// Is a station of this name in this state, as the frame says?
auto shows(const std::string& name, const std::string& state) {
  return [=](const core::Json& frame) {
    for (const core::Json& one : states_of(frame))
      if (one.value("name", "") == name && one.value("state", "") == state) return true;
    return false;
  };
}

class Live : public ::testing::Test {
 protected:
  Live() { client_.speak_to(server_.port()); }
  Headers page() {
    if (admin_.empty()) admin_ = world_.admin(client_);
    return from_our_page(admin_, server_.port());
  }
  Answer post(const std::string& path, const core::Json& body) {
    Headers headers = page();
    headers["Content-Type"] = "application/json";
    return client_.ask("POST", "/api/v1" + path, headers, body.dump());
  }
  core::Json get(const std::string& path) {
    page();
    return client_.ask("GET", "/api/v1" + path, admin_).json();
  }
  std::string id_of(const std::string& station) {
    const core::Json fleet = get("/stations");
    for (const core::Json& one : fleet["stations"])
      if (one["name"] == station) return one["id"];
    return "";
  }
  std::string audit_text() { return get("/audit?limit=200").dump(); }
  std::string url() const { return "http://127.0.0.1:" + std::to_string(server_.port()); }

  ServedWorld world_;
  ServerProcess server_{world_.data};
  Client client_;
  Headers admin_;
};

constexpr const char* kWall = "/api/v1/live";
constexpr const char* kLiveLine = "/api/v1/live/station";

TEST_F(Live, AWallShowsAStationThatComesWorksAndGoes) {
  WebSocket wall(server_.port(), kWall, page());
  ASSERT_EQ(wall.status(), 101);
  const auto first = wall.hear();
  ASSERT_TRUE(first);
  EXPECT_EQ((*first)["kind"], "stations");
  ASSERT_EQ((*first)["stations"].size(), 2u);
  EXPECT_EQ((*first)["stations"][0]["state"], "away");
  {
    WebSocket station(server_.port(), kLiveLine, world_.station_1);
    ASSERT_EQ(station.status(), 101);
    ASSERT_TRUE(wall.hear_until(shows("station-1", "idle")));
    ASSERT_TRUE(station.say(at_work(2.5).to_json().dump()));
    const auto seen = wall.hear_until(shows("station-1", "trial"));
    ASSERT_TRUE(seen);
    const core::Json& trial = (*seen)["station"]["trial"];
    EXPECT_EQ(trial["t_s"], 2.5);
    EXPECT_EQ(trial["force_N"], 1.5);
    EXPECT_EQ(trial["samples"], 10000);
    EXPECT_EQ(seen->dump().find("case_id"), std::string::npos) << "nothing of the case";
  }
  const auto gone = wall.hear_until(shows("station-1", "away"));
  ASSERT_TRUE(gone);
  EXPECT_FALSE((*gone)["station"]["connected"]);
  EXPECT_TRUE((*gone)["station"]["trial"].is_null());
  EXPECT_EQ((*gone)["station"]["version"], "test") << "what was known last stays";
}

TEST_F(Live, AWallIsForOurOwnPagesAndForThoseWhoMay) {
  const auto status = [&](const std::string& path, const Headers& headers) {
    return WebSocket(server_.port(), path, headers).status();
  };
  Headers other = page(), none = page();
  other["Origin"] = "http://evil.example";
  none.erase("Origin");
  EXPECT_EQ(status(kWall, other), 403);
  EXPECT_EQ(status(kWall, none), 403);
  EXPECT_EQ(status(kWall, {}), 401);
  EXPECT_EQ(status(kWall, world_.station_1), 403) << "a station sees no other";
  EXPECT_EQ(status(kLiveLine, page()), 403);
  EXPECT_EQ(status("/api/v1/cases", world_.station_1), 400) << "that is no WebSocket";
  EXPECT_EQ(client_.ask("GET", kWall, admin_).status, 426);
  EXPECT_EQ(status(kWall, page()), 101);
}

TEST_F(Live, NobodyIsToldMoreThanTwentyTimesASecond) {
  WebSocket wall(server_.port(), kWall, page());
  WebSocket station(server_.port(), kLiveLine, world_.station_1);
  const long begun = WebSocket::now_ms();
  std::jthread working([&](std::stop_token stop) {
    for (int i = 0; i < 100 && !stop.stop_requested(); ++i) {
      station.say(at_work(i * 0.04).to_json().dump());
      std::this_thread::sleep_for(std::chrono::milliseconds(35));
    }
  });
  // For three seconds, and on a busy machine until it was told what an idle one is in half a
  // second.
  int frames = 0;
  long took_ms = 0;
  while (took_ms < 3000 || (frames < 10 && took_ms < 60'000)) {
    frames += wall.hear(static_cast<int>(std::max(100l, 3000 - took_ms))).has_value();
    took_ms = WebSocket::now_ms() - begun;
  }
  EXPECT_LE(frames, 20e-3 * double(took_ms) + 3);
  EXPECT_GE(frames, 10) << "and it is told";
}

/// Neither a station nor another browser waits for one that does not read.
TEST_F(Live, ASlowBrowserHoldsUpNobodyAndIsDropped) {
  page();  // signing in takes 64 MB for a moment
  const auto before = server_.peak_memory_bytes();
  auto slow = std::make_unique<WebSocket>(server_.port(), kWall, page());
  WebSocket wall(server_.port(), kWall, page());
  WebSocket station(server_.port(), kLiveLine, world_.station_1);
  ASSERT_EQ(slow->status(), 101);
  long worst_ms = 0;
  for (int i = 1; i <= 60; ++i) {
    const long said = WebSocket::now_ms();
    ASSERT_TRUE(station.say(at_work(i).to_json().dump()));
    const auto seen = wall.hear_until([&](const core::Json& frame) {
      return frame.contains("station") && frame["station"]["trial"].is_object() &&
             frame["station"]["trial"]["t_s"] == double(i);
    });
    ASSERT_TRUE(seen) << i;
    worst_ms = std::max(worst_ms, WebSocket::now_ms() - said);
  }
  EXPECT_LT(worst_ms, 2000);
  // What it gets when it reads at last ends in the latest state, not in all that went before.
  int frames = 0;
  double last = 0.0;
  while (const auto frame = slow->hear(500)) {
    ++frames;
    for (const core::Json& one : states_of(*frame))
      if (one["trial"].is_object()) last = one["trial"]["t_s"];
  }
  EXPECT_LE(frames, 70);
  EXPECT_TRUE(slow->closed() || last == 60.0) << last;
  EXPECT_LT(server_.peak_memory_bytes(), before + (32u << 20));
}

TEST_F(Live, ANewLineOfAStationTakesTheOldOnesPlace) {
  WebSocket first(server_.port(), kLiveLine, world_.station_1);
  ASSERT_EQ(first.status(), 101);
  WebSocket second(server_.port(), kLiveLine, world_.station_1);
  ASSERT_EQ(second.status(), 101);
  EXPECT_FALSE(first.hear());
  EXPECT_TRUE(first.closed());
  ASSERT_TRUE(second.say(at_work(1).to_json().dump()));
  WebSocket wall(server_.port(), kWall, page());
  EXPECT_TRUE(wall.hear_until(shows("station-1", "trial")));
}

TEST_F(Live, AStationThatIsShutOutIsHungUpOn) {
  WebSocket station(server_.port(), kLiveLine, world_.station_1);
  ASSERT_EQ(station.status(), 101);
  ASSERT_EQ(post("/stations/" + id_of("station-1") + "/revoke", core::Json::object()).status, 204);
  EXPECT_FALSE(station.hear());
  EXPECT_TRUE(station.closed());
  EXPECT_EQ(WebSocket(server_.port(), kLiveLine, world_.station_1).status(), 401);
}

TEST_F(Live, AStopIsForAStationThatIsThere) {
  const std::string id = id_of("station-1");
  EXPECT_EQ(post("/stations/" + id + "/stop", {{"reason", "look at the hand"}}).status, 409);
  EXPECT_EQ(post("/stations/none/stop", {{"reason", "x"}}).status, 404);
  EXPECT_EQ(post("/stations/" + id + "/stop", {{"reason", "  "}}).status, 400);
  WebSocket station(server_.port(), kLiveLine, world_.station_1);
  ASSERT_EQ(station.status(), 101);
  EXPECT_EQ(post("/stations/" + id + "/stop", {{"reason", "look at the hand"}}).status, 202);
  const auto said = station.hear();
  ASSERT_TRUE(said);
  EXPECT_EQ(*said, (core::Json{{"kind", "stop"}, {"reason", "look at the hand"}}));
  EXPECT_NE(audit_text().find("stopStation"), std::string::npos);
}

/// The whole way: a supervisor's word, the line, the loop, the file, the trail.
TEST_F(Live, AStopEndsARunningTrialWhichIsKeptAndSaysWhy) {
  const fs::path data = world_.folder / "st";
  std::ofstream(world_.folder / "st.token")
      << world_.station_1.at("Authorization").substr(7) << "\n";
  ASSERT_EQ(
      run_program("tractus-station", {"trust", "--data", data, "--case", world_.folder / "case"})
          .code,
      0);
  Ended ended{};
  std::thread program([&] {
    ended = run_program(
        "tractus-station",
        {"--data", data, "--server", url(), "--token-file", world_.folder / "st.token", "--case",
         world_.case_id, "--duration", "60", "--speed", "real", "--trials", "3", "--json"});
  });
  WebSocket wall(server_.port(), kWall, page());
  const auto running = wall.hear_until(
      [](const core::Json& frame) {
        for (const core::Json& one : states_of(frame))
          if (one["trial"].is_object() && one["trial"]["t_s"] > 0.5) return true;
        return false;
      },
      60'000);
  EXPECT_TRUE(running);
  const std::string id = id_of("station-1");
  EXPECT_EQ(post("/stations/" + id + "/limits", {{"force_N", 0.5}}).status, 202);
  const long stopped = WebSocket::now_ms();
  EXPECT_EQ(post("/stations/" + id + "/stop", {{"reason", "hand too hot"}}).status, 202);
  EXPECT_TRUE(wall.hear_until(shows("station-1", "stopped"), 20'000));
  program.join();
  EXPECT_LT(WebSocket::now_ms() - stopped, 20'000) << "of sixty seconds";
  EXPECT_EQ(ended.code, 1) << ended.out;

  const auto said = core::Json::parse(ended.out.substr(ended.out.find("\n{") + 1), nullptr, false);
  ASSERT_TRUE(said.is_object()) << ended.out;
  ASSERT_EQ(said["trials"].size(), 1u) << "no further trial begins without a person";
  EXPECT_EQ(said["trials"][0]["fault"], "stopped by a supervisor: hand too hot");
  EXPECT_EQ(said["upload"]["handed_over"], 1) << ended.out;
  const auto trial = get("/trials/" + said["trials"][0]["trial_id"].get<std::string>());
  EXPECT_EQ(trial["complete"], false);
  EXPECT_NE(trial["events"].dump().find("hand too hot"), std::string::npos);
  ASSERT_TRUE(trial["clock_offset_s"].is_number()) << trial.dump();
  EXPECT_LE(std::abs(trial["clock_offset_s"].get<double>()),
            trial["clock_error_s"].get<double>() + 1e-3)
      << "both clocks are this machine's: the offset is 0 within its own bound";

  const auto limits = run_program("tractus-station", {"limits", "--data", data, "--json"});
  EXPECT_EQ(core::Json::parse(limits.out, nullptr, false)["force_N"], 0.5) << limits.out;
  const auto restored =
      run_program("tractus-station", {"limits", "--data", data, "--restore", "--json"});
  EXPECT_EQ(core::Json::parse(restored.out, nullptr, false)["force_N"], 10.0) << restored.out;

  const std::string trail = audit_text();
  EXPECT_NE(trail.find("stopStation"), std::string::npos);
  EXPECT_NE(trail.find("limitStation"), std::string::npos);
  EXPECT_NE(trail.find("hand too hot"), std::string::npos);
}

TEST_F(Live, AReportIsInTheFleetsListOnceHoweverOftenItCame) {
  const core::Json report{{"self_test",
                           {{"at_utc_us", 1'770'000'000'000'000},
                            {"passed", false},
                            {"checks",
                             {{{"name", "force at rest"},
                               {"passed", true},
                               {"value", 0.01},
                               {"unit", "N"},
                               {"limit", 0.1},
                               {"words", ""}},
                              {{"name", "late ticks"},
                               {"passed", false},
                               {"value", 0.2},
                               {"unit", "1"},
                               {"limit", 0.01},
                               {"words", "too many"}}}}}},
                          {"calibration",
                           {{"at_utc_us", 1'770'000'000'000'000},
                            {"due_utc_us", 1'780'000'000'000'000},
                            {"kind", "force"},
                            {"words", "scale 1.002"}}},
                          {"version", "9.9"},
                          {"free_disk_bytes", 123456789}};
  Headers headers = world_.station_1;
  headers["Content-Type"] = "application/json";
  for (int i = 0; i < 3; ++i)
    ASSERT_EQ(client_.ask("POST", "/api/v1/station/report", headers, report.dump()).status, 204);
  const auto seen = get("/stations/" + id_of("station-1"));
  ASSERT_EQ(seen["self_tests"].size(), 1u) << seen.dump();
  EXPECT_EQ(seen["self_tests"][0], report["self_test"]);
  EXPECT_EQ(seen["calibrations"][0], report["calibration"]);
  EXPECT_EQ(seen["self_test"]["failed"], core::Json::array({"late ticks"}));
  EXPECT_EQ(seen["calibration_due_utc_us"], 1'780'000'000'000'000);
  EXPECT_EQ(seen["version"], "9.9");
  core::Json bad = report;
  bad["self_test"]["checks"] = "none";
  EXPECT_EQ(client_.ask("POST", "/api/v1/station/report", headers, bad.dump()).status, 400);
}

/// Of 16 connections WebSockets get 14: the two that are left answer requests.
TEST(LiveConnections, LeaveRoomForRequests) {
  const ServedWorld world;
  const ServerProcess server(world.data, {"--max-connections", "16"});
  Client client;
  client.speak_to(server.port());
  const Headers page = from_our_page(world.admin(client), server.port());
  std::vector<std::unique_ptr<WebSocket>> open;
  const auto connect = [&](const std::string& path, const Headers& headers) {
    open.push_back(std::make_unique<WebSocket>(server.port(), path, headers));
    return open.back()->status();
  };
  ASSERT_EQ(connect("/api/v1/live/station", world.station_2), 101);
  for (int i = 0; i < 12; ++i) ASSERT_EQ(connect("/api/v1/live", page), 101) << i;
  ASSERT_EQ(connect("/api/v1/live/station", world.station_1), 101);
  EXPECT_EQ(WebSocket(server.port(), "/api/v1/live/station", world.station_2).status(), 503);
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(client.ask("GET", "/api/v1/session", page).status, 200) << i;
  open.pop_back();
  int status = 503;
  for (const auto until = WebSocket::now_ms() + 10'000;
       status != 101 && WebSocket::now_ms() < until;)
    status = WebSocket(server.port(), "/api/v1/live/station", world.station_1).status();
  EXPECT_EQ(status, 101) << "a connection that ended makes room for another";
}

/// By libcurl and Beast, as stations do, with the house's own authority.
TEST(LiveOverTls, AStationsLineWorksAndATamperedAuthorityOpensNone) {
  const ServedWorld world;
  ServerProcess server(world.data, {}, Transport::tls);
  Client client;
  client.trust(world.data / "tls/authority.pem");
  client.speak_to(server.port());
  const Headers admin = world.admin(client);
  const std::atomic<bool> stopped = false;
  uplink::ServerAddress to{.url = "https://127.0.0.1:" + std::to_string(server.port()),
                           .headers = world.station_1,
                           .authority = world.data / "tls/authority.pem"};
  auto line = uplink::open_server_socket(to, stopped);
  ASSERT_TRUE(line) << line.error().what;
  ASSERT_TRUE((*line)->send(at_work(3).to_json().dump()));
  std::string state;
  for (int i = 0; i < 100 && state != "trial"; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    state = client.ask("GET", "/api/v1/stations", admin).json()["stations"][0]["state"];
  }
  EXPECT_EQ(state, "trial");
  to.authority.clear();
  EXPECT_FALSE(uplink::open_server_socket(to, stopped))
      << "an authority nobody named is not trusted";
  to.authority = world.data / "tls/authority.pem";
  to.headers["Authorization"] = "Bearer wrong";
  const auto refused = uplink::open_server_socket(to, stopped);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::unauthorised);
}

}  // namespace
}  // namespace tractus
