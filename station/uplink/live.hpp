/// Says what the station does, and hears what it is asked: a thread of low priority beside
/// everything. A server that is away, slow or broken is felt by nobody else.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "core/clock.hpp"
#include "station/uplink/server_socket.hpp"
#include "wire/live.hpp"

namespace tractus::uplink {

class LiveUplink {
 public:
  struct Parts {
    /// Opens a line; called again after each end of one.
    std::function<core::Result<std::unique_ptr<ServerSocket>>(const std::atomic<bool>& stopped)>
        open;
    /// The present state; called from the uplink's thread up to 20 times a second.
    std::function<wire::StationStatus()> told;
    /// A command; called from the uplink's thread.
    std::function<void(const wire::StationCommand&)> commanded;
    /// After a line was opened, before the first state: may take its time.
    std::function<void()> connected = {};
  };
  explicit LiveUplink(Parts parts);
  /// Ends the thread: at once, but for a connection that is just being made (a second).
  ~LiveUplink();
  LiveUplink(const LiveUplink&) = delete;
  LiveUplink& operator=(const LiveUplink&) = delete;

  bool connected() const noexcept { return connected_; }

  static constexpr int kBetween_ms = 50;   ///< two states: 20 Hz at most
  static constexpr int kAlive_ms = 5'000;  ///< said again though nothing changed
  static constexpr int kFirstWait_ms = 500, kLongestWait_ms = 30'000;

 private:
  void run();
  /// To the end of one line; how long it held.
  void hold(ServerSocket& line);
  void pause(int ms) const;

  Parts parts_;
  std::atomic<bool> stop_ = false, connected_ = false;
  std::thread thread_;
};

/// How long to wait before the n-th try (from 0) to reach the server again: doubles from
/// kFirstWait_ms to kLongestWait_ms, a quarter of it by chance, so that many stations do not come
/// back in one moment. @param chance  0 … 1
int wait_before_ms(int attempt, double chance);

}  // namespace tractus::uplink
