/// Is a device on the USB, may we open it, does another program have it?
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "core/result.hpp"

namespace tractus::devices {

inline constexpr std::uint16_t kForceDimension = 0x1451;  ///< vendor, as registered

enum class UsbPresence : std::uint8_t {
  absent,         ///< nothing of that vendor is there
  no_permission,  ///< there, but this user may not open it
  in_use,         ///< another program has it
  present,
};

struct UsbFinding {
  UsbPresence presence = UsbPresence::absent;
  std::string where;  ///< "bus 1, device 5"; empty when absent
};

/// Looks once: lists, opens, claims the first interface and lets it go again. Errors: unavailable
/// (the system gives no access to its USB).
core::Result<UsbFinding> look_for_usb(std::uint16_t vendor);

/// One line for a person: what is wrong and what to do. Of `present`: empty.
std::string text_of(const UsbFinding& finding, const std::string& device);

/// Watches arrivals and departures in a thread of its own, told by the system, so that the loop
/// reads an atomic.
class UsbWatch {
 public:
  /// Errors: unavailable.
  static core::Result<std::unique_ptr<UsbWatch>> start(std::uint16_t vendor);
  ~UsbWatch();
  UsbWatch(const UsbWatch&) = delete;
  UsbWatch& operator=(const UsbWatch&) = delete;
  /// From any thread, real-time safe.
  bool present() const noexcept { return there_.load(std::memory_order_relaxed) > 0; }

 private:
  struct Context;
  UsbWatch();
  void watch();
  std::unique_ptr<Context> context_;
  std::atomic<int> there_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace tractus::devices
