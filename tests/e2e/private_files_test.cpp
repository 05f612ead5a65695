/// Files of a data folder are their owner's alone, large bodies leave nothing behind.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "core/bytes.hpp"
#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

/// What others than the owner may reach, below a folder and itself.
std::vector<std::string> open_to_others(const fs::path& folder) {
  std::vector<std::string> out;
  const auto look = [&](const fs::path& path) {
    struct stat info {};
    if (::lstat(path.c_str(), &info) == 0 && (info.st_mode & 077) != 0)
      out.push_back(path.string());
  };
  look(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) look(entry.path());
  return out;
}

void open_everything(const fs::path& folder) {
  fs::permissions(folder, fs::perms(0755));
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    fs::permissions(entry.path(), fs::perms(entry.is_directory() ? 0755 : 0644));
}

std::size_t files_in(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    count += entry.is_regular_file() && entry.path().filename() != "serving.lock" ? 1 : 0;
  return count;
}

/// The number of files in a folder once it is `wanted`, or after 5 s: the server deletes the file of
/// a body after it sent the answer to it.
std::size_t files_awaited_in(const fs::path& folder, std::size_t wanted) {
  for (int tries = 0; tries < 100 && files_in(folder) != wanted; ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return files_in(folder);
}

class PrivateFiles : public ::testing::Test {
 protected:
  void hand_over(Client& client) const {
    const std::string id = core::new_id();
    const std::string file = trial_bytes(world_.folder, id, world_.case_id, 400);
    EXPECT_EQ(announce(client, world_.station_1, id, world_.case_id, file).status, 200);
    EXPECT_EQ(send_piece(client, world_.station_1, id, 0, file).status, 200);
    EXPECT_EQ(commit(client, world_.station_1, id).status, 200);
  }
  const ServedWorld world_;
};

TEST_F(PrivateFiles, AFolderThatOthersCouldReadIsMadePrivateAndStaysSo) {
  open_everything(world_.data);
  ServerProcess server(world_.data);
  EXPECT_EQ(open_to_others(world_.data), std::vector<std::string>()) << "while it serves";
  Client client;
  client.speak_to(server.port());
  const Headers admin = world_.admin(client);
  hand_over(client);
  EXPECT_EQ(client.ask("POST", "/api/v1/backups", admin).status, 201);
  EXPECT_EQ(run_program("tractus-server",
                        {"backup", "--data", world_.data, "--out", world_.folder / "backup"})
                .code,
            0);
  EXPECT_EQ(server.stop(), 0);
  EXPECT_EQ(open_to_others(world_.data), std::vector<std::string>()) << "afterwards";
  EXPECT_EQ(open_to_others(world_.folder / "backup"), std::vector<std::string>());
}

TEST_F(PrivateFiles, InitInAFolderThatIsThereMakesItPrivate) {
  const fs::path data = world_.folder / "there";
  fs::create_directories(data);
  fs::permissions(data, fs::perms(0755));
  const Ended made = run_program(
      "tractus-server", {"init", "--data", data, "--password-file", world_.folder / "password"});
  ASSERT_EQ(made.code, 0) << made.out;
  EXPECT_EQ(open_to_others(data), std::vector<std::string>());
  EXPECT_NE(made.out.find("others had access"), std::string::npos) << made.out;
}

TEST_F(PrivateFiles, WhatAServerThatDiedLeftIsRemovedAtTheStart) {
  const std::vector<fs::path> left{
      world_.data / "scratch" / core::new_id() / "body-1.spool",
      world_.data / "objects" / "00" / "11.0a0b0c0d.part", world_.data / "audit.highwater.01.part",
      world_.data / "backups" / ".2026-01-01T00-00-00Z.0a0b0c0d.part" / "tractus.db"};
  for (const fs::path& path : left) {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << "left";
    // On PostgreSQL another server may be at work: there it is gone when it is a day old.
    const auto old = fs::file_time_type::clock::now() - std::chrono::hours(25);
    fs::last_write_time(path, old);
    fs::last_write_time(path.parent_path(), old);
  }
  ServerProcess server(world_.data);
  for (const fs::path& path : left) EXPECT_FALSE(fs::exists(path)) << path;
  EXPECT_EQ(server.stop(), 0);
}

constexpr std::size_t kBody_bytes = 48u << 20;

TEST_F(PrivateFiles, LargeBodiesAreNotKeptInMemory) {
  ServerProcess server(world_.data);
  Client client;
  client.speak_to(server.port());
  Headers admin = world_.admin(client);
  admin["Content-Type"] = "application/zip";
  const std::size_t before = server.peak_memory_bytes();
  std::vector<std::thread> senders;
  for (int i = 0; i < 4; ++i)
    senders.emplace_back([&] {
      Client own;
      own.speak_to(server.port());
      const std::string body = "PK" + std::string(kBody_bytes, 'x');
      const Answer answer = own.ask("POST", "/api/v1/lab/measurements?name=x", admin, body);
      EXPECT_EQ(answer.status, 400) << answer.body;
    });
  for (auto& sender : senders) sender.join();
  EXPECT_LT(server.peak_memory_bytes(), before + kBody_bytes) << "less than one of four bodies";
  EXPECT_EQ(files_awaited_in(world_.data / "scratch", 0), 0u);
  EXPECT_EQ(server.stop(), 0);
}

/// A request whose body never comes.
class Waiting {
 public:
  Waiting(int port, const Headers& headers, std::uint64_t announced)
      : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    const std::string head = text(headers, announced) + "PK";
    EXPECT_GT(::send(fd_, head.data(), head.size(), MSG_NOSIGNAL), 0);
  }
  ~Waiting() { ::close(fd_); }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
  static std::string text(const Headers& headers, std::uint64_t announced) {
    std::string out = "POST /api/v1/lab/measurements?name=x HTTP/1.1\r\nHost: 127.0.0.1\r\n";
    for (const auto& [name, value] : headers) out += name + ": " + value + "\r\n";
    return out + "Content-Length: " + std::to_string(announced) + "\r\n\r\n";
  }

 private:
  int fd_;
};

TEST_F(PrivateFiles, OneAccountCannotFillTheScratchFolder) {
  constexpr std::uint64_t kLargest = 256u
                                     << 20;  // of a measurement set; six are an account's limit
  ServerProcess server(world_.data);
  Client client;
  client.speak_to(server.port());
  const Headers admin = world_.admin(client);
  {
    std::vector<std::unique_ptr<Waiting>> held;
    for (int i = 0; i < 6; ++i)
      held.push_back(std::make_unique<Waiting>(server.port(), admin, kLargest));
    EXPECT_EQ(files_awaited_in(world_.data / "scratch", 6), 6u);
    const RawAnswer refused = send_raw(server.port(), Waiting::text(admin, kLargest), 3000);
    EXPECT_TRUE(refused.text.starts_with("HTTP/1.1 503")) << refused.text;
    EXPECT_NE(refused.text.find("your transfers in progress use"), std::string::npos)
        << refused.text;
  }
  EXPECT_EQ(files_awaited_in(world_.data / "scratch", 0), 0u) << "whoever hangs up leaves nothing";
  Headers whole = admin;
  whole["Content-Type"] = "application/zip";
  EXPECT_EQ(client.ask("POST", "/api/v1/lab/measurements?name=x", whole, "PKx").status, 400);
  EXPECT_EQ(server.stop(), 0);
}

}  // namespace
}  // namespace tractus
