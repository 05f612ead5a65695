/// OpenIGTLink's bytes: a header of 58, then what the type says, big-endian, lengths in mm, as
/// openigtlink.org documents them. Versions 1 and 2 of the header (the protocol's version 3 has 2
/// there), and 3, which some senders write instead.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/geometry.hpp"

namespace tractus::sensors {

/// A tracked body in the capture system's frame C.
struct TrackedPose {
  std::string body;
  math::Pose X_CB;
  double stamp_s = 0.0;  ///< the sender's clock; 0: it did not say
};

struct IgtlHeader {
  int version = 1;
  std::string type, device;
  double stamp_s = 0.0;
  std::uint64_t body_bytes = 0, crc = 0;
};
inline constexpr std::size_t kIgtlHeaderBytes = 58;
inline constexpr std::uint64_t kIgtlMostBytes = 1 << 20;

/// Nothing when it is none: too short, another version.
std::optional<IgtlHeader> parse_igtl_header(std::span<const std::byte> bytes);
/// CRC-64 of ECMA-182 (polynomial 42F0E1EBA9EA3693, from 0, most significant bit first).
std::uint64_t crc64(std::span<const std::byte> bytes) noexcept;

/// The poses in a body, by its header: TRANSFORM (one, named by the device), TDATA or QTDATA (each
/// named). What is no turn (a body that was not seen is often sent as zeros) is left out. Empty for
/// another type or a body that is cut.
std::vector<TrackedPose> parse_igtl_body(const IgtlHeader& header, std::span<const std::byte> body);

/// What a sender says of itself.
struct IgtlStatus {
  int code = 0;  ///< 1: all right
  std::string name, message;
};
/// Of a STATUS body; nothing for another type or one that is cut.
std::optional<IgtlStatus> parse_igtl_status(const IgtlHeader& header,
                                            std::span<const std::byte> body);

/// The request for tracking data of this type, "TDATA" or "QTDATA", each 10 ms or as fast as can
/// be.
std::vector<std::byte> igtl_request(std::string_view type);

}  // namespace tractus::sensors
