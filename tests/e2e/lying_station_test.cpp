/// A station that lies, against the real server: it is refused, the trail says so, and a station
/// beside it goes on as before.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <limits>
#include <thread>

#include "tests/support/server/web_socket.hpp"
#include "tests/support/server/world.hpp"
#include "trial/frames.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

constexpr std::size_t kPieces = 150;

/// Hands over one long trial in pieces, as the recorder's pace would have it, and times each
/// acknowledgement.
class Honest {
 public:
  Honest(const ServedWorld& world, int port, const std::string& id, const std::string& bytes)
      : thread_([this, &world, port, id, bytes](std::stop_token stop) {
          Client client;
          client.speak_to(port);
          announced_ = announce(client, world.station_1, id, world.case_id, bytes).status == 200;
          for (std::size_t at = 0; at < bytes.size() && !stop.stop_requested();) {
            const std::string piece = bytes.substr(at, bytes.size() / kPieces + 1);
            const long begun = WebSocket::now_ms();
            const Answer answer = send_piece(client, world.station_1, id, at, piece);
            took_ms_.push_back(WebSocket::now_ms() - begun);
            if (answer.status != 200) return;
            at += piece.size();
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
          }
          stored_ = commit(client, world.station_1, id).status == 200;
        }) {}
  /// Waits for its end.
  void join() { thread_.join(); }
  bool stored() const { return announced_ && stored_; }
  long quantile_ms(double share) {
    std::ranges::sort(took_ms_);
    if (took_ms_.empty()) return -1;
    return took_ms_[std::min(took_ms_.size() - 1, std::size_t(share * double(took_ms_.size())))];
  }

 private:
  std::atomic<bool> announced_ = false, stored_ = false;
  std::vector<long> took_ms_;
  std::jthread thread_;
};

std::string id_of(char letter) { return std::string(32, letter); }

