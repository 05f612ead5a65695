/// The station's end of the live line against a server of the test's own, which says bytes as it
/// likes.
#include "station/uplink/server_socket.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <thread>

#include "core/bytes.hpp"

namespace tractus {
namespace uplink {
namespace {
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (const int value : values) out.push_back(static_cast<char>(value));
  return out;
}

/// RFC 6455 section 4.2.2: the accept value of a key.
std::string accepted(const std::string& key) {
  const std::string text = key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
  std::array<std::byte, 20> digest{};
  EVP_Digest(text.data(), text.size(), reinterpret_cast<unsigned char*>(digest.data()), nullptr,
             EVP_sha1(), nullptr);
  return core::base64(digest);
}

/// Takes one connection, reads the request's head and does the rest in a thread.
class LocalServer {
 public:
  explicit LocalServer(std::function<void(LocalServer&)> then)
      : listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(listener_, 1), 0);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, then = std::move(then)] {
      fd_ = ::accept(listener_, nullptr, nullptr);
      while (head_.find("\r\n\r\n") == std::string::npos)
        if (const std::string more = hear(); more.empty())
          return;
        else
          head_ += more;
      then(*this);
    });
  }
  ~LocalServer() {
    ::shutdown(listener_, SHUT_RDWR);
    thread_.join();
    if (fd_ >= 0) ::close(fd_);
    ::close(listener_);
  }

  /// Or as much as the other side takes before it hangs up.
  void say(std::string_view what) const {
    for (ssize_t n = 1; !what.empty() && n > 0; what.remove_prefix(n > 0 ? std::size_t(n) : 0))
      n = ::send(fd_, what.data(), what.size(), MSG_NOSIGNAL);
  }
  std::string hear() const {
    std::string piece(65536, '\0');
    const ssize_t n = ::recv(fd_, piece.data(), piece.size(), 0);
    piece.resize(n > 0 ? std::size_t(n) : 0);
    return piece;
  }
  /// Until the other side closes the connection.
  void hear_out() const {
    while (!hear().empty()) {
    }
  }
  void accept_upgrade(const std::string& frames = "") const {
    const std::string name = "Sec-WebSocket-Key: ";
    const auto at = head_.find(name) + name.size();
    say("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Accept: " +
        accepted(head_.substr(at, head_.find('\r', at) - at)) + "\r\n\r\n" + frames);
  }
  const std::string& head() const { return head_; }
  int socket() const { return fd_; }
  ServerAddress address() const {
    return {.url = "http://127.0.0.1:" + std::to_string(port_),
            .headers = {{"Authorization", "Bearer t0ken"}}};
  }

 private:
  int listener_, fd_ = -1, port_ = 0;
  std::string head_;
  std::thread thread_;
};

const std::atomic<bool> kGoOn = false;

core::Result<std::unique_ptr<ServerSocket>> opened(const LocalServer& server) {
  return open_server_socket(server.address(), kGoOn);
}

/// What comes of a server that accepts, says these bytes and hears the rest.
core::Error end_after(const std::string& frames) {
  const LocalServer server([&](LocalServer& peer) {
    peer.accept_upgrade(frames);
    peer.hear_out();
  });
  auto line = opened(server);
  if (!line) return line.error();
  for (int i = 0; i < 10; ++i)
    if (auto heard = (*line)->receive(2000); !heard) return heard.error();
  return {core::Errc::cancelled, "the line goes on"};
}

TEST(ServerSocket, AsksWithItsTokenAndHearsTextsHoweverTheirBytesAreCut) {
  // RFC 6455 section 5.7: "Hello" in one frame, then in two fragments with a ping between them.
  const std::string all = bytes({0x81, 0x05, 'H', 'e', 'l', 'l', 'o', 0x01, 0x03, 'H', 'e', 'l',
                                 0x89, 0x05, 'H', 'e', 'l', 'l', 'o', 0x80, 0x02, 'l', 'o'});
  std::string head;
  for (const std::size_t piece : {all.size(), std::size_t{1}, std::size_t{4}}) {
    const LocalServer server([&](LocalServer& peer) {
      head = peer.head();
      peer.accept_upgrade(all.substr(0, piece));  // in one packet with the acceptance
      for (std::size_t at = piece; at < all.size(); at += piece) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        peer.say(all.substr(at, piece));
      }
      peer.hear_out();
    });
    auto line = opened(server);
    ASSERT_TRUE(line) << line.error().what;
    for (int i = 0; i < 2; ++i) {
      const auto heard = (*line)->receive(5000);
      ASSERT_TRUE(heard) << heard.error().what;
      EXPECT_EQ(*heard, "Hello");
    }
    const auto begun = Clock::now();
    const auto none = (*line)->receive(50);
    EXPECT_TRUE(none && !*none) << "patience is no error";
    EXPECT_GE(Clock::now() - begun, std::chrono::milliseconds(49));
  }
  EXPECT_THAT(head, testing::StartsWith("GET /api/v1/live/station HTTP/1.1\r\n"));
  EXPECT_THAT(head, HasSubstr("\r\nAuthorization: Bearer t0ken\r\n"));
}

