#include <EGL/egl.h>

#include "core/try.hpp"
#include "station/headset/graphics.hpp"
#include "station/view/egl_context.hpp"

#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_EGL
#include <openxr/openxr_platform.h>

namespace tractus {
namespace headset {
namespace {

class EglGraphics final : public Graphics {
 public:
  explicit EglGraphics(std::unique_ptr<view::EglContext> context) : context_(std::move(context)) {
    binding_ = typed<XrGraphicsBindingEGLMNDX>(XR_TYPE_GRAPHICS_BINDING_EGL_MNDX);
    binding_.getProcAddress = eglGetProcAddress;
    binding_.display = context_->display();
    binding_.config = context_->config();
    binding_.context = context_->context();
  }
  const view::LentContext& context() const override { return *context_; }
  const void* binding() const override { return &binding_; }

 private:
  std::unique_ptr<view::EglContext> context_;
  XrGraphicsBindingEGLMNDX binding_;
};

}  // namespace

core::Result<std::unique_ptr<Graphics>> make_egl_graphics() {
  auto context = TRY(view::EglContext::make());
  return std::unique_ptr<Graphics>(new EglGraphics(std::move(context)));
}

}  // namespace headset
}  // namespace tractus
