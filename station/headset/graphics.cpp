#include "station/headset/graphics.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <fmt/format.h>

#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr_platform.h>

#include "core/try.hpp"

namespace tractus {
namespace headset {
namespace {

core::Result<void> check_version(const Instance& instance) {
  const auto ask = reinterpret_cast<PFN_xrGetOpenGLGraphicsRequirementsKHR>(
      instance.function("xrGetOpenGLGraphicsRequirementsKHR"));
  if (!ask) return refused("no word on OpenGL", XR_ERROR_FUNCTION_UNSUPPORTED);
  auto wanted = typed<XrGraphicsRequirementsOpenGLKHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR);
  if (const XrResult result = ask(instance.handle(), instance.system(), &wanted); XR_FAILED(result))
    return refused("no word on OpenGL", result);
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  const XrVersion ours = XR_MAKE_VERSION(std::uint64_t(major), std::uint64_t(minor), 0);
  // A newer OpenGL than the runtime was tried with is its own warning, not a hindrance.
  if (ours < wanted.minApiVersionSupported)
    return core::Error{core::Errc::unavailable,
                       fmt::format("headset: OpenGL {}.{} is here, the runtime wants {}.{}", major,
                                   minor, XR_VERSION_MAJOR(wanted.minApiVersionSupported),
                                   XR_VERSION_MINOR(wanted.minApiVersionSupported))};
  return {};
}

}  // namespace

core::Result<std::unique_ptr<Graphics>> Graphics::make(const Instance& instance) {
  auto made = instance.binding() == Binding::egl ? make_egl_graphics() : make_glx_graphics();
  if (!made) return made.error();
  TRY(check_version(instance));
  return made;
}

}  // namespace headset
}  // namespace tractus
