/// A WebSocket of a test's own over a plain socket: says what it likes, reads when it likes.
#pragma once

#include <optional>
#include <string>

#include "tests/support/server/process.hpp"
#include "tests/support/server/websocket_frames.hpp"

namespace tractus::world {

class WebSocket {
 public:
  /// Connects and asks for the upgrade with these headers; `status` says what came of it.
  WebSocket(int port, const std::string& path, const Headers& headers);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  int status() const { return status_; }
  /// False when the line is broken or its buffers are full.
  bool say(const std::string& text);
  bool send_bytes(const std::string& bytes);
  /// The next text as JSON, pings answered; nothing when none came in time or the line is closed.
  std::optional<core::Json> hear(int patience_ms = 5000);
  /// Texts until one that `wanted` takes; nothing when it does not come in time.
  template <class Wanted>
  std::optional<core::Json> hear_until(Wanted wanted, int patience_ms = 10'000) {
    const auto until = now_ms() + patience_ms;
    for (auto left = until - now_ms(); left > 0; left = until - now_ms())
      if (auto heard = hear(static_cast<int>(left)); heard && wanted(*heard))
        return heard;
      else if (closed_)
        break;
    return std::nullopt;
  }
  /// The other side closed it, seen by `hear`; with its code and words.
  bool closed() const { return closed_; }
  int close_code() const { return close_code_; }
  const std::string& close_words() const { return close_words_; }
  static long now_ms();

 private:
  bool receive(int patience_ms);
  int fd_ = -1, status_ = 0, close_code_ = 0;
  bool closed_ = false;
  std::string close_words_;
  WebSocketReader reader_;
};

/// What a browser sends along: its cookie, and the page it is on.
Headers from_our_page(const Headers& signed_in, int port);

}  // namespace tractus::world
