/// The interface of a WebSocket for the rest of the server: receives and sends text messages,
/// without sockets.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace tractus::http {

/// Why a WebSocket was closed.
enum class CloseReason {
  disconnected,       ///< the other side closed it, or the connection broke
  timed_out,          ///< nothing was received, not even an answer to a ping
  too_large,          ///< a message exceeded the limit
  flood,              ///< more messages than the limit
  invalid_message,    ///< not WebSocket, not text, or refused by WebSocketHandler::on_message
  no_longer_allowed,  ///< refused by WebSocketHandler::still_allowed
  too_slow,           ///< the other side did not read in time
  closed_by_server,   ///< WebSocketSender::end
};
/// "a message exceeded the size limit", …
std::string_view text_of(CloseReason reason);

/// Sends messages. Safe from any thread; after the WebSocket was closed it drops them.
class WebSocketSender {
 public:
  virtual ~WebSocketSender() = default;
  /// Queues a message, which replaces a queued message with the same key: a slow receiver gets the
  /// latest state and does not delay others. A WebSocket with more than kMostWaiting queued keys is
  /// closed.
  virtual void send(const std::string& key, std::shared_ptr<const std::string> text) = 0;
  /// Sends the queued messages, then closes the WebSocket.
  virtual void end() = 0;

  static constexpr std::size_t kMostWaiting = 4096;
};

/// What one side of a WebSocket is allowed.
struct WebSocketLimits {
  std::size_t max_message_bytes = 16 * 1024;
  double messages_per_s = 60.0;  ///< includes pings; a burst may be as large again
  /// Smallest time between two deliveries; of the messages with one key only the latest is sent.
  std::chrono::milliseconds pause{0};
};

/// The server's side of one WebSocket. `begin`, `on_message` and `ended` are called on the
/// input/output thread and must not block; `still_allowed` is called on a worker thread.
class WebSocketHandler {
 public:
  virtual ~WebSocketHandler() = default;
  virtual WebSocketLimits limits() const = 0;
  virtual void begin(std::shared_ptr<WebSocketSender> sender) = 0;
  /// Called with each complete text message. False: the message is invalid, and the WebSocket is
  /// closed.
  virtual bool on_message(std::string_view text) = 0;
  /// Called every kRecheck. Returns whether the credentials that opened the WebSocket are still
  /// valid.
  virtual bool still_allowed() = 0;
  /// Called once, after `begin`, when the WebSocket is closed.
  virtual void ended(CloseReason reason) = 0;

  static constexpr std::chrono::seconds kRecheck{15};
};

}  // namespace tractus::http
