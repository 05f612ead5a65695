#include "tests/support/server/websocket_frames.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/require.hpp"
#include "core/try.hpp"

namespace tractus {
namespace world {
namespace {

constexpr std::uint8_t kFinal = 0x80, kReserved = 0x70, kOpcode = 0x0F, kMasked = 0x80;
constexpr std::uint8_t kContinuation = 0x0;

core::Error wrong(const char* what) {
  return {core::Errc::bad_input, fmt::format("WebSocket: {}", what)};
}

std::uint8_t byte_at(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint8_t>(bytes[at]);
}

}  // namespace

std::string websocket_frame(Opcode opcode, std::string_view payload,
                            const std::array<std::byte, 4>& mask) {
  core::require(opcode == Opcode::text || payload.size() <= 125, "a control frame is short");
  std::string out;
  out.push_back(static_cast<char>(kFinal | static_cast<std::uint8_t>(opcode)));
  const auto push = [&](std::uint64_t value, int bytes) {
    while (bytes-- > 0) out.push_back(static_cast<char>(value >> (8 * bytes) & 0xFF));
  };
  if (payload.size() <= 125) {
    push(kMasked | payload.size(), 1);
  } else if (payload.size() <= 0xFFFF) {
    push(kMasked | 126, 1), push(payload.size(), 2);
  } else {
    push(kMasked | 127, 1), push(payload.size(), 8);
  }
  for (const std::byte b : mask) out.push_back(static_cast<char>(b));
  for (std::size_t i = 0; i < payload.size(); ++i)
    out.push_back(static_cast<char>(std::byte(payload[i]) ^ mask[i % 4]));
  return out;
}

std::string websocket_request(const std::string& host, const std::string& path,
                              const std::string& authorization, const std::string& key) {
  return fmt::format(
      "GET {} HTTP/1.1\r\nHost: {}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {}\r\n{}\r\n\r\n",
      path, host, key, authorization);
}

core::Result<std::optional<WebSocketReader::Head>> WebSocketReader::head() const {
  const std::string_view bytes = waiting_;
  if (bytes.size() < 2) return std::optional<Head>();
  const std::uint8_t first = byte_at(bytes, 0), second = byte_at(bytes, 1);
  if (first & kReserved) return wrong("a frame with an extension nobody asked for");
  if (second & kMasked) return wrong("a masked frame from a server");
  Head out{.last = (first & kFinal) != 0, .opcode = static_cast<std::uint8_t>(first & kOpcode)};
  const int length = second & 0x7F;
  const std::size_t more = length == 126 ? 2 : length == 127 ? 8 : 0;
  out.size = 2 + more;
  if (bytes.size() < out.size) return std::optional<Head>();
  std::uint64_t size = more == 0 ? static_cast<std::uint64_t>(length) : 0;
  for (std::size_t i = 0; i < more; ++i) size = size << 8 | byte_at(bytes, 2 + i);
  const bool control = (out.opcode & 0x8) != 0;
  if (control && (size > 125 || !out.last)) return wrong("a control frame that is too long");
  if (size > kMost_bytes || size + message_.size() > kMost_bytes)
    return core::Error{core::Errc::too_large, "WebSocket: the server sends too long a message"};
  out.payload = size;
  return std::optional(out);
}

core::Result<std::optional<WebSocketEvent>> WebSocketReader::next() {
  while (true) {
    auto found = TRY(head());
    if (!found || waiting_.size() < found->size + found->payload)
      return std::optional<WebSocketEvent>();
    const Head frame = *found;
    std::string payload = waiting_.substr(frame.size, frame.payload);
    waiting_.erase(0, frame.size + frame.payload);
    if (frame.opcode == std::uint8_t(Opcode::close) || frame.opcode == std::uint8_t(Opcode::ping) ||
        frame.opcode == std::uint8_t(Opcode::pong))
      return std::optional(WebSocketEvent{Opcode(frame.opcode), std::move(payload)});
    const bool begins = frame.opcode == std::uint8_t(Opcode::text);
    if (begins == within_ || (!begins && frame.opcode != kContinuation))
      return wrong("a frame that does not follow from the last");
    message_ += payload;
    within_ = !frame.last;
    if (frame.last) return std::optional(WebSocketEvent{Opcode::text, std::exchange(message_, {})});
  }
}

}  // namespace world
}  // namespace tractus
