/// The large set-up of deploy/large, without containers: nginx by the very configuration that is
/// handed out, two servers, one PostgreSQL; a station and an administrator who know only the proxy.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "tests/support/postgres/postgres_server.hpp"
#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"

extern char** environ;

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

/// A port that nobody listens on just now.
int free_port() {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(::bind(fd, reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size), 0);
  ::close(fd);
  return ntohs(address.sin_port);
}

/// nginx in the foreground, ended with this object.
class Proxy {
 public:
  Proxy(const ServedWorld& world, const std::string& servers)
      : port_(free_port()), folder_(world.folder / "proxy") {
    fs::create_directories(folder_);
    ::setenv("TRACTUS_SERVERS", servers.c_str(), 1);
    ::setenv("TRACTUS_LISTEN", ("127.0.0.1:" + std::to_string(port_)).c_str(), 1);
    ::setenv("TRACTUS_CERTIFICATE", (world.data / "tls/server.pem").c_str(), 1);
    ::setenv("TRACTUS_KEY", (world.data / "tls/server.key").c_str(), 1);
    ::setenv("TRACTUS_RUN", folder_.c_str(), 1);
    const fs::path configuration = folder_ / "nginx.conf";
    const std::string render =
        std::string(checkout::kSource) + "/deploy/large/render > " + configuration.string();
    EXPECT_EQ(std::system(render.c_str()), 0);
    std::vector<std::string> words{"nginx",       "-e", folder_ / "start.log", "-p", folder_, "-c",
                                   configuration, "-g", "daemon off;"};
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    EXPECT_EQ(::posix_spawnp(&pid_, "nginx", nullptr, nullptr, argv.data(), environ), 0)
        << "nginx is not installed";
  }
  ~Proxy() {
    if (pid_ < 0) return;
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }
  Proxy(const Proxy&) = delete;
  Proxy& operator=(const Proxy&) = delete;
  int port() const { return port_; }
  std::string said() const {
    std::string out;
    for (const char* name : {"start.log", "nginx-error.log"}) {
      std::ifstream file(folder_ / name);
      out.append(std::istreambuf_iterator<char>(file), {});
    }
    return out;
  }

 private:
  int port_;
  fs::path folder_;
  pid_t pid_ = -1;
};

class LargeSetup : public ::testing::Test {
 protected:
  LargeSetup() {
    client_.trust(world_.data / "tls/authority.pem");
    client_.speak_to(proxy_.port());
    for (int tries = 0; tries < 100 && client_.ask("GET", "/api/v1/health").status == 0; ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  static std::string at(const ServerProcess& server) {
    return "127.0.0.1:" + std::to_string(server.port());
  }
  /// How many requests a server itself has answered, by its own figures.
  int answered_by(ServerProcess& server) {
    Client direct;
    direct.speak_to(server.port());
    const std::string text = direct.ask("GET", "/api/v1/server/metrics", world_.station_2).body;
    int count = 0;
    for (auto at = text.find("tractus_requests_total{"); at != std::string::npos;
         at = text.find("tractus_requests_total{", at + 1))
      count += std::atoi(text.c_str() + text.find("} ", at) + 2);
    return count;
  }
  /// One trial, piece by piece; `between` runs in its middle.
  template <class Between>
  std::string hand_over(Between between) {
    const std::string id = core::new_id();
    const std::string file = trial_bytes(world_.folder, id, world_.case_id, 2000);
    EXPECT_EQ(announce(client_, world_.station_1, id, world_.case_id, file).status, 200);
    const std::size_t piece = file.size() / 8 + 1;
    for (std::size_t at = 0; at < file.size(); at += piece) {
      if (at == 4 * piece) between();
      const Answer sent = send_piece(client_, world_.station_1, id, at, file.substr(at, piece));
      EXPECT_EQ(sent.status, 200) << sent.body;
    }
    EXPECT_EQ(commit(client_, world_.station_1, id).status, 200);
    return id;
  }

  const ServedWorld world_{
      test_support::postgres_server().address(test_support::postgres_server().add_database())};
  ServerProcess one_{world_.data, {"--behind-proxy"}}, two_{world_.data, {"--behind-proxy"}};
  Proxy proxy_{world_, at(one_) + " " + at(two_)};
  Client client_;
};

TEST_F(LargeSetup, BothServersServeOneSessionAndOneUpload) {
  const Headers admin = world_.admin(client_);
  ASSERT_FALSE(admin.empty()) << proxy_.said();
  const int before_one = answered_by(one_), before_two = answered_by(two_);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(client_.ask("GET", "/api/v1/session", admin).status, 200) << proxy_.said();
  EXPECT_EQ(client_.ask("GET", "/api/v1/session").headers.at("strict-transport-security"),
            "max-age=31536000");
  const std::string id = hand_over([] {});
  EXPECT_GT(answered_by(one_), before_one + 1);
  EXPECT_GT(answered_by(two_), before_two + 1);
  const Answer trial = client_.ask("GET", "/api/v1/trials/" + id, admin);
  EXPECT_EQ(trial.json()["samples"], 2000) << trial.body;
}

TEST_F(LargeSetup, AServerThatStopsInAnUploadIsNotMissed) {
  const Headers admin = world_.admin(client_);
  ASSERT_FALSE(admin.empty()) << proxy_.said();
  const std::string id = hand_over([this] { EXPECT_EQ(one_.stop(), 0); });
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(client_.ask("GET", "/api/v1/session", admin).status, 200) << proxy_.said();
  EXPECT_EQ(client_.ask("GET", "/api/v1/trials/" + id, admin).json()["samples"], 2000);
}

TEST_F(LargeSetup, TheProxyKeepsAServersOwnFiguresAndForgedAddressesOut) {
  EXPECT_EQ(client_.ask("GET", "/api/v1/server/metrics", world_.station_1).status, 404);
  // Ten wrong passwords from one address shut it out for a while, whatever it says it is.
  Headers lie{{"Content-Type", "application/json"}};
  int last = 0;
  for (int i = 0; i < 12; ++i) {
    lie["X-Forwarded-For"] = "203.0.113." + std::to_string(i);
    last = client_
               .ask("POST", "/api/v1/session", lie,
                    core::Json{{"name", "admin"}, {"password", "wrong password"}}.dump())
               .status;
  }
  EXPECT_EQ(last, 429);
}

}  // namespace
}  // namespace tractus
