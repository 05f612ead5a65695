#include "station/headset/swapchain.hpp"

#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <utility>

#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr_platform.h>

#include "core/try.hpp"

namespace tractus {
namespace headset {
namespace {

core::Result<std::int64_t> format_of(XrSession session) {
  std::uint32_t count = 0;
  XrResult result = xrEnumerateSwapchainFormats(session, 0, &count, nullptr);
  std::vector<std::int64_t> offered(count);
  if (XR_SUCCEEDED(result))
    result = xrEnumerateSwapchainFormats(session, count, &count, offered.data());
  if (XR_FAILED(result)) return refused("no formats of pictures", result);
  for (const std::int64_t wanted : {GL_SRGB8_ALPHA8, GL_RGBA8})
    if (std::ranges::find(offered, wanted) != offered.end()) return wanted;
  return core::Error{core::Errc::unavailable,
                     "headset: the runtime takes no pictures of 8 bits a colour"};
}

}  // namespace

core::Result<Swapchain> Swapchain::make(XrSession session, int width_px, int height_px) {
  auto format = TRY(format_of(session));
  auto info = typed<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
  info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_SAMPLED_BIT;
  info.format = format;
  info.sampleCount = info.faceCount = info.arraySize = info.mipCount = 1;
  info.width = static_cast<std::uint32_t>(width_px);
  info.height = static_cast<std::uint32_t>(height_px);
  Swapchain made;
  if (const XrResult result = xrCreateSwapchain(session, &info, &made.handle_); XR_FAILED(result))
    return refused("no pictures for an eye", result);
  std::uint32_t count = 0;
  XrResult result = xrEnumerateSwapchainImages(made.handle_, 0, &count, nullptr);
  std::vector<XrSwapchainImageOpenGLKHR> images(
      count, typed<XrSwapchainImageOpenGLKHR>(XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR));
  if (XR_SUCCEEDED(result))
    result = xrEnumerateSwapchainImages(
        made.handle_, count, &count, reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data()));
  if (XR_FAILED(result)) return refused("no pictures for an eye", result);
  for (const auto& image : images) made.textures_.push_back(image.image);
  return made;
}

Swapchain::Swapchain(Swapchain&& other) noexcept
    : handle_(std::exchange(other.handle_, XrSwapchain(XR_NULL_HANDLE))),
      textures_(std::move(other.textures_)) {}

Swapchain::~Swapchain() {
  if (handle_) xrDestroySwapchain(handle_);
}

core::Result<unsigned> Swapchain::acquire() {
  const auto which = typed<XrSwapchainImageAcquireInfo>(XR_TYPE_SWAPCHAIN_IMAGE_ACQUIRE_INFO);
  std::uint32_t index = 0;
  if (const XrResult result = xrAcquireSwapchainImage(handle_, &which, &index); XR_FAILED(result))
    return refused("no picture to draw in", result);
  auto until = typed<XrSwapchainImageWaitInfo>(XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
  until.timeout = XR_INFINITE_DURATION;
  if (const XrResult result = xrWaitSwapchainImage(handle_, &until); result != XR_SUCCESS)
    return refused("a picture to draw in is not let go", result);
  if (index >= textures_.size()) return refused("no such picture", XR_ERROR_RUNTIME_FAILURE);
  return textures_[index];
}

core::Result<void> Swapchain::release() {
  const auto done = typed<XrSwapchainImageReleaseInfo>(XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO);
  const XrResult result = xrReleaseSwapchainImage(handle_, &done);
  if (XR_FAILED(result)) return refused("a picture is not taken", result);
  return {};
}

}  // namespace headset
}  // namespace tractus
