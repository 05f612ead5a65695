/// The pictures of one eye on their way to the runtime.
#pragma once

#include <vector>

#include "station/headset/xr.hpp"

namespace tractus::headset {

/// OpenGL textures of the runtime's own, taken in turn: acquire, draw, release.
class Swapchain {
 public:
  /// sRGB where offered: VTK's colours are meant for a screen and are copied as they are. Errors:
  /// unavailable.
  static core::Result<Swapchain> make(XrSession session, int width_px, int height_px);
  Swapchain(Swapchain&& other) noexcept;
  Swapchain& operator=(Swapchain&&) = delete;
  ~Swapchain();

  XrSwapchain handle() const { return handle_; }
  /// The texture to draw in until `release`; waits until the runtime has let go of it.
  core::Result<unsigned> acquire();
  core::Result<void> release();

 private:
  Swapchain() = default;
  XrSwapchain handle_ = XR_NULL_HANDLE;
  std::vector<unsigned> textures_;
};

}  // namespace tractus::headset
