/// The least that a cycle over TCP can cost: as many bytes there and back, nothing done with them.
#pragma once

#include <memory>

namespace tractus::bench {

class RawPingPong {
 public:
  /// Loopback, both ends without delay, the other end in a thread of its own. Null when the system
  /// gives no socket.
  static std::unique_ptr<RawPingPong> open(int request_bytes, int reply_bytes);
  virtual ~RawPingPong() = default;
  /// One cycle; how many bytes came back.
  virtual int cycle() = 0;
};

}  // namespace tractus::bench
