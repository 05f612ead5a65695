/// A connected socket that closes itself; for what speaks to measuring devices.
#pragma once

#include <string>
#include <utility>

#include "core/result.hpp"

namespace tractus::sensors {

enum class Transport { udp, tcp };

class Socket {
 public:
  /// Connects, 5 s at most. Errors: unavailable, "WHO at HOST:PORT: why".
  static core::Result<Socket> connect(const std::string& who, const std::string& host, int port,
                                      Transport wire);
  ~Socket();
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket& operator=(Socket&&) = delete;
  int fd() const noexcept { return fd_; }
  /// Is there something to read within `wait_ms`?
  bool readable(int wait_ms) const noexcept;

 private:
  explicit Socket(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace tractus::sensors
