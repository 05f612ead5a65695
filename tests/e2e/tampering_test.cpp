/// What `verify` says after somebody who can write to the data folder and the database, but has not
/// the key, has changed them; and that it says nothing when nobody has.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <thread>

#include "core/bytes.hpp"
#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> out;
  for (std::string line; std::getline(file, line);) out.push_back(line);
  return out;
}

void write_lines(const fs::path& path, const std::vector<std::string>& lines) {
  std::ofstream file(path, std::ios::trunc);
  for (const std::string& line : lines) file << line << "\n";
}

/// The row of the trail that a line of audit.anchor notes.
std::string row_of(const std::string& line) { return line.substr(0, line.find(' ')); }

class Tampering : public ::testing::Test {
 protected:
  Tampering() {
    serve([](Client&, const Headers&) {});
    serve([this](Client& client, const Headers& admin) { add_account(client, admin, "tom"); });
  }

  void serve(const std::function<void(Client&, const Headers&)>& work,
             const std::vector<std::string>& more = {}) {
    ServerProcess server(world_.data, more);
    Client client;
    client.speak_to(server.port());
    Headers admin = world_.admin(client);
    admin["Content-Type"] = "application/json";
    work(client, admin);
    EXPECT_EQ(server.stop(), 0);
    said_ = server.output();
  }
  void add_account(Client& client, const Headers& admin, const std::string& name) {
    const Answer made = client.ask(
        "POST", "/api/v1/accounts", admin,
        core::Json{{"name", name}, {"role", "trainee"}, {"password", "a first password"}}.dump());
    EXPECT_EQ(made.status, 201) << made.body;
  }
  Ended server_does(const std::string& command, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{command, "--data", world_.data.string(), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program("tractus-server", arguments);
  }
  void expect_clean(const std::vector<std::string>& more = {}) {
    const Ended ended = server_does("verify", more);
    EXPECT_EQ(ended.code, 0) << ended.out;
  }
  void expect_found(const std::string& words, const std::vector<std::string>& more = {}) {
    const Ended ended = server_does("verify", more);
    EXPECT_EQ(ended.code, 1) << ended.out;
    EXPECT_NE(ended.out.find(words), std::string::npos) << ended.out;
  }
  void by_hand(const std::string& sql) {
    const auto database = world_.connection();
    ASSERT_TRUE(database && database->script(sql)) << sql;
  }
  const ServedWorld world_;
  const fs::path anchors_ = world_.data / "audit.anchor", high_ = world_.data / "audit.highwater";
  std::string said_;
};

TEST_F(Tampering, WhatNobodyTouchedIsClean) {
  expect_clean();
  const auto said = core::Json::parse(server_does("verify").out, nullptr, false);
  EXPECT_GT(said["covered_since_utc_us"].get<std::int64_t>(), 0);
  EXPECT_GE(said["anchors"].get<int>(), 3) << "init, two servers";
}

TEST_F(Tampering, RowsAndAnchorsThatWereCutOffTogetherAreMissed) {
  auto lines = lines_of(anchors_);
  ASSERT_GE(lines.size(), 2u);
  lines.pop_back();
  by_hand("delete from audit where number > " + row_of(lines.back()));
  by_hand("delete from accounts where name = 'tom'");
  write_lines(anchors_, lines);
  expect_found("it was cut, deleted or replaced by an older one");
}

TEST_F(Tampering, ADeletedAnchorFileIsMissed) {
  fs::remove(anchors_);
  expect_found("audit.anchor: ends with anchor 0");
}

TEST_F(Tampering, ADeletedHighWaterMarkIsMissed) {
  fs::remove(high_);
  expect_found("audit.highwater: is missing");
  fs::remove(anchors_);
  expect_found("audit.highwater: is missing");
}

TEST_F(Tampering, AnOlderAnchorFileIsSeen) {
  const auto old = lines_of(anchors_);
  serve([this](Client& client, const Headers& admin) { add_account(client, admin, "eve"); });
  write_lines(anchors_, old);
  expect_found("it was cut, deleted or replaced by an older one");
}

TEST_F(Tampering, AnAnchorIsNoHighWaterMark) {
  auto lines = lines_of(anchors_);
  lines.pop_back();
  write_lines(anchors_, lines);
  write_lines(high_, {lines.back()});
  expect_found("audit.highwater: was not written with this server's key");
}

TEST_F(Tampering, AChangedAnchorAndAMissingOneAreSeen) {
  const auto lines = lines_of(anchors_);
  auto changed = lines;
  changed[0][0] = '7';
  write_lines(anchors_, changed);
  expect_found("line 1: was not written with this server's key");
  changed = lines;
  changed.erase(changed.begin() + 1);
  write_lines(anchors_, changed);
  expect_found("anchor 2 is missing");
  write_lines(anchors_, lines);
  expect_clean();
}

TEST_F(Tampering, HalfALineOfACrashIsNotTampering) {
  std::ofstream(anchors_, std::ios::app) << "123 abc";
  expect_clean();
  serve([this](Client& client, const Headers& admin) { add_account(client, admin, "eve"); });
  expect_clean();
}

TEST_F(Tampering, AServerDoesNotHealWhatWasDone) {
  fs::remove(high_);
  serve([this](Client& client, const Headers& admin) { add_account(client, admin, "eve"); });
  EXPECT_NE(said_.find("audit.highwater: is missing"), std::string::npos) << said_;
  expect_found("audit.highwater: is missing");
  EXPECT_EQ(server_does("anchor").code, 0);
  expect_clean();
  serve([](Client& client, const Headers& admin) {
    const auto rows = client.ask("GET", "/api/v1/audit?limit=200", admin).json()["rows"];
    const bool noted =
        std::ranges::any_of(rows, [](const auto& row) { return row["what"] == "anchor"; });
    EXPECT_TRUE(noted) << "that the anchors began again is in the trail";
  });
}

TEST_F(Tampering, EditsOfWhatAccessRestsOnAreNamed) {
  by_hand("update accounts set role = 'admin' where name = 'tom'");
  expect_found("table accounts: row");
  by_hand("update accounts set role = 'trainee' where name = 'tom'");
  expect_clean();
  by_hand("update stations set revoked_utc_us = 1");
  expect_found("table stations: row");
}

/// The records of a folder from before rows were covered: the first start covers them.
TEST_F(Tampering, AnOldFolderIsCoveredFromItsFirstStartOn) {
  by_hand("delete from audit where number >= 1");
  fs::remove(anchors_);
  fs::remove(high_);
  expect_found("does not cover the rows of tables");
  serve([this](Client& client, const Headers& admin) { add_account(client, admin, "eve"); });
  EXPECT_NE(said_.find("covers_rows_of_tables"), std::string::npos) << said_;
  expect_clean();
}

TEST_F(Tampering, ACopyElsewhereShowsThatEverythingWasPutBack) {
  const auto anchors = lines_of(anchors_), high = lines_of(high_);
  const std::string last = row_of(anchors.back());
  const fs::path copy = world_.folder / "elsewhere";
  serve([this](Client& client, const Headers& admin) { add_account(client, admin, "eve"); },
        {"--anchors-to", copy});
  expect_clean({"--anchors", copy});
  by_hand("delete from audit where number > " + last);
  by_hand("delete from accounts where name = 'eve'");
  write_lines(anchors_, anchors);
  write_lines(high_, high);
  expect_clean();  // the very state of then: nothing here can tell
  expect_found("the newest rows were cut off", {"--anchors", copy});
}

TEST_F(Tampering, AnchorsWaitForAPlaceThatIsAway) {
  const fs::path disk = world_.folder / "disk", copy = disk / "anchors";
  fs::create_directories(disk);
  {
    ServerProcess server(world_.data, {"--anchors-to", copy});
    fs::rename(disk, world_.folder / "taken away");  // at once: the server may be writing
    Client client;
    client.speak_to(server.port());
    world_.admin(client);
    fs::create_directories(disk);
    EXPECT_EQ(server.stop(), 0);
  }
  expect_clean({"--anchors", copy});
}

/// Answers 500 to the first request, 200 to those after it, and keeps what they said.
class Collector {
 public:
  Collector() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::listen(listener_, 8), 0);
    socklen_t size = sizeof address;
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { take_all(); });
  }
  ~Collector() { stop(); }
  Collector(const Collector&) = delete;
  Collector& operator=(const Collector&) = delete;
  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/anchors"; }
  int requests() const { return requests_; }
  /// Bodies of requests that were answered 200, as "anchor=…".
  std::vector<std::string> stop() {
    ::shutdown(listener_, SHUT_RDWR);
    if (thread_.joinable()) thread_.join();
    ::close(std::exchange(listener_, -1));
    return taken_;
  }

 private:
  void take_all() {
    for (int fd = 0; (fd = ::accept(listener_, nullptr, nullptr)) >= 0; ::close(fd)) take_one(fd);
  }
  void take_one(int fd) {
    std::string text, piece(4096, 0);
    std::size_t end = std::string::npos;
    while (end == std::string::npos || text.size() < end + 4 + body_size(text)) {
      const ssize_t n = ::recv(fd, piece.data(), piece.size(), 0);
      if (n <= 0) return;
      text.append(piece, 0, static_cast<std::size_t>(n));
      end = text.find("\r\n\r\n");
    }
    const bool first = requests_++ == 0;
    if (!first) taken_.push_back(text.substr(end + 4));
    const std::string answer = std::string("HTTP/1.1 ") + (first ? "500 No" : "200 OK") +
                               "\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    ::send(fd, answer.data(), answer.size(), MSG_NOSIGNAL);
  }
  static std::size_t body_size(const std::string& text) {
    const auto at = text.find("Content-Length: ");
    return at == std::string::npos ? 0 : std::stoul(text.substr(at + 16));
  }
  int listener_;
  int port_ = 0;
  std::atomic<int> requests_ = 0;
  std::vector<std::string> taken_;
  std::thread thread_;
};

