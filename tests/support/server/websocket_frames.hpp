/// WebSocket frames as a client sends and takes them, RFC 6455: text alone, no extension. Bytes in,
/// bytes out, no sockets. Server and station have Boost.Beast at both ends; the tests do not.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/bytes.hpp"
#include "core/result.hpp"

namespace tractus::world {

enum class Opcode : std::uint8_t { text = 0x1, close = 0x8, ping = 0x9, pong = 0xA };

/// One whole frame, masked as a client's must be. @pre a control frame holds at most 125 bytes.
std::string websocket_frame(Opcode opcode, std::string_view payload,
                            const std::array<std::byte, 4>& mask);

/// The upgrade request for `path`. @param host  "host:port"
/// @param key  16 random bytes in base64
std::string websocket_request(const std::string& host, const std::string& path,
                              const std::string& authorization, const std::string& key);
/// What the other side said: a whole text, a ping, or its goodbye.
struct WebSocketEvent {
  Opcode opcode;
  std::string payload;
};

/// Takes bytes as they come and gives whole messages. Never holds more than kMost bytes.
class WebSocketReader {
 public:
  static constexpr std::size_t kMost_bytes = 64 * 1024;

  void add(std::string_view bytes) { waiting_ += bytes; }
  /// The next one, or nothing until more bytes come. Errors: bad_input for what is no frame a
  /// server may send, too_large. After an error the reader is of no use any more.
  core::Result<std::optional<WebSocketEvent>> next();

 private:
  struct Head {
    bool last = false;
    std::uint8_t opcode = 0;
    std::size_t size = 0, payload = 0;  ///< of head and payload
  };
  core::Result<std::optional<Head>> head() const;
  std::string waiting_, message_;
  bool within_ = false;  ///< a text whose end has not come
};

}  // namespace tractus::world
