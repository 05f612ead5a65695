/// OpenIGTLink's bytes as they come from a connection, cut into messages.
#pragma once

#include <optional>
#include <vector>

#include "core/result.hpp"
#include "station/sensors/igtl_message.hpp"

namespace tractus::sensors {

/// Takes bytes in pieces of any size and gives back the poses of each whole message. What is of no
/// use here (pictures, texts: a server may send everything it has) is passed over, however long.
class IgtlReader {
 public:
  void add(std::span<const std::byte> bytes);

  /// The poses of the next whole message, often none; nothing when more bytes have to come. Errors:
  /// bad_input: it is not OpenIGTLink, or a message with poses is over kIgtlMostBytes.
  core::Result<std::optional<std::vector<TrackedPose>>> next();

  std::uint64_t damaged() const noexcept { return damaged_; }  ///< messages whose CRC was wrong
  /// The last word of the sender that was not "all right".
  const std::optional<IgtlStatus>& complaint() const noexcept { return complaint_; }
  /// Is the middle of a message that is passed over still to come?
  bool passing() const noexcept { return passing_ > 0; }
  std::size_t held() const noexcept { return held_.size(); }  ///< bytes

 private:
  std::vector<std::byte> held_;
  std::size_t taken_ = 0;      ///< bytes of it that were read
  std::uint64_t passing_ = 0;  ///< bytes still to come of a message that is passed over
  std::uint64_t damaged_ = 0;
  std::optional<IgtlStatus> complaint_;
};

}  // namespace tractus::sensors
