/// A WebSocket as the rest of the server sees it: words in, words out, no sockets.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace http {

/// Why a conversation ended.
enum class Parting {
  hung_up,      ///< the other side left, or the line broke
  went_silent,  ///< nothing was heard, not even an answer to a ping
  too_large,    ///< a message over the limit
  flood,        ///< more messages than the limit
  nonsense,     ///< not WebSocket, not text, or Conversation::hear said so
  not_allowed,  ///< Conversation::may_stay said so
  too_slow,     ///< it did not take what was said in time
  dismissed,    ///< Line::end
};
/// "a message over the limit", …
std::string_view text_of(Parting parting);

/// Where words go out. Safe from any thread; to a line that has ended they go nowhere.
class Line {
 public:
  virtual ~Line() = default;
  /// Leaves at the next chance. What still waits under the same key is replaced: a slow listener
  /// gets the latest, and never makes anybody wait. A listener with more than kMostWaiting keys
  /// waiting is dropped.
  virtual void say(const std::string& key, std::shared_ptr<const std::string> text) = 0;
  /// What waits still goes out, then the line is closed.
  virtual void end() = 0;

  static constexpr std::size_t kMostWaiting = 4096;
};

/// What one side of a WebSocket is allowed.
struct ConversationLimits {
  std::size_t max_message_bytes = 16 * 1024;
  double messages_per_s = 60.0;  ///< pings too; as many again in one go
  /// Between two deliveries to the listener: what is said meanwhile under one key is said once.
  std::chrono::milliseconds pause{0};
};

/// The server's part in one WebSocket. `begin`, `hear` and `ended` are called on the input/output
/// thread and must not wait for anything; `may_stay` on a worker.
class Conversation {
 public:
  virtual ~Conversation() = default;
  virtual ConversationLimits limits() const = 0;
  virtual void begin(std::shared_ptr<Line> line) = 0;
  /// A whole text message. False: it makes no sense, and the line is closed.
  virtual bool hear(std::string_view text) = 0;
  /// Asked every kRecheck: are the credentials that opened it still good?
  virtual bool may_stay() = 0;
  /// Once, after `begin`.
  virtual void ended(Parting why) = 0;

  static constexpr std::chrono::seconds kRecheck{15};
};

}  // namespace http
