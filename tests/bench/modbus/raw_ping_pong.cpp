#include "bench/modbus/raw_ping_pong.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>
#include <vector>

namespace tractus {
namespace bench {
namespace {

bool take(int socket, std::vector<char>& bytes) {
  return ::recv(socket, bytes.data(), bytes.size(), MSG_WAITALL) == ssize_t(bytes.size());
}

class Pair final : public RawPingPong {
 public:
  Pair(int here, int there, int request_bytes, int reply_bytes)
      : here_(here), request_(std::size_t(request_bytes)), reply_(std::size_t(reply_bytes)) {
    thread_ = std::thread([there, request_bytes, reply_bytes] {
      std::vector<char> in(static_cast<std::size_t>(request_bytes));
      const std::vector<char> out(static_cast<std::size_t>(reply_bytes));
      while (take(there, in) && ::send(there, out.data(), out.size(), MSG_NOSIGNAL) > 0) {
      }
      ::close(there);
    });
  }
  ~Pair() override {
    ::close(here_);
    thread_.join();
  }
  int cycle() override {
    if (::send(here_, request_.data(), request_.size(), MSG_NOSIGNAL) < 0) return -1;
    return take(here_, reply_) ? int(reply_.size()) : -1;
  }

 private:
  int here_;
  std::vector<char> request_, reply_;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<RawPingPong> RawPingPong::open(int request_bytes, int reply_bytes) {
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0), here = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  auto* address = reinterpret_cast<sockaddr*>(&at);
  const bool joined = ::bind(listener, address, size) == 0 && ::listen(listener, 1) == 0 &&
                      ::getsockname(listener, address, &size) == 0 &&
                      ::connect(here, address, size) == 0;
  const int there = joined ? ::accept(listener, nullptr, nullptr) : -1;
  ::close(listener);
  if (there < 0) return nullptr;
  const int on = 1;
  for (const int socket : {here, there})
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return std::make_unique<Pair>(here, there, request_bytes, reply_bytes);
}

}  // namespace bench
}  // namespace tractus