class Lying : public ::testing::Test {
 protected:
  Lying() {
    client_.speak_to(server_.port());
    admin_ = world_.admin(client_);  // signing in takes 64 MB for a moment
    good_ = trial_bytes(world_.folder, id_of('a'), world_.case_id, 2000);
    long_ = trial_bytes(world_.folder, id_of('f'), world_.case_id, 40'000);
  }
  Answer as_liar(const std::string& method, const std::string& path, const std::string& body = "") {
    return client_.ask(method, path, world_.station_2, body);
  }
  /// Announces these bytes as this trial, sends them all, commits.
  Answer handed_over(const std::string& id, const std::string& bytes) {
    EXPECT_EQ(announce(client_, world_.station_2, id, world_.case_id, bytes).status, 200);
    for (std::size_t at = 0; at < bytes.size(); at += 4u << 20)
      EXPECT_EQ(send_piece(client_, world_.station_2, id, at, bytes.substr(at, 4u << 20)).status,
                200);
    return commit(client_, world_.station_2, id);
  }
  /// A trial of our own header with one more frame, sealed with a count and a hash that hold.
  std::string crafted(trial::FrameType type, std::uint32_t count, core::ByteView rest) {
    std::uint32_t head_bytes = 0;
    std::memcpy(&head_bytes, &good_[trial::kMagic.size() + 4], 4);
    std::string out =
        good_.substr(0, trial::kMagic.size() + trial::kFrameHeader_bytes + head_bytes);
    core::Bytes payload(4 + rest.size());
    std::memcpy(payload.data(), &count, 4);
    std::ranges::copy(rest, payload.begin() + 4);
    out += core::text_of(trial::frame_bytes(type, 1, payload));
    const auto seal = trial::end_payload(count, core::sha256(core::bytes_of(out)));
    return out + std::string(core::text_of(trial::frame_bytes(trial::FrameType::end, 2, seal)));
  }
  core::Json admin_sees(const std::string& path) {
    return client_.ask("GET", "/api/v1" + path, admin_).json();
  }
  /// Rows of the trail by this station whose detail says `word`.
  int rows_of(const std::string& station, const std::string& word) {
    int out = 0;
    const core::Json trail = admin_sees("/audit?limit=200");
    for (const core::Json& row : trail["rows"])
      out += row["who"] == station && row["detail"].dump().find(word) != std::string::npos;
    return out;
  }
  std::size_t trials() { return admin_sees("/trials?limit=200")["trials"].size(); }
  void expect_chain_holds() { EXPECT_EQ(admin_sees("/audit/check")["holds"], true); }

  const ServedWorld world_;
  ServerProcess server_{world_.data};
  Client client_;
  Headers admin_;
  std::string good_, long_;
};

TEST_F(Lying, WhatBelongsToAnotherIsNotTouchedAndTheTrailSaysWhoTried) {
  ASSERT_EQ(announce(client_, world_.station_1, id_of('a'), world_.case_id, good_).status, 200);
  EXPECT_EQ(as_liar("GET", upload_path(id_of('a'))).status, 404);
  EXPECT_EQ(send_piece(client_, world_.station_2, id_of('a'), 0, good_).status, 404);
  EXPECT_EQ(commit(client_, world_.station_2, id_of('a')).status, 404);
  EXPECT_EQ(as_liar("GET", "/api/v1/trials").status, 403);
  EXPECT_EQ(as_liar("GET", "/api/v1/cases/" + world_.case_id + "/parts/truth.json").status, 403);
  EXPECT_EQ(as_liar("POST", "/api/v1/stations/codes", R"({"name":"mine"})").status, 403);
  EXPECT_EQ(rows_of("station-2", "\"status\":404"), 3);
  EXPECT_EQ(rows_of("station-2", "\"status\":403"), 3);
  expect_chain_holds();
}

TEST_F(Lying, AReplayOfATrialIsThatTrialOnce) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(announce(client_, world_.station_2, id_of('a'), world_.case_id, good_).status, 200);
    const Answer piece = send_piece(client_, world_.station_2, id_of('a'), 0, good_);
    EXPECT_EQ(piece.status, i == 0 ? 200 : 409) << piece.body;
    EXPECT_EQ(commit(client_, world_.station_2, id_of('a')).status, 200);
  }
  EXPECT_EQ(trials(), 1u);
  // The same bytes under another id are not that trial; another announcement of it is refused.
  EXPECT_EQ(handed_over(id_of('b'), good_).status, 400);
  EXPECT_EQ(announce(client_, world_.station_2, id_of('a'), world_.case_id, good_ + "x").status,
            409);
  EXPECT_EQ(trials(), 1u);
}

TEST_F(Lying, SamplesThatAreNoNumbersAreNoTrial) {
  trial::Sample sample = sample_at(0);
  const auto bytes = [&] { return std::as_bytes(std::span(&sample, 1)); };
  EXPECT_EQ(handed_over(id_of('a'), crafted(trial::FrameType::samples, 1, bytes())).status, 200)
      << "the same with a number is one";
  sample.p_VH_m[2] = std::numeric_limits<double>::quiet_NaN();
  good_ = trial_bytes(world_.folder, id_of('b'), world_.case_id, 1);
  const Answer refused = handed_over(id_of('b'), crafted(trial::FrameType::samples, 1, bytes()));
  EXPECT_EQ(refused.status, 400);
  EXPECT_NE(refused.body.find("not finite"), std::string::npos) << refused.body;
  EXPECT_EQ(rows_of("station-2", "not finite"), 1);
  EXPECT_EQ(trials(), 1u);
}

