#include "station/sensors/igtl.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "core/try.hpp"

namespace tractus {
namespace sensors {
namespace {
using core::Errc;
using core::Error;
}  // namespace

core::Result<std::unique_ptr<IgtlStream>> IgtlStream::open(const std::string& host, int port) {
  auto socket = TRY(Socket::connect("motion capture", host, port, Transport::tcp));
  std::unique_ptr<IgtlStream> out(new IgtlStream(std::move(socket)));
  for (const char* type : {"TDATA", "QTDATA"}) {
    const auto ask = igtl_request(type);
    static_cast<void>(::send(out->socket_.fd(), ask.data(), ask.size(), MSG_NOSIGNAL));
  }
  return out;
}

core::Result<std::vector<TrackedPose>> IgtlStream::next(int wait_ms) {
  for (;;) {
    auto message = TRY(reader_.next());
    if (message) return std::move(*message);
    if (!socket_.readable(wait_ms)) return std::vector<TrackedPose>();
    std::array<std::byte, 65536> chunk;
    const ssize_t size = ::recv(socket_.fd(), chunk.data(), chunk.size(), 0);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (size <= 0) return Error{Errc::unavailable, "the motion capture closed the connection"};
    received_ += std::uint64_t(size);
    reader_.add(std::span(chunk.data(), std::size_t(size)));
    if (reader_.passing()) return std::vector<TrackedPose>();
  }
}

}  // namespace sensors
}  // namespace tractus
