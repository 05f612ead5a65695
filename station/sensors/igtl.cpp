#include "station/sensors/igtl.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>

namespace sensors {
namespace {
using core::Errc;
using core::Error;
}  // namespace

core::Result<std::unique_ptr<IgtlStream>> IgtlStream::open(const std::string& host, int port) {
  auto socket = Socket::connect("motion capture", host, port, Wire::tcp);
  if (!socket) return socket.error();
  std::unique_ptr<IgtlStream> out(new IgtlStream(std::move(*socket)));
  for (const char* type : {"TDATA", "QTDATA"}) {
    const auto ask = igtl_request(type);
    static_cast<void>(::send(out->socket_.fd(), ask.data(), ask.size(), MSG_NOSIGNAL));
  }
  return out;
}

core::Result<std::optional<std::vector<TrackedPose>>> IgtlStream::held() {
  const auto rest = std::span(held_).subspan(taken_);
  if (rest.size() < kIgtlHeaderBytes) return std::optional<std::vector<TrackedPose>>();
  const auto header = parse_igtl_header(rest);
  if (!header || header->body_bytes > kIgtlMostBytes)
    return Error{Errc::bad_input, "what the motion capture sends is not OpenIGTLink"};
  const auto size = std::size_t(header->body_bytes);
  if (rest.size() < kIgtlHeaderBytes + size) return std::optional<std::vector<TrackedPose>>();
  taken_ += kIgtlHeaderBytes + size;
  const auto body = rest.subspan(kIgtlHeaderBytes, size);
  if (header->crc != crc64(body)) {
    ++damaged_;
    return std::optional(std::vector<TrackedPose>());
  }
  if (auto status = parse_igtl_status(*header, body); status && status->code != 1)
    complaint_ = std::move(status);
  return std::optional(parse_igtl_body(*header, body));
}

core::Result<std::vector<TrackedPose>> IgtlStream::next(int wait_ms) {
  for (;;) {
    auto message = held();
    if (!message) return message.error();
    if (*message && !(*message)->empty()) return std::move(**message);
    if (*message) continue;
    held_.erase(held_.begin(), held_.begin() + std::ptrdiff_t(taken_));
    taken_ = 0;
    if (!socket_.readable(wait_ms)) return std::vector<TrackedPose>();
    std::array<std::byte, 8192> chunk;
    const ssize_t size = ::recv(socket_.fd(), chunk.data(), chunk.size(), 0);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (size <= 0) return Error{Errc::unavailable, "the motion capture closed the connection"};
    held_.insert(held_.end(), chunk.begin(), chunk.begin() + size);
  }
}

}  // namespace sensors
