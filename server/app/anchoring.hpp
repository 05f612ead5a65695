/// Anchors of the audit trail while the server serves: made every ten seconds, and sent elsewhere.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/app/anchors.hpp"

namespace tractus::app {

/// Another place for anchors.
struct AnchorPlace {
  enum class Kind { file, syslog, http };
  Kind kind;
  std::string where;  ///< path or address; "" for syslog
};
/// "syslog", "https://…" (http to this machine's own addresses alone), or the path of a file whose
/// folder is there. Errors: bad_input.
core::Result<AnchorPlace> anchor_place(const std::string& text);

/// Sends anchors to one place from a thread of its own: each until the place has taken it, again
/// after ten seconds when it has not. Nobody waits for it. The log says when a place fails, and
/// when it takes anchors again. Of more than 1000 that wait, the oldest are given up: a newer
/// anchor says all that they said.
class AnchorSender {
 public:
  explicit AnchorSender(AnchorPlace place);
  /// Tries once more to send what waits.
  ~AnchorSender();
  AnchorSender(const AnchorSender&) = delete;
  AnchorSender& operator=(const AnchorSender&) = delete;
  void send(const std::string& line);

 private:
  void run();
  bool send_waiting(std::unique_lock<std::mutex>& held);
  void tell(const core::Result<void>& sent);

  const AnchorPlace place_;
  bool failing_ = false;
  std::mutex mutex_;  ///< guards what follows
  std::deque<std::string> waiting_;
  bool ending_ = false;
  std::condition_variable changed_;
  std::thread thread_;
};

/// Anchors the trail's end every ten seconds and at the end.
class Anchoring {
 public:
  Anchoring(DataFolder& data, const std::vector<AnchorPlace>& places);
  ~Anchoring();
  Anchoring(const Anchoring&) = delete;
  Anchoring& operator=(const Anchoring&) = delete;

 private:
  void run();
  void note();

  DataFolder& data_;
  std::vector<std::unique_ptr<AnchorSender>> senders_;
  std::mutex mutex_;  ///< guards ending_
  bool ending_ = false;
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace tractus::app
