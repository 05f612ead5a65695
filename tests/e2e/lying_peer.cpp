#include "tests/e2e/lying_peer.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <random>

namespace tractus {
namespace lying {
namespace {

namespace registers = devices::rig;

constexpr int kIdle_ms = 100;

int connected_to(int port) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
  const int on = 1;
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return fd;
}

bool send_all(int fd, std::span<const std::uint8_t> bytes) {
  return ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL) == ssize_t(bytes.size());
}

rig::World with_surgeon() {
  rig::World world;
  world.surgeon = true;
  return world;
}

}  // namespace

Peer::Peer(Lie lie, int honest) : lie_(lie), honest_(std::uint64_t(honest)) {
  const sched_param urgent{.sched_priority = 70};  // as the program does; inherited by its threads
  const sched_param before{};
  static_cast<void>(pthread_setschedparam(pthread_self(), SCHED_FIFO, &urgent));
  electronics_ =
      std::make_unique<rig::Electronics>(rig::MachineParameters{}, with_surgeon(), clock_);
  auto made = rig::listen_tcp(*electronics_, traffic_, "127.0.0.1", 0);
  EXPECT_TRUE(made);
  real_ = std::move(*made);
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::bind(listener_, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  EXPECT_EQ(::listen(listener_, 4), 0);
  socklen_t size = sizeof at;
  ::getsockname(listener_, reinterpret_cast<sockaddr*>(&at), &size);
  port_ = ntohs(at.sin_port);
  thread_ = std::jthread([this](std::stop_token stop) { serve(std::move(stop)); });
  static_cast<void>(pthread_setschedparam(pthread_self(), SCHED_OTHER, &before));
}

Peer::~Peer() {
  thread_ = {};
  ::close(listener_);
}

void Peer::serve(std::stop_token stop) {
  while (!stop.stop_requested()) {
    pollfd waiting{listener_, POLLIN, 0};
    if (::poll(&waiting, 1, kIdle_ms) <= 0) continue;
    const int client = ::accept(listener_, nullptr, nullptr);
    if (client < 0) continue;
    const int on = 1;
    ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    serve_client(stop, client);
    ::close(client);
  }
}

void Peer::serve_client(const std::stop_token& stop, int client) {
  const int machine = connected_to(true_port());
  std::array<std::uint8_t, 512> bytes{};
  while (!stop.stop_requested()) {
    pollfd waiting{client, POLLIN, 0};
    if (::poll(&waiting, 1, kIdle_ms) <= 0) continue;
    const ssize_t asked = ::recv(client, bytes.data(), bytes.size(), 0);
    if (asked <= 0) break;
    if (answered_ >= honest_ && lie_ == Lie::silence) continue;
    if (!send_all(machine, {bytes.data(), std::size_t(asked)})) break;
    const ssize_t size = ::recv(machine, bytes.data(), bytes.size(), 0);
    if (size <= 0) break;
    const std::span answer(bytes.data(), std::size_t(size));
    if (answered_ >= honest_ && lie_ != Lie::none) {
      if (!lie(client, answer)) break;
      continue;
    }
    if (size > 16) {
      const auto* at = &bytes[9 + 2 * (registers::kTime_100us - registers::kReadingStart)];
      last_honest_s_ = 1e-4 * double(unsigned(at[0]) << 24 | unsigned(at[1]) << 16 |
                                     unsigned(at[2]) << 8 | unsigned(at[3]));
    }
    if (!send_all(client, answer)) break;
    ++answered_;
  }
  ::close(machine);
}

bool Peer::lie(int client, std::span<std::uint8_t> answer) {
  static std::mt19937 random(9);
  switch (lie_) {
    case Lie::rubbish:
      for (auto& byte : answer) byte = static_cast<std::uint8_t>(random());
      return send_all(client, answer);
    case Lie::exception:
      answer[4] = 0, answer[5] = 3, answer[7] |= 0x80, answer[8] = 4;
      return send_all(client, answer.first(9));
    case Lie::late:
      ::poll(nullptr, 0, 30);
      return send_all(client, answer);
    case Lie::absurd:
      answer[9 + 2 * (registers::kPosition_um - registers::kReadingStart)] = 0x77;
      return send_all(client, answer);
    case Lie::none:
    case Lie::silence:
      return true;
    case Lie::hang_up:
      return false;
  }
  return false;
}

}  // namespace lying
}  // namespace tractus
