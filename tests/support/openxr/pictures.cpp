/// Swapchains: textures of the runtime's in the application's context, and what lies in them.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <cstring>
#include <map>

#include "tests/support/openxr/runtime.hpp"

namespace tractus {
namespace fakexr {
namespace {
constexpr int kImages = 3;
constexpr std::uint64_t kLookEvery = 8;  // frames; reading back takes time

XrResult XRAPI_CALL formats(XrSession, std::uint32_t capacity, std::uint32_t* count,
                            std::int64_t* out) {
  return fill(std::vector<std::int64_t>{GL_RGBA16F, GL_SRGB8_ALPHA8, GL_RGBA8}, capacity, count,
              out);
}

XrResult XRAPI_CALL create(XrSession, const XrSwapchainCreateInfo* info, XrSwapchain* out) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (const auto bad = missing_session("xrCreateSwapchain"); bad != XR_SUCCESS) return bad;
  if (!is(info, XR_TYPE_SWAPCHAIN_CREATE_INFO)) return violation("xrCreateSwapchain: wrong type");
  if (info->format != GL_SRGB8_ALPHA8 && info->format != GL_RGBA8)
    return violation("xrCreateSwapchain: format", XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED);
  if (info->width == 0 || info->width > 4096 || info->height == 0 || info->height > 4096 ||
      info->arraySize != 1 || info->mipCount != 1 || info->faceCount != 1)
    return violation("xrCreateSwapchain: size");
  if (!(info->usageFlags & XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT))
    return violation("xrCreateSwapchain: nobody can draw in it");
  if (!context_is_current()) return violation("xrCreateSwapchain: the context is not current");
  auto made = std::make_unique<Swapchain>();
  made->width = static_cast<int>(info->width), made->height = static_cast<int>(info->height);
  made->textures.resize(kImages);
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  glGenTextures(kImages, made->textures.data());
  for (const unsigned texture : made->textures) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, static_cast<GLenum>(info->format), made->width, made->height);
  }
  glBindTexture(GL_TEXTURE_2D, static_cast<unsigned>(bound));
  ++control().swapchains;
  *out = handle_of<XrSwapchain>(made.get());
  w.swapchains.insert(made.release());
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy(XrSwapchain handle) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  Swapchain* chain = object_of(w.swapchains, handle);
  if (!chain) return violation("xrDestroySwapchain: of none", XR_ERROR_HANDLE_INVALID);
  if (!context_is_current()) violation("xrDestroySwapchain: the context is not current");
  glDeleteTextures(kImages, chain->textures.data());
  w.swapchains.erase(chain);
  delete chain;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL images(XrSwapchain handle, std::uint32_t capacity, std::uint32_t* count,
                           XrSwapchainImageBaseHeader* out) {
  const Swapchain* chain = object_of(world().swapchains, handle);
  if (!chain) return violation("xrEnumerateSwapchainImages: of none", XR_ERROR_HANDLE_INVALID);
  *count = kImages;
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < kImages) return XR_ERROR_SIZE_INSUFFICIENT;
  auto* all = reinterpret_cast<XrSwapchainImageOpenGLKHR*>(out);
  for (std::size_t i = 0; i < kImages; ++i) {
    if (!is(&all[i], XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR))
      return violation("xrEnumerateSwapchainImages: wrong type");
    all[i].image = chain->textures[i];
  }
  return XR_SUCCESS;
}

XrResult XRAPI_CALL acquire(XrSwapchain handle, const XrSwapchainImageAcquireInfo*,
                            std::uint32_t* index) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  Swapchain* chain = object_of(w.swapchains, handle);
  if (!chain) return violation("xrAcquireSwapchainImage: of none", XR_ERROR_HANDLE_INVALID);
  if (chain->acquired >= 0)
    return violation("xrAcquireSwapchainImage: twice", XR_ERROR_CALL_ORDER_INVALID);
  if (!w.begun) violation("xrAcquireSwapchainImage: outside a frame");
  chain->acquired = static_cast<int>(chain->next);
  chain->waited = -1;
  *index = chain->next;
  chain->next = (chain->next + 1) % kImages;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL wait(XrSwapchain handle, const XrSwapchainImageWaitInfo* info) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  Swapchain* chain = object_of(w.swapchains, handle);
  if (!chain || !is(info, XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO))
    return violation("xrWaitSwapchainImage: swapchain or type");
  if (chain->acquired < 0 || chain->waited >= 0)
    return violation("xrWaitSwapchainImage: before it was acquired", XR_ERROR_CALL_ORDER_INVALID);
  chain->waited = chain->acquired;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL release(XrSwapchain handle, const XrSwapchainImageReleaseInfo*) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  Swapchain* chain = object_of(w.swapchains, handle);
  if (!chain) return violation("xrReleaseSwapchainImage: of none", XR_ERROR_HANDLE_INVALID);
  if (chain->waited < 0)
    return violation("xrReleaseSwapchainImage: before it was waited for",
                     XR_ERROR_CALL_ORDER_INVALID);
  chain->released = chain->acquired;
  chain->acquired = chain->waited = -1;
  chain->released_in = w.frame;
  return XR_SUCCESS;
}

std::vector<unsigned char> pixels_of(const Swapchain& chain) {
  std::vector<unsigned char> rgba(std::size_t(chain.width) * std::size_t(chain.height) * 4);
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  glBindTexture(GL_TEXTURE_2D, chain.textures[static_cast<std::size_t>(chain.released)]);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  glBindTexture(GL_TEXTURE_2D, static_cast<unsigned>(bound));
  return rgba;
}

std::uint64_t unlike_the_corner(const std::vector<unsigned char>& rgba) {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < rgba.size(); i += 4) n += std::memcmp(&rgba[i], rgba.data(), 3) != 0;
  return n;
}

}  // namespace

void look_at(const Swapchain& left, const Swapchain& right) {
  const bool keep = world().frame == control().keep_at;
  if (!keep && world().frame % kLookEvery != 0) return;
  if (!context_is_current()) {
    violation("xrEndFrame: the context is not current");
    return;
  }
  const std::array<const Swapchain*, 2> eyes{&left, &right};
  const std::array<const char*, 2> names{"/left.png", "/right.png"};
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const auto rgba = pixels_of(*eyes[eye]);
    control().lit_px[eye] = unlike_the_corner(rgba);
    if (keep)
      write_png(std::string(control().folder) + names[eye], rgba, eyes[eye]->width,
                eyes[eye]->height);
  }
}

PFN_xrVoidFunction picture_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> all{
      {"xrEnumerateSwapchainFormats", as_void(formats)},
      {"xrCreateSwapchain", as_void(create)},
      {"xrDestroySwapchain", as_void(destroy)},
      {"xrEnumerateSwapchainImages", as_void(images)},
      {"xrAcquireSwapchainImage", as_void(acquire)},
      {"xrWaitSwapchainImage", as_void(wait)},
      {"xrReleaseSwapchainImage", as_void(release)}};
  const auto at = all.find(name);
  return at == all.end() ? nullptr : at->second;
}

}  // namespace fakexr
}  // namespace tractus