TEST_F(Tampering, AnchorsAreSentByHttpUntilTheyAreTaken) {
  Collector collector;
  {
    ServerProcess server(world_.data, {"--anchors-to", collector.url()});
    for (int tries = 0; tries < 200 && collector.requests() == 0; ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    EXPECT_EQ(server.stop(), 0);
  }
  const auto taken = collector.stop();
  ASSERT_GE(taken.size(), 1u);
  std::string last = lines_of(anchors_).back();
  std::ranges::replace(last, ' ', '+');  // no letter of an anchor is escaped but the space
  std::string sent = taken.back();
  for (std::size_t at = 0; (at = sent.find("%20")) != std::string::npos;) sent.replace(at, 3, "+");
  EXPECT_EQ(sent, "anchor=" + last);
}

TEST_F(Tampering, APlaceThatIsNoneIsRefused) {
  for (const std::string place : {"relative", "/no/such/folder/anchors", "http://example.org/"}) {
    const Ended ended = server_does("serve", {"--anchors-to", place});
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.out.find("--anchors-to"), std::string::npos) << ended.out;
  }
}

TEST_F(Tampering, ARestoredBackupIsClean) {
  const fs::path backup = world_.folder / "backup", again = world_.folder / "again";
  serve([&](Client& client, const Headers& admin) {
    add_account(client, admin, "eve");
    EXPECT_EQ(server_does("backup", {"--out", backup}).code, 0);
    add_account(client, admin, "dan");
  });
  const Ended put_back =
      run_program("tractus-server", {"restore", "--from", backup, "--data", again, "--json"});
  EXPECT_EQ(put_back.code, 0) << put_back.out;
  const Ended verified = run_program("tractus-server", {"verify", "--data", again, "--json"});
  EXPECT_EQ(verified.code, 0) << verified.out;
}

TEST_F(Tampering, AServerThatWasKilledIsClean) {
  for (int i = 0; i < 5; ++i) {
    ServerProcess server(world_.data);
    Client client;
    client.speak_to(server.port());
    Headers admin = world_.admin(client);
    admin["Content-Type"] = "application/json";
    add_account(client, admin, "trainee " + std::to_string(i));
    server.kill_now();
    expect_clean();
  }
}

}  // namespace
}  // namespace tractus