TEST(ServerSocket, SaysMaskedTextsInOneFrameAndAnswersPings) {
  std::string heard;
  {
    const LocalServer server([&](LocalServer& peer) {
      peer.accept_upgrade(bytes({0x89, 0x02, 'h', 'i'}));
      for (std::string more = peer.hear(); !more.empty(); more = peer.hear()) heard += more;
    });
    auto line = opened(server);
    ASSERT_TRUE(line) << line.error().what;
    EXPECT_TRUE((*line)->receive(200));
    EXPECT_TRUE((*line)->send(std::string(9000, 'x')));
  }
  ASSERT_EQ(heard.size(), (2u + 4 + 2) + (2 + 2 + 4 + 9000) + (2 + 4 + 2));
  EXPECT_EQ(heard.substr(0, 2), bytes({0x8A, 0x82})) << "a pong, masked";
  EXPECT_EQ(char(heard[6] ^ heard[2]), 'h');
  EXPECT_EQ(heard.substr(8, 4), bytes({0x81, 0xFE, 9000 >> 8, 9000 & 0xFF})) << "one frame";
  EXPECT_EQ(char(heard[16] ^ heard[12]), 'x');
  EXPECT_EQ(heard.substr(8 + 8 + 9000, 2), bytes({0x88, 0x82})) << "a goodbye";
}

TEST(ServerSocket, RefusesWhatAServerMayNotSend) {
  for (const std::string& rubbish :
       {bytes({0x81, 0x85, 1, 2, 3, 4, 0, 0, 0, 0, 0}),  // masked
        bytes({0xC1, 0x01, 'x'}),                        // an extension's bit
        bytes({0x80, 0x01, 'x'}),                        // goes on with nothing
        bytes({0x09, 0x01, 'x'}),                        // a ping in pieces
        bytes({0x89, 0x7E, 0x00, 0x7E}),                 // a ping of 126 bytes
        bytes({0x82, 0x01, 'x'}),                        // binary
        bytes({0x81, 0x02, 0xc0, 0xaf}),                 // not UTF-8
        bytes({0x01, 0x01, 'x', 0x81, 0x01, 'y'})})      // begins anew within
    EXPECT_EQ(end_after(rubbish).code, core::Errc::bad_input) << core::hex(core::bytes_of(rubbish));
}

