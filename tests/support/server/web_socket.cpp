#include "tests/support/server/web_socket.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>

namespace tractus::world {
namespace {
constexpr std::array<std::byte, 4> kMask{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}};
}

long WebSocket::now_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

WebSocket::WebSocket(int port, const std::string& path, const Headers& headers)
    : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) return;
  const int on = 1;
  ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  std::string lines;
  for (const auto& [name, value] : headers)
    lines += (lines.empty() ? "" : "\r\n") + name + ": " + value;
  const std::string host = "127.0.0.1:" + std::to_string(port);
  if (!send_bytes(websocket_request(host, path, lines, "dGhlIHNhbXBsZSBub25jZQ=="))) return;
  std::string head;
  for (char c = 0; head.find("\r\n\r\n") == std::string::npos && ::recv(fd_, &c, 1, 0) == 1;)
    head += c;
  if (head.starts_with("HTTP/1.1 ")) status_ = std::stoi(head.substr(9, 3));
}

WebSocket::~WebSocket() {
  if (fd_ >= 0) ::close(fd_);
}

bool WebSocket::send_bytes(const std::string& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    pollfd ready{fd_, POLLOUT, 0};
    if (::poll(&ready, 1, 5000) <= 0) return false;
    const ssize_t n =
        ::send(fd_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n <= 0) return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

bool WebSocket::say(const std::string& text) {
  return send_bytes(websocket_frame(Opcode::text, text, kMask));
}

bool WebSocket::receive(int patience_ms) {
  pollfd ready{fd_, POLLIN, 0};
  if (::poll(&ready, 1, patience_ms) <= 0) return false;
  std::string piece(65536, '\0');
  const ssize_t n = ::recv(fd_, piece.data(), piece.size(), 0);
  if (n <= 0) return closed_ = true, false;
  piece.resize(static_cast<std::size_t>(n));
  reader_.add(piece);
  return true;
}

std::optional<core::Json> WebSocket::hear(int patience_ms) {
  const long until = now_ms() + patience_ms;
  while (!closed_) {
    auto event = reader_.next();
    if (!event) return closed_ = true, std::nullopt;
    if (!*event) {
      const long left = until - now_ms();
      if (left <= 0 || !receive(static_cast<int>(left))) return std::nullopt;
      continue;
    }
    const auto& [opcode, payload] = **event;
    if (opcode == Opcode::text) return core::Json::parse(payload, nullptr, false);
    if (opcode == Opcode::ping) send_bytes(websocket_frame(Opcode::pong, payload, kMask));
    if (opcode != Opcode::close) continue;
    closed_ = true;
    if (payload.size() >= 2)
      close_code_ =
          static_cast<unsigned char>(payload[0]) << 8 | static_cast<unsigned char>(payload[1]);
    close_words_ = payload.substr(std::min<std::size_t>(payload.size(), 2));
  }
  return std::nullopt;
}

Headers from_our_page(const Headers& signed_in, int port) {
  Headers out = signed_in;
  out["Origin"] = "http://127.0.0.1:" + std::to_string(port);
  return out;
}

}  // namespace tractus::world
