#include "station/sensors/igtl_sender.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>

#include "station/sensors/igtl_message.hpp"

namespace tractus {
namespace sensors {
namespace {

using Message = std::vector<std::byte>;
constexpr auto kBetween = std::chrono::nanoseconds(1'000'000'000 / IgtlSender::kRate_Hz);
const math::Mat3 kRasOfLps = math::Vec3(-1, -1, 1).asDiagonal();

/// Big-endian.
template <class T>
void put(Message& out, T value) {
  for (int shift = 8 * (int(sizeof(T)) - 1); shift >= 0; shift -= 8)
    out.push_back(static_cast<std::byte>(value >> shift & 0xff));
}

void put_text(Message& out, const std::string& text, std::size_t field) {
  for (std::size_t k = 0; k < field; ++k) out.push_back(std::byte(k < text.size() ? text[k] : 0));
}

Message message(const char* type, const std::string& device, double stamp_s, const Message& body) {
  Message out;
  out.reserve(kIgtlHeaderBytes + body.size());
  put(out, std::uint16_t{1});
  put_text(out, type, 12);
  put_text(out, device, 20);
  const double whole_s = std::floor(stamp_s);
  put(out, static_cast<std::uint32_t>(whole_s));
  put(out, static_cast<std::uint32_t>((stamp_s - whole_s) * 4294967296.0));
  put(out, std::uint64_t(body.size()));
  put(out, crc64(body));
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

core::Error refused(const std::string& address, int port, const char* why) {
  return {core::Errc::unavailable,
          fmt::format("OpenIGTLink at {}:{}: cannot listen: {}", address, port, why)};
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

Message igtl_transform(const std::string& device, const math::Pose& pose, double stamp_s) {
  const math::Mat3 turn = kRasOfLps * pose.q.toRotationMatrix();
  const math::Vec3 at_mm = kRasOfLps * pose.p * 1e3;
  Message body;
  const auto put_column = [&body](const math::Vec3& column) {
    for (const double v : column) put(body, std::bit_cast<std::uint32_t>(float(v)));
  };
  for (int c = 0; c < 3; ++c) put_column(turn.col(c));
  put_column(at_mm);
  return message("TRANSFORM", device, stamp_s, body);
}

Message igtl_sensor(const std::string& device, const math::Vec3& value_lps, IgtlUnit unit,
                    double stamp_s) {
  Message body = {std::byte{3}, std::byte{0}};  // values, and a status that is reserved
  put(body, static_cast<std::uint64_t>(unit));
  for (const double v : math::Vec3(kRasOfLps * value_lps))
    put(body, std::bit_cast<std::uint64_t>(v));
  return message("SENSOR", device, stamp_s, body);
}

core::Result<std::unique_ptr<IgtlSender>> IgtlSender::start(const std::string& address, int port,
                                                            Latest latest) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  if (::inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1)
    return refused(address, port, "an IPv4 address is expected");
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return refused(address, port, std::strerror(errno));
  const int yes = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  socklen_t size = sizeof at;
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&at), size) != 0 ||
      ::listen(fd, kMostListeners) != 0 ||
      ::getsockname(fd, reinterpret_cast<sockaddr*>(&at), &size) != 0) {
    const core::Error why = refused(address, port, std::strerror(errno));
    ::close(fd);
    return why;
  }
  return std::unique_ptr<IgtlSender>(new IgtlSender(fd, ntohs(at.sin_port), std::move(latest)));
}

IgtlSender::IgtlSender(int fd, int port, Latest latest)
    : fd_(fd),
      port_(port),
      latest_(std::move(latest)),
      thread_([this](std::stop_token stop) { run(std::move(stop)); }) {}

IgtlSender::~IgtlSender() {
  thread_.request_stop();
  thread_.join();
  for (const Listener& listener : listeners_) ::close(listener.fd);
  ::close(fd_);
}

void IgtlSender::run(std::stop_token stop) {
  auto next = std::chrono::steady_clock::now();
  while (!stop.stop_requested()) {
    accept();
    if (const auto moment = latest_()) {
      const double stamp_s = now_s();
      send(igtl_transform("TractusTip", moment->X_VT, stamp_s));
      send(igtl_sensor("TractusForce", moment->force_N, IgtlUnit::newton, stamp_s));
      send(igtl_sensor("TractusTorque", moment->torque_Nm, IgtlUnit::newton_metre, stamp_s));
    }
    next += kBetween;
    std::this_thread::sleep_until(next);
  }
}

void IgtlSender::accept() {
  for (;;) {
    const int fd = ::accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (fd < 0) return;
    if (listeners_.size() >= std::size_t(kMostListeners)) {
      ::close(fd);
      continue;
    }
    const int yes = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    listeners_.push_back({fd, {}});
  }
}

bool IgtlSender::is_open(const Listener& listener) {
  std::array<std::byte, 4096> ignored;
  for (int reads = 0; reads < 16; ++reads) {
    const auto got = ::recv(listener.fd, ignored.data(), ignored.size(), 0);
    if (got == 0) return false;
    if (got < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
  }
  return true;
}

bool IgtlSender::send(Listener& to, std::span<const std::byte> message) {
  if (!is_open(to)) return false;
  const bool behind = !to.rest.empty();
  const std::span<const std::byte> bytes = behind ? std::span<const std::byte>(to.rest) : message;
  const auto sent = ::send(to.fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
  if (behind)
    to.rest.erase(to.rest.begin(), to.rest.begin() + sent);
  else
    to.rest.assign(message.begin() + sent, message.end());
  return true;
}

void IgtlSender::send(std::span<const std::byte> message) {
  std::erase_if(listeners_, [&](Listener& listener) {
    if (send(listener, message)) return false;
    ::close(listener.fd);
    return true;
  });
}

}  // namespace sensors
}  // namespace tractus
