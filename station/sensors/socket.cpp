#include "station/sensors/socket.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace tractus {
namespace sensors {
namespace {
constexpr int kConnect_ms = 5000;
constexpr int kHeld_bytes = 4 << 20;  // a second of the fastest sensor and more

/// Connects a socket that does not wait; the errno with which that failed, or 0.
int connected(int fd, const addrinfo& to) {
  if (::connect(fd, to.ai_addr, to.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  pollfd waiting{.fd = fd, .events = POLLOUT, .revents = 0};
  if (::poll(&waiting, 1, kConnect_ms) <= 0) return ETIMEDOUT;
  int failed = 0;
  socklen_t size = sizeof failed;
  ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &failed, &size);
  return failed;
}
}  // namespace

core::Result<Socket> Socket::connect(const std::string& who, const std::string& host, int port,
                                     Transport wire) {
  const auto refuse = [&](const char* why) {
    return core::Error{core::Errc::unavailable,
                       fmt::format("{} at {}:{}: {}", who, host, port, why)};
  };
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_socktype = wire == Transport::udp ? SOCK_DGRAM : SOCK_STREAM;
  if (const int failed = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found))
    return refuse(::gai_strerror(failed));
  int why = EHOSTUNREACH;
  for (const addrinfo* at = found; at; at = at->ai_next) {
    const int fd = ::socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0) continue;
    Socket out(fd);
    why = connected(fd, *at);
    if (why != 0) continue;
    ::setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &kHeld_bytes, sizeof kHeld_bytes);
    ::freeaddrinfo(found);
    return out;
  }
  ::freeaddrinfo(found);
  return refuse(std::strerror(why));
}

Socket::~Socket() {
  if (fd_ >= 0) ::close(fd_);
}

bool Socket::readable(int wait_ms) const noexcept {
  pollfd waiting{.fd = fd_, .events = POLLIN, .revents = 0};
  return ::poll(&waiting, 1, wait_ms) > 0;
}

}  // namespace sensors
}  // namespace tractus