TEST(ServerSocket, DoesNotWaitForWhatIsTooLong) {
  const auto huge = end_after(bytes({0x81, 0x7F, 0x7F, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(huge.code, core::Errc::too_large) << huge.what;
  const auto over = end_after(bytes({0x81, 0x7F, 0, 0, 0, 0, 0, 1, 0, 1}));
  EXPECT_EQ(over.code, core::Errc::too_large) << over.what;
  // In fragments, each within the limit.
  const std::string half = bytes({0x7E, 0xC0, 0}) + std::string(0xC000, 'x');
  const auto sum = end_after(bytes({0x01}) + half + bytes({0x80}) + half);
  EXPECT_EQ(sum.code, core::Errc::too_large) << sum.what;
}

TEST(ServerSocket, TellsWhyTheServerClosedIt) {
  const auto said = end_after(bytes({0x88, 0x06, 0x03, 0xF0, 'g', 'o', '!', '\n'}));
  EXPECT_EQ(said.code, core::Errc::unavailable);
  EXPECT_EQ(said.what, "live line: the server closed it: go!?");
  EXPECT_EQ(end_after(bytes({0x88, 0x00})).what, "live line: the server closed it");
}

TEST(ServerSocket, IsGoneWithTheConnection) {
  const LocalServer server([](LocalServer& peer) {
    peer.accept_upgrade(bytes({0x81, 0x05, 'H'}));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    ::shutdown(peer.socket(), SHUT_WR);
    peer.hear_out();
  });
  auto line = opened(server);
  ASSERT_TRUE(line) << line.error().what;
  EXPECT_TRUE((*line)->receive(20)) << "half a message, and patience";
  const auto gone = (*line)->receive(5000);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, core::Errc::unavailable);
}

TEST(ServerSocket, TakesNoOtherAnswerForAnAcceptance) {
  struct Row {
    const char* answer;
    core::Errc code;
  };
  for (const auto& [answer, code] :
       {Row{"HTTP/1.1 401 Unauthorized\r\nContent-Length: 0\r\n\r\n", core::Errc::unauthorised},
        Row{"HTTP/1.1 403 Forbidden\r\nContent-Length: 0\r\n\r\n", core::Errc::forbidden},
        Row{"HTTP/1.1 429 Slow\r\nContent-Length: 0\r\n\r\n", core::Errc::unavailable},
        Row{"HTTP/1.1 503 Busy\r\nContent-Length: 0\r\n\r\n", core::Errc::unavailable},
        Row{"HTTP/1.1 302 There\r\nLocation: /\r\nContent-Length: 0\r\n\r\n",
            core::Errc::bad_input},
        Row{"HTTP/1.1 200 OK\r\nContent-Length: 0\r\n\r\n", core::Errc::bad_input},
        Row{"HTTP/1.1 abc\r\n\r\n", core::Errc::bad_input},
        Row{"HTTP/1.1 101 Yes\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            "Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n\r\n",  // of section 1.3's key
            core::Errc::bad_input},
        Row{"", core::Errc::unavailable}}) {
    const LocalServer server([said = std::string(answer)](LocalServer& peer) {
      if (!said.empty()) peer.say(said);
      ::shutdown(peer.socket(), SHUT_WR);
      peer.hear_out();
    });
    const auto refused = opened(server);
    ASSERT_FALSE(refused) << answer;
    EXPECT_EQ(refused.error().code, code) << answer << refused.error().what;
    EXPECT_THAT(refused.error().what, HasSubstr("live line: "));
  }
}

TEST(ServerSocket, ReadsNoMoreOfAnAnswerThanAHeadsWorth) {
  for (const std::string begun :
       {"HTTP/1.1 101 Yes\r\nX: ", "HTTP/1.1 200 OK\r\nContent-Length: 8000000\r\n\r\n"}) {
    const LocalServer server([&](LocalServer& peer) {
      peer.say(begun + std::string(100'000, 'x'));
      peer.hear_out();
    });
    const auto started = Clock::now();
    EXPECT_FALSE(opened(server));
    EXPECT_LT(Clock::now() - started, std::chrono::seconds(5)) << "not by the time-out";
  }
}

TEST(ServerSocket, StopsToWaitForAnAnswerWhenAsked) {
  std::atomic<bool> stopped = false;
  const LocalServer server([&](LocalServer& peer) {
    stopped = true;
    peer.hear_out();
  });
  const auto begun = Clock::now();
  EXPECT_FALSE(open_server_socket(server.address(), stopped));
  EXPECT_LT(Clock::now() - begun, std::chrono::seconds(5));
}

TEST(ServerSocket, GivesUpOnAServerThatDoesNotRead) {
  std::atomic<bool> over = false;
  const LocalServer server([&](LocalServer& peer) {
    peer.accept_upgrade();
    while (!over) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  });
  auto line = opened(server);
  ASSERT_TRUE(line) << line.error().what;
  const auto begun = Clock::now();
  core::Result<void> said;
  for (int i = 0; i < 1000 && said; ++i) said = (*line)->send(std::string(60'000, 'x'));
  EXPECT_LT(Clock::now() - begun, std::chrono::seconds(30));
  ASSERT_FALSE(said);
  EXPECT_EQ(said.error().code, core::Errc::unavailable);
  EXPECT_FALSE((*line)->send("more"));
  EXPECT_FALSE((*line)->receive(1));
  over = true;
}

}  // namespace
}  // namespace uplink
}  // namespace tractus
