/// The real server and what no well-meant client sends: framing that others read differently,
/// nested JSON, proxies that nobody named, weak cipher suites.
#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <algorithm>
#include <fstream>

#include "tests/support/server/process.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

std::ptrdiff_t answers_in(const std::string& text) {
  std::ptrdiff_t count = 0;
  for (auto at = text.find("HTTP/1.1 "); at != std::string::npos;
       at = text.find("HTTP/1.1 ", at + 1))
    ++count;
  return count;
}

/// One server for all tests of the suite.
class Hostile : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    world_ = std::make_unique<ServedWorld>();
    server_ = std::make_unique<ServerProcess>(world_->data);
  }
  static void TearDownTestSuite() {
    server_.reset();
    world_.reset();
  }
  void SetUp() override { client_.speak_to(server_->port()); }
  void TearDown() override {
    EXPECT_EQ(client_.ask("GET", "/api/v1/health").status, 200) << "the server is gone";
  }
  /// 400 and the end of the connection: what follows is not read as another request.
  void expect_refused(const std::string& head) {
    const RawAnswer answer = send_raw(
        server_->port(), head + "\r\nGET /api/v1/health HTTP/1.1\r\nHost: x\r\n\r\n", 5000);
    EXPECT_TRUE(answer.closed) << head;
    EXPECT_TRUE(answer.text.starts_with("HTTP/1.1 400")) << head << answer.text.substr(0, 200);
    EXPECT_EQ(answers_in(answer.text), 1) << head << answer.text;
  }

  static inline std::unique_ptr<ServedWorld> world_;
  static inline std::unique_ptr<ServerProcess> server_;
  Client client_;
};

TEST_F(Hostile, ATransferCodingOtherThanChunkedEndsTheConnection) {
  const std::string start = "POST /api/v1/session HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: ";
  for (const char* coding : {"gzip", "identity", "xchunked", "chunked, gzip", "gzip, chunked",
                             "chunked, chunked", "chunked\r\nTransfer-Encoding: chunked", ""})
    expect_refused(start + coding + "\r\n");
  expect_refused(
      "POST /api/v1/session HTTP/1.0\r\nHost: x\r\nConnection: keep-alive\r\n"
      "Transfer-Encoding: chunked\r\n");
}

TEST_F(Hostile, ARequestNamesExactlyOneHost) {
  expect_refused("GET /api/v1/health HTTP/1.1\r\n");
  expect_refused("GET /api/v1/health HTTP/1.1\r\nHost: a\r\nHost: b\r\n");
  expect_refused("GET /api/v1/health HTTP/1.1\r\nHost: a\r\nHost: a\r\n");
}