TEST_F(Lying, ABillionSamplesAreRefusedWhenTheyAreAnnounced) {
  const auto announced = [&](std::uint64_t size) {
    return as_liar(
        "PUT", upload_path(id_of('a')),
        core::Json{
            {"case_id", world_.case_id}, {"size_bytes", size}, {"sha256", std::string(64, '0')}}
            .dump());
  };
  EXPECT_EQ(announced(160'000'000'000ull).status, 400) << "10^9 samples of 160 bytes";
  EXPECT_EQ(announced(1ull << 32).status, 413);
  EXPECT_GE(rows_of("station-2", "why"), 2);
  // Frames that say they hold so many are refused by what they really hold.
  const auto before = server_.peak_memory_bytes();
  const std::string few(1000, 'x');
  for (const auto type : {trial::FrameType::samples, trial::FrameType::packed})
    EXPECT_EQ(handed_over(id_of(type == trial::FrameType::packed ? 'b' : 'c'),
                          crafted(type, 1'000'000'000, core::bytes_of(few)))
                  .status,
              400);
  EXPECT_LT(server_.peak_memory_bytes(), before + (64u << 20));
  EXPECT_EQ(trials(), 0u);
}

TEST_F(Lying, AWrongHashIsNoTrialAndMayBeSentAnew) {
  const core::Json said{{"case_id", world_.case_id},
                        {"size_bytes", good_.size()},
                        {"sha256", core::sha256(core::bytes_of("something else"))}};
  ASSERT_EQ(as_liar("PUT", upload_path(id_of('a')), said.dump()).status, 200);
  ASSERT_EQ(send_piece(client_, world_.station_2, id_of('a'), 0, good_).status, 200);
  const Answer refused = commit(client_, world_.station_2, id_of('a'));
  EXPECT_EQ(refused.status, 400);
  EXPECT_NE(refused.body.find("sha256"), std::string::npos);
  EXPECT_EQ(as_liar("GET", upload_path(id_of('a'))).json()["offset_bytes"], 0);
  EXPECT_EQ(rows_of("station-2", "sha256"), 2) << "announced, and refused at the end";
  EXPECT_EQ(trials(), 0u);
}

TEST_F(Lying, ABombIsNotUnpacked) {
  const std::string zeros(256u << 20, '\0');
  std::string bomb(ZSTD_compressBound(zeros.size()), '\0');
  bomb.resize(ZSTD_compress(bomb.data(), bomb.size(), zeros.data(), zeros.size(), 1));
  ASSERT_LT(bomb.size(), 100'000u);
  const auto before = server_.peak_memory_bytes();
  EXPECT_EQ(handed_over(id_of('a'), bomb).status, 400) << "as a trial";
  const Answer packed =
      handed_over(id_of('b'), crafted(trial::FrameType::packed, 7643, core::bytes_of(bomb)));
  EXPECT_EQ(packed.status, 400) << "as packed samples";
  Headers headers = world_.station_2;
  headers["Content-Encoding"] = "zstd";
  headers["Content-Type"] = "application/json";
  EXPECT_EQ(client_.ask("POST", "/api/v1/station/report", headers, bomb.substr(0, 60'000)).status,
            400)
      << "as an encoded body";
  EXPECT_LT(server_.peak_memory_bytes(), before + (32u << 20)) << "256 MB were not unpacked";
  EXPECT_EQ(trials(), 0u);
}

TEST_F(Lying, GiantFramesAndFloodsOnALineAreHungUpOnAndNoted) {
  constexpr const char* kOwn = "/api/v1/live/station";
  {
    WebSocket giant(server_.port(), kOwn, world_.station_2);
    ASSERT_EQ(giant.status(), 101);
    // A text frame that announces 2^62 bytes.
    giant.send_bytes(std::string("\x81\xFF\x40\0\0\0\0\0\0\0\1\2\3\4", 14) + "xxxx");
    EXPECT_FALSE(giant.hear());
    EXPECT_TRUE(giant.closed());
  }
  {
    WebSocket flood(server_.port(), kOwn, world_.station_2);
    ASSERT_EQ(flood.status(), 101);
    bool taken = true;
    for (int i = 0; i < 100'000 && taken; ++i)
      taken = flood.say(R"({"kind":"state","state":"idle"})");
    while (flood.hear(2000)) {
    }
    EXPECT_TRUE(flood.closed());
  }
  {
    WebSocket nonsense(server_.port(), kOwn, world_.station_2);
    ASSERT_TRUE(nonsense.say(R"({"kind":"state","state":"idle","late_share":1e400})"));
    EXPECT_FALSE(nonsense.hear());
    EXPECT_TRUE(nonsense.closed());
    EXPECT_EQ(nonsense.close_code(), 1008);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(rows_of("station-2", "exceeded the size limit"), 1);
  EXPECT_EQ(rows_of("station-2", "too many messages per second"), 1);
  EXPECT_EQ(rows_of("station-2", "a message was invalid"), 1);
}

TEST_F(Lying, TheTrailCannotBeFlooded) {
  for (int i = 0; i < 600; ++i) ASSERT_EQ(as_liar("GET", "/api/v1/trials").status, 403);
  const int rows = rows_of("station-2", "\"status\":403");
  EXPECT_GE(rows, 10);
  EXPECT_LE(rows, 40);
  expect_chain_holds();
}

/// Connections that send a byte now and then, more of them than the server holds.
class SlowLoris {
 public:
  SlowLoris(int port, int count)
      : thread_([this, port, count](std::stop_token stop) {
          std::vector<int> open;
          for (std::size_t i = 0; !stop.stop_requested(); ++i) {
            if (open.size() < std::size_t(count)) {
              const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
              sockaddr_in to{};
              to.sin_family = AF_INET;
              to.sin_port = htons(static_cast<std::uint16_t>(port));
              to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
              if (::connect(fd, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) {
                ::close(fd);
                continue;
              }
              open.push_back(fd);
              ++opened_;
            }
            const int fd = open[i % open.size()];
            if (::send(fd, "G", 1, MSG_NOSIGNAL | MSG_DONTWAIT) < 0) {
              ::close(fd);
              std::erase(open, fd);
            }
            if (open.size() >= std::size_t(count)) ::usleep(500);
          }
          for (const int fd : open) ::close(fd);
        }) {}
  int opened() const { return opened_; }

 private:
  std::atomic<int> opened_ = 0;
  std::jthread thread_;
};

TEST_F(Lying, AnHonestStationBesideItIsNotSlowed) {
  long alone_ms = 0;
  {
    Honest alone(world_, server_.port(), id_of('f'), long_);
    alone.join();
    ASSERT_TRUE(alone.stored());
    alone_ms = alone.quantile_ms(0.99);
  }
  std::atomic<int> lies = 0;
  std::uint64_t stored = 1;
  {
    SlowLoris loris(server_.port(), 700);
    std::jthread liar([&](std::stop_token stop) {
      Client client;
      client.speak_to(server_.port());
      while (!stop.stop_requested()) {
        client.ask("GET", "/api/v1/trials", world_.station_2);
        send_piece(client, world_.station_2, id_of('e'), 0, "lies");
        WebSocket flood(server_.port(), "/api/v1/live/station", world_.station_2);
        for (int i = 0; i < 200 && flood.say("{}"); ++i) {
        }
        ++lies;
      }
    });
    // Whoever is slowed by lies is so each time; a machine that is busy by itself is not.
    const long allowed_ms = std::max(250l, 10 * alone_ms);
    long beside_ms = std::numeric_limits<long>::max();
    for (const char id : {'e', 'd', 'c'}) {
      const std::string trial = trial_bytes(world_.folder, id_of(id), world_.case_id, 40'000);
      Honest beside(world_, server_.port(), id_of(id), trial);
      beside.join();
      EXPECT_TRUE(beside.stored());
      ++stored;
      beside_ms = beside.quantile_ms(0.99);
      std::printf(
          "acknowledgement p99: alone %ld ms, beside %d rounds of lies and %d slow "
          "connections %ld ms\n",
          alone_ms, lies.load(), loris.opened(), beside_ms);
      if (beside_ms < allowed_ms) break;
    }
    EXPECT_LT(beside_ms, allowed_ms);
    EXPECT_GT(loris.opened(), 512) << "more than the server holds";
  }
  EXPECT_EQ(trials(), stored);
  expect_chain_holds();
}

}  // namespace
}  // namespace tractus
