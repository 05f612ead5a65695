/// The real server over sockets: hostile, slow and broken clients, pages, limits, stopping.
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "tests/support/server/process.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

/// One server for all tests of the suite, with pages and one second's patience for a request's
/// head.
class ServerTransport : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    world_ = std::make_unique<ServedWorld>();
    fs::create_directories(world_->folder / "web" / "assets");
    std::ofstream(world_->folder / "web" / "index.html") << "<!doctype html>page";
    std::ofstream(world_->folder / "secret.txt") << "secret";
    server_ = std::make_unique<ServerProcess>(
        world_->data,
        std::vector<std::string>{"--web", world_->folder / "web", "--header-seconds", "1"});
  }
  static void TearDownTestSuite() {
    server_.reset();
    world_.reset();
  }
  void SetUp() override { client_.speak_to(server_->port()); }

  static inline std::unique_ptr<ServedWorld> world_;
  static inline std::unique_ptr<ServerProcess> server_;
  Client client_;
};

TEST_F(ServerTransport, PagesCarryTheHeadersThatKeepOthersOut) {
  const Answer page = client_.ask("GET", "/trials/abc");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body, "<!doctype html>page");
  EXPECT_NE(page.headers.at("content-security-policy").find("default-src 'self'"),
            std::string::npos);
  EXPECT_NE(page.headers.at("content-security-policy").find("frame-ancestors 'none'"),
            std::string::npos);
  EXPECT_EQ(page.headers.at("x-content-type-options"), "nosniff");
}

TEST_F(ServerTransport, NoPathLeadsOutOfThePages) {
  for (const char* path :
       {"/../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt", "/assets/../../secret.txt",
        "/./../secret.txt", "//../secret.txt", "/..\\secret.txt", "/%00/secret.txt"}) {
    const Answer answer = client_.ask("GET", path);
    EXPECT_EQ(answer.body.find("secret"), std::string::npos) << path;
    EXPECT_TRUE(answer.status == 404 || answer.status == 400 ||
                answer.body == "<!doctype html>page")
        << path << answer.status;
  }
}

TEST_F(ServerTransport, NoPathLeadsOutOfACase) {
  for (const char* name :
       {"..%2f..%2ftractus.db", "%2e%2e", "..%2f..%2fserving.lock", "case.json%00"}) {
    const Answer answer = client_.ask("GET", "/api/v1/cases/" + world_->case_id + "/parts/" + name,
                                      world_->station_1);
    EXPECT_TRUE(answer.status == 404 || answer.status == 400) << name << answer.status;
  }
}

TEST_F(ServerTransport, AHeadThatDripsIsCutOff) {
  const RawAnswer answer =
      send_raw(server_->port(), "GET /api/v1/session HTTP/1.1\r\nX-Slow: ", 5000);
  EXPECT_TRUE(answer.closed) << "still open after five seconds";
  EXPECT_TRUE(answer.text.empty() || answer.text.starts_with("HTTP/1.1 408")) << answer.text;
}

TEST_F(ServerTransport, WhatIsNotHttpIsRefused) {
  for (const std::string& rubbish :
       {std::string("\x16\x03\x01 not http at all\r\n\r\n"), std::string("GET / HTTP/9.9\r\n\r\n"),
        std::string("GET no-slash HTTP/1.1\r\n\r\n"),
        std::string("POST /api/v1/session HTTP/1.1\r\nContent-Length: -5\r\n\r\n"),
        std::string("POST /api/v1/session HTTP/1.1\r\nContent-Length: 5\r\nTransfer-Encoding: "
                    "chunked\r\n\r\n")}) {
    const RawAnswer answer = send_raw(server_->port(), rubbish, 5000);
    EXPECT_TRUE(answer.closed) << rubbish;
    EXPECT_TRUE(answer.text.starts_with("HTTP/1.1 400"))
        << rubbish << " -> " << answer.text.substr(0, 200);
  }
}

TEST_F(ServerTransport, AHeadWithoutEndIsRefused) {
  const RawAnswer answer =
      send_raw(server_->port(), "GET / HTTP/1.1\r\nX-Long: " + std::string(20000, 'x'), 5000);
  EXPECT_TRUE(answer.closed);
  EXPECT_TRUE(answer.text.starts_with("HTTP/1.1 431")) << answer.text.substr(0, 100);
}

TEST_F(ServerTransport, ABodyIsRefusedBeforeItIsSentWithoutCredentials) {
  const RawAnswer answer = send_raw(server_->port(),
                                    "PATCH /api/v1/uploads/" + std::string(32, 'a') +
                                        "?offset_bytes=0 HTTP/1.1\r\nHost: x\r\n"
                                        "Content-Length: 4000000\r\nExpect: 100-continue\r\n\r\n",
                                    1500);
  EXPECT_TRUE(answer.text.starts_with("HTTP/1.1 401")) << answer.text.substr(0, 100);
}

