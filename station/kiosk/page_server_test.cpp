/// Who the kiosk's page server lets in. Requests are written by hand, byte for byte.
#include "station/kiosk/page_server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/bytes.hpp"

namespace tractus::kiosk {
namespace {
namespace fs = std::filesystem;

class KioskPageServer : public ::testing::Test {
 protected:
  void SetUp() override {
    web_ = fs::temp_directory_path() / ("kiosk-page-" + core::new_id());
    fs::create_directories(web_);
    std::ofstream(web_ / "kiosk.html") << "<p>kiosk</p>";
    auto opened = PageServer::open(desk_, web_, 0);
    ASSERT_TRUE(opened) << opened.error().what;
    pages_ = std::move(*opened);
    host_ = "127.0.0.1:" + std::to_string(pages_->port());
    secret_ = pages_->address().substr(pages_->address().find('#') + 1);
  }
  void TearDown() override { fs::remove_all(web_); }

  /// The status of the answer; 0 when there is none.
  int status(const std::string& target, const std::string& host, const std::string& more) const {
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(pages_->port());
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) return 0;
    const std::string text =
        "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n";
    EXPECT_EQ(::send(fd, text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
    char answer[16] = {};
    const ssize_t got = ::recv(fd, answer, sizeof answer - 1, MSG_WAITALL);
    ::close(fd);
    return got >= 12 ? std::stoi(std::string(answer + 9, 3)) : 0;
  }
  int socket_status(const std::string& key, const std::string& origin) const {
    return status("/kiosk/live?key=" + key, host_,
                  "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                  "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                      (origin.empty() ? "" : "Origin: " + origin + "\r\n"));
  }

  core::MonotonicClock clock_;
  Desk desk_{clock_, Machine(true)};
  fs::path web_;
  std::unique_ptr<PageServer> pages_;
  std::string host_, secret_;
};

TEST_F(KioskPageServer, ServesItsPageByItsOwnNameAlone) {
  EXPECT_EQ(status("/kiosk.html", host_, ""), 200);
  EXPECT_EQ(status("/kiosk.html", "kiosk.attacker.example", ""), 403);
  EXPECT_EQ(status("/kiosk.html", "localhost:" + std::to_string(pages_->port()), ""), 403);
  EXPECT_EQ(status("/kiosk.html", host_, "Origin: http://attacker.example\r\n"), 403);
}

TEST_F(KioskPageServer, OpensTheWebSocketForTheSecretAndItsOwnPageAlone) {
  const std::string own = "http://" + host_;
  EXPECT_EQ(secret_.size(), 64u) << "32 random bytes in hexadecimal";
  EXPECT_EQ(socket_status(secret_, own), 101);
  EXPECT_EQ(socket_status(secret_, "http://attacker.example"), 403);
  EXPECT_EQ(socket_status(secret_, ""), 403);
  EXPECT_EQ(socket_status("", own), 403);
  EXPECT_EQ(socket_status(std::string(64, '0'), own), 403);
}

TEST_F(KioskPageServer, HasANewSecretAtEachStart) {
  auto second = PageServer::open(desk_, web_, 0);
  ASSERT_TRUE(second) << second.error().what;
  EXPECT_EQ((*second)->address().find(secret_), std::string::npos);
}

TEST_F(KioskPageServer, SaysWhichFolderHasNoPage) {
  const auto refused = PageServer::open(desk_, web_ / "none", 0);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find((web_ / "none").string()), std::string::npos);
}

}  // namespace
}  // namespace tractus::kiosk
