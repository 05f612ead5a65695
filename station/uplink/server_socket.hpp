/// A WebSocket to the server, as the live uplink sees it.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/result.hpp"

namespace tractus::uplink {

class ServerSocket {
 public:
  virtual ~ServerSocket() = default;
  /// Errors: unavailable when the line is broken, or the other side does not read.
  virtual core::Result<void> send(const std::string& text) = 0;
  /// The next text, or nothing when none came within `patience_ms`. Pings are answered within.
  /// Errors: unavailable when the line is broken or closed, with the server's reason; bad_input for
  /// what no server may send, too_large (over 64 KiB). After an error it is of no use any more.
  virtual core::Result<std::optional<std::string>> receive(int patience_ms) = 0;
};

struct ServerAddress {
  std::string url;                             ///< "https://host:port"
  std::map<std::string, std::string> headers;  ///< {"Authorization", "Bearer TOKEN"}
  std::filesystem::path authority = {};
  std::string path = "/api/v1/live/station";
};
/// Connected by libcurl, certificate checked as HttpServer does; the WebSocket is Boost.Beast's.
/// @param stopped  ends the waiting early
/// Errors: unavailable, unauthorised, forbidden, bad_input.
core::Result<std::unique_ptr<ServerSocket>> open_server_socket(const ServerAddress& to,
                                                               const std::atomic<bool>& stopped);

}  // namespace tractus::uplink
