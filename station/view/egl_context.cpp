#include "station/view/egl_context.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <atomic>

namespace {
std::atomic<int> surfaceless_contexts{0};
constexpr unsigned kGlewErrorNoGlxDisplay = 4;  // GLEW 2.2, glew.h
}  // namespace

extern "C" unsigned glewInit();

/// Found before GLEW's own by the dynamic linker, because the program exports it.
extern "C" __attribute__((visibility("default"))) unsigned glewInit() {
  using Init = unsigned (*)();
  static const auto original = reinterpret_cast<Init>(dlsym(RTLD_NEXT, "glewInit"));
  if (!original) return 1;
  const unsigned outcome = original();
  return outcome == kGlewErrorNoGlxDisplay && surfaceless_contexts > 0 ? 0 : outcome;
}

namespace tractus::view {

struct EglContext::Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLConfig config = nullptr;
  EGLContext context = EGL_NO_CONTEXT;
};

EglContext::EglContext(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {
  ++surfaceless_contexts;
}

EglContext::~EglContext() {
  eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(handles_->display, handles_->context);
  --surfaceless_contexts;
}

core::Result<std::unique_ptr<EglContext>> EglContext::make() {
  const auto missing = [](const char* what) {
    return core::Error{core::Errc::unavailable, std::string("off-screen view: ") + what};
  };
  auto handles = std::make_unique<Handles>();
  handles->display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (handles->display == EGL_NO_DISPLAY || !eglInitialize(handles->display, nullptr, nullptr))
    return missing("EGL has no surfaceless display (packages libegl1, libgl1-mesa-dri)");
  if (!eglBindAPI(EGL_OPENGL_API)) return missing("EGL offers no desktop OpenGL");
  const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                           EGL_NONE};
  EGLint count = 0;
  if (!eglChooseConfig(handles->display, wanted, &handles->config, 1, &count) || count == 0)
    handles->config = nullptr;
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                            3,
                            EGL_CONTEXT_MINOR_VERSION,
                            3,
                            EGL_CONTEXT_OPENGL_PROFILE_MASK,
                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                            EGL_NONE};
  handles->context = eglCreateContext(handles->display, handles->config, EGL_NO_CONTEXT, version);
  if (handles->context == EGL_NO_CONTEXT) return missing("no OpenGL 3.3 context");
  std::unique_ptr<EglContext> made(new EglContext(std::move(handles)));
  if (!made->make_current()) return missing("the context cannot be made current");
  return made;
}

bool EglContext::make_current() const {
  return eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles_->context) ==
         EGL_TRUE;
}

void* EglContext::display() const { return handles_->display; }
void* EglContext::config() const { return handles_->config; }
void* EglContext::context() const { return handles_->context; }

}  // namespace tractus::view
