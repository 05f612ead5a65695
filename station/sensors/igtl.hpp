/// Motion capture over OpenIGTLink: messages TRANSFORM, TDATA, QTDATA and STATUS.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "station/sensors/igtl_message.hpp"
#include "station/sensors/socket.hpp"

namespace sensors {

/// A connection to a server that sends (Plus and the bridges of QTM and Motive do). One thread.
class IgtlStream {
 public:
  static constexpr int kPort = 18944;
  /// Connects and asks for TDATA and QTDATA (a server that only pushes TRANSFORM ignores that).
  /// Errors: unavailable naming host and port.
  static core::Result<std::unique_ptr<IgtlStream>> open(const std::string& host, int port = kPort);

  /// The poses of the next message; empty after `wait_ms` without one. Messages that are damaged
  /// are passed over, those of other types too. Errors: unavailable (closed), bad_input (not
  /// OpenIGTLink, or a message over kIgtlMostBytes).
  core::Result<std::vector<TrackedPose>> next(int wait_ms);
  std::uint64_t damaged() const noexcept { return damaged_; }  ///< messages whose CRC was wrong
  /// The last word of the sender that was not "all right".
  const std::optional<IgtlStatus>& complaint() const noexcept { return complaint_; }

 private:
  explicit IgtlStream(Socket socket) : socket_(std::move(socket)) {}
  /// The next whole message out of what is held; nothing if more has to come.
  core::Result<std::optional<std::vector<TrackedPose>>> held();
  Socket socket_;
  std::vector<std::byte> held_;
  std::size_t taken_ = 0;  ///< bytes of it that were read
  std::uint64_t damaged_ = 0;
  std::optional<IgtlStatus> complaint_;
};

}  // namespace sensors
