/// Motion capture over OpenIGTLink: messages TRANSFORM and TDATA.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "math/geometry.hpp"

namespace sensors {

/// A tracked body in the capture system's frame C.
struct TrackedPose {
  std::string body;
  math::Pose X_CB;
  double stamp_s = 0.0;  ///< the sender's clock; 0: it did not say
};

/// The header of version 1 and 2, 58 bytes, big-endian: version, type, device, time, size, CRC-64
/// of the body.
struct IgtlHeader {
  std::string type, device;
  double stamp_s = 0.0;
  std::uint64_t body_bytes = 0, crc = 0;
};
inline constexpr std::size_t kIgtlHeaderBytes = 58;
inline constexpr std::uint64_t kIgtlMostBytes = 1 << 20;

std::optional<IgtlHeader> parse_igtl_header(std::span<const std::byte> bytes);
/// CRC-64 of ECMA-182 (polynomial 42F0E1EBA9EA3693, from 0, most significant bit first).
std::uint64_t crc64(std::span<const std::byte> bytes) noexcept;
/// The poses in a body, by its header: TRANSFORM (one, named by the device) or TDATA (each named).
/// Matrices are twelve floats by columns, mm. Empty for another type, a body that is cut, or a
/// matrix that is no turn.
std::vector<TrackedPose> parse_igtl_body(const IgtlHeader& header, std::span<const std::byte> body);

/// A connection to a server that sends (Plus, QTM's and Motive's bridges do).
class IgtlStream {
 public:
  static constexpr int kPort = 18944;
  /// Connects and asks for TDATA (a server that only pushes TRANSFORM ignores that). Errors:
  /// unavailable naming host and port.
  static core::Result<std::unique_ptr<IgtlStream>> open(const std::string& host, int port = kPort);
  ~IgtlStream();
  IgtlStream(const IgtlStream&) = delete;
  IgtlStream& operator=(const IgtlStream&) = delete;

  /// The poses of the next message; empty after `wait_ms` without one. Errors: unavailable
  /// (closed), bad_input (not OpenIGTLink, or too large a message).
  core::Result<std::vector<TrackedPose>> next(int wait_ms);
  std::uint64_t damaged() const noexcept { return damaged_; }  ///< messages whose CRC was wrong

 private:
  explicit IgtlStream(int fd) : fd_(fd) {}
  int fd_;
  std::vector<std::byte> held_;
  std::uint64_t damaged_ = 0;
};

}  // namespace sensors