TEST_F(Hostile, NestedJsonIsRefused) {
  const std::string nested = std::string(120'000, '[') + std::string(120'000, ']');
  const Answer answer =
      client_.ask("POST", "/api/v1/scenarios/check", world_->admin(client_), nested);
  EXPECT_EQ(answer.status, 400) << answer.body;
  EXPECT_NE(answer.body.find("nested deeper than 32 levels"), std::string::npos) << answer.body;
}

TEST_F(Hostile, AZipWithANestedSetIsRefused) {
  const fs::path folder = world_->folder / "set", zip = world_->folder / "set.zip";
  fs::create_directories(folder);
  std::ofstream(folder / "set.json")
      << R"({"format":"tractus-measurements/1","rig":"probing","trials":)"
      << std::string(4'000'000, '[') << std::string(4'000'000, ']') << "}";
  const std::string made =
      "cd " + world_->folder.string() + " && python3 -m zipfile -c set.zip set";
  ASSERT_EQ(std::system(made.c_str()), 0);
  std::ifstream file(zip, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  ASSERT_LT(bytes.size(), 20'000u);
  Headers headers = world_->admin(client_);
  headers["Content-Type"] = "application/zip";
  const Answer answer = client_.ask("POST", "/api/v1/lab/measurements?name=nested", headers, bytes);
  EXPECT_EQ(answer.status, 400) << answer.body;
  EXPECT_NE(answer.body.find("nested deeper than 32 levels"), std::string::npos) << answer.body;
}

TEST_F(Hostile, EveryAnswerSaysHowLongItMayBeKept) {
  const Headers admin = world_->admin(client_);
  int asked = 0;
  const core::Json description = client_.ask("GET", "/api/openapi.json", admin).json();
  for (const auto& [path, methods] : description["paths"].items()) {
    if (!methods.contains("get") || path.find('{') != std::string::npos) continue;
    ++asked;
    const Answer answer = client_.ask("GET", path, admin);
    EXPECT_EQ(answer.headers.count("cache-control"), 1u) << path;
  }
  EXPECT_GT(asked, 20);
  const std::string model = R"({"format":"tractus-model/1","rig":"probing","name":"one layer",
    "base":{"layers":[{"start_m":0,"thickness_m":0.05,"stiffness_N_per_m":4000,"damping_Ns_per_m":2000,
    "equilibrium_m":0}],"rotary":{"viscous_Nms_per_rad":0.02,"detent_Nm":0.01,"detent_pitch_rad":0.35}}})";
  const Answer kept = client_.ask("POST", "/api/v1/lab/models", admin, model);
  ASSERT_EQ(kept.status, 201) << kept.body;
  const std::string id = kept.json()["id"];
  EXPECT_EQ(client_.ask("GET", "/api/v1/lab/models/" + id, admin).headers.at("cache-control"),
            "no-store");
}

/// Whom the audit trail names as the peer of the last sign-in.
std::string peer_of_sign_in(ServedWorld& world, const std::vector<std::string>& options,
                            const std::string& forwarded_for) {
  ServerProcess server(world.data, options);
  Client client;
  client.speak_to(server.port());
  const Answer in =
      client.ask("POST", "/api/v1/session",
                 {{"Content-Type", "application/json"}, {"X-Forwarded-For", forwarded_for}},
                 core::Json{{"name", "admin"}, {"password", ServedWorld::kPassword}}.dump());
  EXPECT_EQ(in.status, 200) << in.body;
  const std::string cookie = in.headers.at("set-cookie");
  const Answer audit =
      client.ask("GET", "/api/v1/audit?limit=1", {{"Cookie", cookie.substr(0, cookie.find(';'))}});
  EXPECT_EQ(audit.status, 200) << audit.body;
  return audit.json()["rows"][0]["peer"];
}

TEST(Proxies, AreBelievedWhenTheyAreNamed) {
  ServedWorld world;
  EXPECT_EQ(peer_of_sign_in(world, {}, "203.0.113.9"), "127.0.0.1") << "behind no proxy";
  EXPECT_EQ(peer_of_sign_in(world, {"--behind-proxy"}, "203.0.113.9"), "203.0.113.9");
  EXPECT_EQ(peer_of_sign_in(world, {"--behind-proxy"}, "6.6.6.6, 203.0.113.9"), "203.0.113.9");
  EXPECT_EQ(
      peer_of_sign_in(world, {"--behind-proxy", "--trusted-proxy", "192.0.2.1"}, "203.0.113.9"),
      "127.0.0.1")
      << "this machine is not the proxy";
  EXPECT_EQ(peer_of_sign_in(world,
                            {"--behind-proxy", "--trusted-proxy", "192.0.2.1", "--trusted-proxy",
                             "127.0.0.0/30"},
                            "203.0.113.9"),
            "203.0.113.9");
  const Ended wrong = run_program(
      "tractus-server",
      {"serve", "--data", world.data, "--behind-proxy", "--trusted-proxy", "proxy.example.org"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.out.find("--trusted-proxy 'proxy.example.org'"), std::string::npos) << wrong.out;
}

/// The suite that a TLS 1.2 client with these suites agrees on; empty when there is none.
std::string suite_agreed(int port, const char* suites) {
  SSL_CTX* const context = SSL_CTX_new(TLS_client_method());
  SSL_CTX_set_max_proto_version(context, TLS1_2_VERSION);
  EXPECT_EQ(SSL_CTX_set_cipher_list(context, suites), 1) << suites;
  BIO* const line = BIO_new_ssl_connect(context);
  SSL* tls = nullptr;
  BIO_get_ssl(line, &tls);
  BIO_set_conn_hostname(line, ("127.0.0.1:" + std::to_string(port)).c_str());
  const bool agreed = BIO_do_connect(line) == 1 && BIO_do_handshake(line) == 1;
  std::string out = agreed ? SSL_get_cipher_name(tls) : "";
  BIO_free_all(line);
  SSL_CTX_free(context);
  return out;
}

TEST(Tls, TakesNoCipherSuiteButEcdheWithAead) {
  const ServedWorld world;
  const ServerProcess server(world.data, {}, Transport::tls);
  for (const char* suite : {"ECDHE-ECDSA-AES128-GCM-SHA256", "ECDHE-ECDSA-AES256-GCM-SHA384",
                            "ECDHE-ECDSA-CHACHA20-POLY1305"})
    EXPECT_EQ(suite_agreed(server.port(), suite), suite);
  for (const char* suite : {"ECDHE-ECDSA-AES128-SHA", "ECDHE-ECDSA-AES256-SHA",
                            "ECDHE-ECDSA-AES128-SHA256", "ECDHE-ECDSA-AES256-SHA384"})
    EXPECT_EQ(suite_agreed(server.port(), suite), "") << suite;
}

TEST(Tls, IsAskedForFromTheFirstAnswerOn) {
  const ServedWorld world, other;
  ServerProcess server(world.data, {}, Transport::tls), proxied(other.data, {"--behind-proxy"});
  Client client, behind;
  client.trust(world.data / "tls/authority.pem");
  client.speak_to(server.port());
  behind.speak_to(proxied.port());
  for (Client* one : {&client, &behind}) {
    const Answer wrong = one->ask("POST", "/api/v1/session", {{"Content-Type", "application/json"}},
                                  R"({"name":"admin","password":"wrong"})");
    EXPECT_EQ(wrong.status, 401);
    EXPECT_EQ(wrong.headers.at("strict-transport-security"), "max-age=31536000");
  }
}

TEST_F(Hostile, PlainHttpAsksForNoTls) {
  EXPECT_EQ(client_.ask("GET", "/api/v1/health").headers.count("strict-transport-security"), 0u);
}

}  // namespace
}  // namespace tractus
