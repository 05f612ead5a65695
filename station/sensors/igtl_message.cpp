#include "station/sensors/igtl_message.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace tractus {
namespace sensors {
namespace {
using Bytes = std::span<const std::byte>;

constexpr std::size_t kTdataBytes = 70, kQtdataBytes = 50, kMatrixBytes = 48, kStatusBytes = 30;

template <class T>
T big(Bytes bytes, std::size_t at) {
  std::uint64_t out = 0;
  for (std::size_t k = 0; k < sizeof(T); ++k) out = out << 8 | std::uint64_t(bytes[at + k]);
  return static_cast<T>(out);
}

double real(Bytes bytes, std::size_t at) {
  return double(std::bit_cast<float>(big<std::uint32_t>(bytes, at)));
}

/// Text that ends with a zero or its field; what would break a line becomes '?'.
std::string text(Bytes bytes, std::size_t at, std::size_t most) {
  std::string out;
  for (std::size_t k = 0; k < most && bytes[at + k] != std::byte{0}; ++k) {
    const auto c = std::uint8_t(bytes[at + k]);
    out += c < 0x20 || c == 0x7f || c == ',' ? '?' : char(c);
  }
  return out;
}

/// Twelve floats: three columns of the turn, then the position in mm.
std::optional<math::Pose> matrix(Bytes bytes, std::size_t at) {
  std::array<double, 12> v{};
  for (std::size_t k = 0; k < 12; ++k) v[k] = real(bytes, at + 4 * k);
  math::Mat3 turn;
  turn << v[0], v[3], v[6], v[1], v[4], v[7], v[2], v[5], v[8];
  const math::Vec3 p = 1e-3 * math::Vec3(v[9], v[10], v[11]);
  const double off = (turn.transpose() * turn - math::Mat3::Identity()).norm();
  if (!p.allFinite() || !(off < 0.02) || !(turn.determinant() > 0.0)) return std::nullopt;
  return math::Pose{p, math::Quat(turn).normalized()};
}

/// Position in mm, then a quaternion x, y, z, w.
std::optional<math::Pose> quaternion(Bytes bytes, std::size_t at) {
  std::array<double, 7> v{};
  for (std::size_t k = 0; k < 7; ++k) v[k] = real(bytes, at + 4 * k);
  const math::Vec3 p = 1e-3 * math::Vec3(v[0], v[1], v[2]);
  const math::Quat q(v[6], v[3], v[4], v[5]);
  if (!p.allFinite() || !(std::abs(q.norm() - 1.0) < 0.01)) return std::nullopt;
  return math::Pose{p, q.normalized()};
}

/// A body from version 2 on may begin with an extended header and end with metadata: what lies
/// between.
Bytes content_of(const IgtlHeader& header, Bytes body, std::size_t each) {
  if (header.version < 2 || body.size() < 12) return body;
  const std::size_t extended = big<std::uint16_t>(body, 0);
  const std::size_t meta = std::size_t{big<std::uint16_t>(body, 2)} + big<std::uint32_t>(body, 4);
  if (extended < 12 || extended > body.size() || meta > body.size() - extended) return body;
  const Bytes content = body.subspan(extended, body.size() - extended - meta);
  return content.size() % each == 0 ? content : body;
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
}  // namespace

std::uint64_t crc64(Bytes bytes) noexcept {
  std::uint64_t crc = 0;
  for (const std::byte b : bytes) crc = kCrcTable[(crc >> 56 ^ std::uint64_t(b)) & 0xff] ^ crc << 8;
  return crc;
}

std::optional<IgtlHeader> parse_igtl_header(Bytes b) {
  if (b.size() < kIgtlHeaderBytes) return std::nullopt;
  IgtlHeader out;
  out.version = big<std::uint16_t>(b, 0);
  if (out.version < 1 || out.version > 3) return std::nullopt;
  out.type = text(b, 2, 12);
  out.device = text(b, 14, 20);
  out.stamp_s =
      double(big<std::uint32_t>(b, 34)) + double(big<std::uint32_t>(b, 38)) / 4294967296.0;
  out.body_bytes = big<std::uint64_t>(b, 42);
  out.crc = big<std::uint64_t>(b, 50);
  return out;
}

std::vector<TrackedPose> parse_igtl_body(const IgtlHeader& header, Bytes body) {
  std::vector<TrackedPose> out;
  const auto each = [&](std::size_t bytes, const auto& pose_of) {
    const Bytes content = content_of(header, body, bytes);
    for (std::size_t at = 0; at + bytes <= content.size(); at += bytes)
      if (const auto pose = pose_of(content, at + 22))
        out.push_back({text(content, at, 20), *pose, header.stamp_s});
  };
  if (header.type == "TDATA") each(kTdataBytes, matrix);
  if (header.type == "QTDATA") each(kQtdataBytes, quaternion);
  if (header.type == "TRANSFORM") {
    const Bytes content = content_of(header, body, kMatrixBytes);
    if (content.size() >= kMatrixBytes)
      if (const auto pose = matrix(content, 0))
        out.push_back({header.device, *pose, header.stamp_s});
  }
  return out;
}

std::optional<IgtlStatus> parse_igtl_status(const IgtlHeader& header, Bytes body) {
  if (header.type != "STATUS") return std::nullopt;
  const Bytes content = content_of(header, body, 1);
  if (content.size() < kStatusBytes) return std::nullopt;
  return IgtlStatus{.code = big<std::uint16_t>(content, 0),
                    .name = text(content, 10, 20),
                    .message = text(content, 30, std::min<std::size_t>(content.size() - 30, 200))};
}

std::vector<std::byte> igtl_request(std::string_view type) {
  constexpr std::size_t kBody = 36;  // resolution in ms, then a coordinate system's name: any
  std::vector<std::byte> out(kIgtlHeaderBytes + kBody);
  out[1] = std::byte{1};
  const std::string name = "STT_" + std::string(type);
  std::memcpy(&out[2], name.data(), std::min<std::size_t>(name.size(), 12));
  std::memcpy(&out[14], "tractus", 7);
  out[49] = std::byte{kBody};
  out[kIgtlHeaderBytes + 3] = std::byte{10};
  const std::uint64_t crc = crc64(std::span(out).subspan(kIgtlHeaderBytes));
  for (std::size_t k = 0; k < 8; ++k) out[50 + k] = std::byte(crc >> (56 - 8 * k));
  return out;
}

}  // namespace sensors
}  // namespace tractus
