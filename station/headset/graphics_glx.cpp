#include <GL/glx.h>

#include "core/try.hpp"
#include "station/headset/graphics.hpp"
#include "station/view/glx_context.hpp"

#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_XLIB
#include <openxr/openxr_platform.h>

namespace tractus {
namespace headset {
namespace {

class GlxGraphics final : public Graphics {
 public:
  explicit GlxGraphics(std::unique_ptr<view::GlxContext> context) : context_(std::move(context)) {
    const view::GlxContext::Handles& h = context_->handles();
    binding_ = typed<XrGraphicsBindingOpenGLXlibKHR>(XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR);
    binding_.xDisplay = static_cast<Display*>(h.display);
    binding_.visualid = h.visual;
    binding_.glxFBConfig = static_cast<GLXFBConfig>(h.config);
    binding_.glxDrawable = h.drawable;
    binding_.glxContext = static_cast<GLXContext>(h.context);
  }
  const view::LentContext& context() const override { return *context_; }
  const void* binding() const override { return &binding_; }

 private:
  std::unique_ptr<view::GlxContext> context_;
  XrGraphicsBindingOpenGLXlibKHR binding_;
};

}  // namespace

core::Result<std::unique_ptr<Graphics>> make_glx_graphics() {
  auto context = TRY(view::GlxContext::make());
  return std::unique_ptr<Graphics>(new GlxGraphics(std::move(context)));
}

}  // namespace headset
}  // namespace tractus
