/// The button of a device between two trials. Nothing is commanded and no force is given.
#pragma once

#include <memory>
#include <optional>

#include "station/devices/device.hpp"
#include "station/devices/rig_device.hpp"

namespace tractus::devices {

/// The first button of a handle, or the start button of a rig's panel.
class StartButton {
 public:
  explicit StartButton(std::unique_ptr<Device> handle) : handle_(std::move(handle)) {}
  explicit StartButton(std::unique_ptr<RigDevice> rig) : rig_(std::move(rig)) {}
  /// Closes the device.
  ~StartButton();
  StartButton(const StartButton&) = delete;
  StartButton& operator=(const StartButton&) = delete;

  /// Errors: those of the device.
  core::Result<void> open();
  /// Whether the button went down since the last call. A button that is held from the first call on
  /// counts once it was released. Nothing: the device does not answer.
  std::optional<bool> pressed(core::Instant_ns now) noexcept;

 private:
  std::optional<bool> is_down(core::Instant_ns now) noexcept;

  std::unique_ptr<Device> handle_;
  std::unique_ptr<RigDevice> rig_;
  bool was_down_ = true;
};

}  // namespace tractus::devices
