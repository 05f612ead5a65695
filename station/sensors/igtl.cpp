#include "station/sensors/igtl.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace sensors {
namespace {
using core::Errc;
using core::Error;

constexpr std::size_t kTdataBytes = 70, kMatrixBytes = 48;

template <class T>
T big(std::span<const std::byte> bytes, std::size_t at) {
  T out = 0;
  for (std::size_t k = 0; k < sizeof(T); ++k) out = T(out << 8 | T(bytes[at + k]));
  return out;
}

std::string text(std::span<const std::byte> bytes, std::size_t at, std::size_t most) {
  std::string out;
  for (std::size_t k = 0; k < most && bytes[at + k] != std::byte{0}; ++k)
    out += char(bytes[at + k]);
  return out;
}

/// Twelve floats: three columns of the turn, then the position in mm.
std::optional<math::Pose> matrix(std::span<const std::byte> bytes, std::size_t at) {
  std::array<double, 12> v{};
  for (std::size_t k = 0; k < 12; ++k)
    v[k] = double(std::bit_cast<float>(big<std::uint32_t>(bytes, at + 4 * k)));
  math::Mat3 turn;
  turn << v[0], v[3], v[6], v[1], v[4], v[7], v[2], v[5], v[8];
  const math::Vec3 p = 1e-3 * math::Vec3(v[9], v[10], v[11]);
  if (!p.allFinite() || !(std::abs(turn.determinant() - 1.0) < 0.01)) return std::nullopt;
  return math::Pose{p, math::Quat(turn).normalized()};
}

constexpr std::array<std::uint64_t, 256> kCrcTable = [] {
  std::array<std::uint64_t, 256> out{};
  for (std::uint64_t k = 0; k < 256; ++k) {
    std::uint64_t crc = k << 56;
    for (int bit = 0; bit < 8; ++bit)
      crc = crc & (1ull << 63) ? (crc << 1) ^ 0x42F0E1EBA9EA3693ull : crc << 1;
    out[k] = crc;
  }
  return out;
}();

/// STT_TDATA: "send tracking data", 50 times a second at least, any coordinate system.
std::array<std::byte, kIgtlHeaderBytes + 36> start_tracking() {
  std::array<std::byte, kIgtlHeaderBytes + 36> out{};
  out[1] = std::byte{1};
  std::memcpy(&out[2], "STT_TDATA", 9);
  std::memcpy(&out[14], "tractus", 7);
  out[49] = std::byte{36};
  out[kIgtlHeaderBytes + 3] = std::byte{10};  // ms
  const std::uint64_t crc = crc64(std::span(out).subspan(kIgtlHeaderBytes));
  for (std::size_t k = 0; k < 8; ++k) out[50 + k] = std::byte(crc >> (56 - 8 * k));
  return out;
}
}  // namespace

std::uint64_t crc64(std::span<const std::byte> bytes) noexcept {
  std::uint64_t crc = 0;
  for (const std::byte b : bytes) crc = kCrcTable[(crc >> 56 ^ std::uint64_t(b)) & 0xff] ^ crc << 8;
  return crc;
}

std::optional<IgtlHeader> parse_igtl_header(std::span<const std::byte> b) {
  if (b.size() < kIgtlHeaderBytes) return std::nullopt;
  const auto version = big<std::uint16_t>(b, 0);
  if (version < 1 || version > 2) return std::nullopt;
  IgtlHeader out{.type = text(b, 2, 12), .device = text(b, 14, 20)};
  out.stamp_s =
      double(big<std::uint32_t>(b, 34)) + double(big<std::uint32_t>(b, 38)) / 4294967296.0;
  out.body_bytes = big<std::uint64_t>(b, 42);
  out.crc = big<std::uint64_t>(b, 50);
  return out;
}

std::vector<TrackedPose> parse_igtl_body(const IgtlHeader& header,
                                         std::span<const std::byte> body) {
  std::vector<TrackedPose> out;
  if (header.type == "TRANSFORM" && body.size() >= kMatrixBytes)
    if (const auto pose = matrix(body, 0)) out.push_back({header.device, *pose, header.stamp_s});
  if (header.type == "TDATA")
    for (std::size_t at = 0; at + kTdataBytes <= body.size(); at += kTdataBytes)
      if (const auto pose = matrix(body, at + 22))
        out.push_back({text(body, at, 20), *pose, header.stamp_s});
  return out;
}

core::Result<std::unique_ptr<IgtlStream>> IgtlStream::open(const std::string& host, int port) {
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_socktype = SOCK_STREAM;
  const auto refuse = [&](const char* why) {
    return Error{Errc::unavailable, fmt::format("motion capture at {}:{}: {}", host, port, why)};
  };
  if (const int failed = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found))
    return refuse(::gai_strerror(failed));
  const int fd = ::socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool connected = fd >= 0 && ::connect(fd, found->ai_addr, found->ai_addrlen) == 0;
  const char* why = std::strerror(errno);
  ::freeaddrinfo(found);
  if (!connected) {
    if (fd >= 0) ::close(fd);
    return refuse(why);
  }
  std::unique_ptr<IgtlStream> out(new IgtlStream(fd));
  const auto ask = start_tracking();
  static_cast<void>(::send(fd, ask.data(), ask.size(), MSG_NOSIGNAL));
  return out;
}

IgtlStream::~IgtlStream() { ::close(fd_); }

core::Result<std::vector<TrackedPose>> IgtlStream::next(int wait_ms) {
  for (;;) {
    if (held_.size() >= kIgtlHeaderBytes) {
      const auto header = parse_igtl_header(held_);
      if (!header || header->body_bytes > kIgtlMostBytes)
        return Error{Errc::bad_input, "what the motion capture sends is not OpenIGTLink"};
      const std::size_t whole = kIgtlHeaderBytes + std::size_t(header->body_bytes);
      if (held_.size() >= whole) {
        const auto body = std::span(held_).subspan(kIgtlHeaderBytes, whole - kIgtlHeaderBytes);
        const bool sound = header->crc == crc64(body);
        damaged_ += !sound;
        auto poses = sound ? parse_igtl_body(*header, body) : std::vector<TrackedPose>();
        held_.erase(held_.begin(), held_.begin() + std::ptrdiff_t(whole));
        if (poses.empty()) continue;
        return poses;
      }
    }
    pollfd waiting{.fd = fd_, .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, wait_ms) <= 0) return std::vector<TrackedPose>();
    std::array<std::byte, 8192> chunk;
    const ssize_t size = ::recv(fd_, chunk.data(), chunk.size(), 0);
    if (size <= 0) return Error{Errc::unavailable, "the motion capture closed the connection"};
    held_.insert(held_.end(), chunk.begin(), chunk.begin() + size);
  }
}

}  // namespace sensors
