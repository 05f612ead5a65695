#include "station/rig/request.hpp"

namespace tractus {
namespace rig {
namespace {

constexpr std::uint8_t kRead = 3, kWriteOne = 6, kWriteMany = 16, kWriteAndRead = 23;
constexpr int kMostRead = 125, kMostWritten = 123, kMostWrittenAndRead = 121;

int word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return bytes[at] << 8 | bytes[at + 1];
}

/// Start, count, number of bytes, bytes: as FC 16 and 23 end. False when they do not agree.
bool take_values(std::span<const std::uint8_t> tail, int most, Request& request) {
  if (tail.size() < 5) return false;
  const int count = word(tail, 2);
  if (count < 1 || count > most || tail[4] != 2 * count ||
      tail.size() != std::size_t(5 + 2 * count))
    return false;
  request.write_start = word(tail, 0);
  for (int k = 0; k < count; ++k)
    request.values.push_back(static_cast<std::uint16_t>(word(tail, std::size_t(5 + 2 * k))));
  return true;
}

bool take_read(std::span<const std::uint8_t> part, Request& request) {
  request.read_start = word(part, 0);
  request.read_count = word(part, 2);
  return request.read_count >= 1 && request.read_count <= kMostRead;
}

}  // namespace

bool is_offered(std::uint8_t function) noexcept {
  return function == kRead || function == kWriteOne || function == kWriteMany ||
         function == kWriteAndRead;
}

std::optional<Request> parse_request(std::span<const std::uint8_t> pdu) {
  if (pdu.empty()) return std::nullopt;
  const auto rest = pdu.subspan(1);
  Request request;
  bool agrees = false;
  switch (pdu[0]) {
    case kRead:
      agrees = rest.size() == 4 && take_read(rest, request);
      break;
    case kWriteOne:
      agrees = rest.size() == 4;
      if (agrees) request.write_start = word(rest, 0);
      if (agrees) request.values = {static_cast<std::uint16_t>(word(rest, 2))};
      break;
    case kWriteMany:
      agrees = take_values(rest, kMostWritten, request);
      break;
    case kWriteAndRead:
      agrees = rest.size() > 4 && take_read(rest.first(4), request) &&
               take_values(rest.subspan(4), kMostWrittenAndRead, request);
      break;
    default:
      break;
  }
  if (!agrees) return std::nullopt;
  return request;
}

}  // namespace rig
}  // namespace tractus
