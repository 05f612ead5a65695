/// Motion capture over OpenIGTLink: messages TRANSFORM, TDATA, QTDATA and STATUS.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "station/sensors/igtl_reader.hpp"
#include "station/sensors/socket.hpp"

namespace tractus::sensors {

/// A connection to a server that sends (Plus and the bridges of QTM and Motive do). One thread.
class IgtlStream {
 public:
  static constexpr int kPort = 18944;
  /// Connects and asks for TDATA and QTDATA (a server that only pushes TRANSFORM ignores that).
  /// Errors: unavailable naming host and port.
  static core::Result<std::unique_ptr<IgtlStream>> open(const std::string& host, int port = kPort);

  /// The poses of the next message; empty when it has none (it is damaged, or of another type), and
  /// after `wait_ms` without one. Errors: unavailable (closed), bad_input (not OpenIGTLink).
  core::Result<std::vector<TrackedPose>> next(int wait_ms);
  std::uint64_t damaged() const noexcept { return reader_.damaged(); }
  const std::optional<IgtlStatus>& complaint() const noexcept { return reader_.complaint(); }
  std::uint64_t received() const noexcept { return received_; }  ///< bytes, of whatever messages

 private:
  explicit IgtlStream(Socket socket) : socket_(std::move(socket)) {}
  Socket socket_;
  IgtlReader reader_;
  std::uint64_t received_ = 0;
};

}  // namespace tractus::sensors