TEST_F(ServerTransport, ABodyOverTheLimitIsRefused) {
  const std::string id(32, 'a');
  Headers headers = world_->station_1;
  headers["X-Crc32c"] = "00000000";
  const Answer answer = client_.ask("PATCH", upload_path(id) + "?offset_bytes=0", headers,
                                    std::string((4u << 20) + 1, 'x'));
  EXPECT_EQ(answer.status, 413) << answer.body;
  headers["Transfer-Encoding"] = "chunked";
  const Answer pieces = client_.ask("PATCH", upload_path(id) + "?offset_bytes=0", headers,
                                    std::string((4u << 20) + 1, 'x'));
  EXPECT_EQ(pieces.status, 413) << pieces.body;
}

TEST_F(ServerTransport, RequestsInOneGoAreAnsweredInOrder) {
  const RawAnswer answer = send_raw(server_->port(),
                                    "GET /api/v1/cases HTTP/1.1\r\nHost: x\r\n\r\n"
                                    "GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n",
                                    5000);
  EXPECT_TRUE(answer.closed);
  const auto first = answer.text.find("HTTP/1.1 401"), second = answer.text.find("HTTP/1.1 200");
  EXPECT_EQ(first, 0u);
  EXPECT_NE(second, std::string::npos);
}

TEST_F(ServerTransport, HeadHasNoBody) {
  const RawAnswer answer =
      send_raw(server_->port(), "HEAD / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n", 5000);
  EXPECT_NE(answer.text.find("Content-Length: 19\r\n"), std::string::npos) << answer.text;
  EXPECT_TRUE(answer.text.ends_with("\r\n\r\n"));
}

TEST_F(ServerTransport, ThePartsOfACaseComeWholeOrByRange) {
  const std::string part = "/api/v1/cases/" + world_->case_id + "/parts/volume.tvol";
  const Answer whole = client_.ask("GET", part, world_->station_1);
  ASSERT_EQ(whole.status, 200);
  std::ifstream file(world_->folder / "case" / "volume.tvol", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  EXPECT_EQ(whole.body, bytes);
  Headers ranged = world_->station_1;
  ranged["Range"] = "bytes=8-11";
  const Answer some = client_.ask("GET", part, ranged);
  EXPECT_EQ(some.status, 206);
  EXPECT_EQ(some.body, bytes.substr(8, 4));
  EXPECT_EQ(some.headers.at("content-range"), "bytes 8-11/" + std::to_string(bytes.size()));
  ranged["Range"] = "bytes=" + std::to_string(bytes.size()) + "-";
  EXPECT_EQ(client_.ask("GET", part, ranged).status, 416);
}

TEST_F(ServerTransport, TheTruthNeverGoesToAStation) {
  const std::string truth = "/api/v1/cases/" + world_->case_id + "/parts/truth.json";
  const Answer refused = client_.ask("GET", truth, world_->station_1);
  EXPECT_EQ(refused.status, 403);
  EXPECT_EQ(refused.body.find("medial"), std::string::npos);
  EXPECT_EQ(client_.ask("GET", truth, world_->admin(client_)).status, 200);
}

TEST_F(ServerTransport, TheManifestIsTheSignedBytes) {
  std::ifstream file(world_->folder / "case" / "case.json", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  EXPECT_EQ(client_.ask("GET", "/api/v1/cases/" + world_->case_id, world_->station_1).body, bytes);
}

TEST_F(ServerTransport, ThePreviewSaysWhereItLies) {
  const Answer answer = client_.ask(
      "GET", "/api/v1/cases/" + world_->case_id + "/preview?max_side=16", world_->station_1);
  ASSERT_EQ(answer.status, 200) << answer.body;
  // The tract (radius 2 mm, 30 mm long) with 12 mm round it: 14 mm to each side of x = y = 0 in
  // voxels of 1 mm from −20 mm: 29 of them; along z from the mouth at 0 to 44 mm, cut at the 40th.
  // Halved or cut in three: 40/3 → 14.
  EXPECT_EQ(answer.headers.at("x-dims"), "10,10,14");
  EXPECT_EQ(answer.body.size(), 10u * 10 * 14);
  EXPECT_EQ(answer.headers.at("x-directions"), "1,0,0,0,1,0,0,0,1");
  EXPECT_EQ(static_cast<unsigned char>(answer.body.front()), 255) << "1000 HU is bone";
}

TEST_F(ServerTransport, TheDescriptionIsOpenApi) {
  const Answer answer = client_.ask("GET", "/api/openapi.json", world_->station_1);
  ASSERT_EQ(answer.status, 200);
  const auto json = answer.json();
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["openapi"], "3.1.0");
  EXPECT_TRUE(json["paths"].contains("/api/v1/trials/{id}"));
  const Ended printed = run_program("tractus-server", {"openapi"});
  EXPECT_EQ(core::Json::parse(printed.out, nullptr, false), json);
}

TEST_F(ServerTransport, ManyAtOnceAreAllAnswered) {
  std::vector<std::thread> threads;
  std::atomic<int> answered = 0;
  for (int i = 0; i < 16; ++i)
    threads.emplace_back([&] {
      Client client;
      client.speak_to(server_->port());
      for (int n = 0; n < 25; ++n)
        answered += client.ask("GET", "/api/v1/cases", world_->station_1).status == 200;
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(answered, 16 * 25);
}

}  // namespace
}  // namespace tractus
