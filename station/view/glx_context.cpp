#include "station/view/glx_context.hpp"

#include <GL/glx.h>
#include <GL/glxext.h>

#include <string>

#include "core/try.hpp"

namespace tractus {
namespace view {
namespace {

core::Error missing(const char* what) {
  return {core::Errc::unavailable, std::string("OpenGL on X: ") + what};
}

Display* display_of(const GlxContext::Handles& h) { return static_cast<Display*>(h.display); }
GLXContext context_of(const GlxContext::Handles& h) { return static_cast<GLXContext>(h.context); }

/// A drawing configuration with 8 bits a colour that windows and pixel buffers both take.
GLXFBConfig config_of(Display* display) {
  const int wanted[] = {GLX_RENDER_TYPE,
                        GLX_RGBA_BIT,
                        GLX_DRAWABLE_TYPE,
                        GLX_PBUFFER_BIT | GLX_WINDOW_BIT,
                        GLX_X_RENDERABLE,
                        True,
                        GLX_RED_SIZE,
                        8,
                        GLX_GREEN_SIZE,
                        8,
                        GLX_BLUE_SIZE,
                        8,
                        None};
  int count = 0;
  GLXFBConfig* found = glXChooseFBConfig(display, DefaultScreen(display), wanted, &count);
  GLXFBConfig first = found && count > 0 ? found[0] : nullptr;
  if (found) XFree(found);
  return first;
}

}  // namespace

core::Result<std::unique_ptr<GlxContext>> GlxContext::make() {
  std::unique_ptr<GlxContext> made(new GlxContext);
  TRY(made->open());
  return made;
}

core::Result<void> GlxContext::open() {
  Display* display = XOpenDisplay(nullptr);
  handles_.display = display;
  if (!display) return missing("no X display answers; set DISPLAY");
  GLXFBConfig config = config_of(display);
  if (!config) return missing("the display offers no GLX (packages libgl1, libgl1-mesa-dri)");
  handles_.config = config;
  XVisualInfo* visual = glXGetVisualFromFBConfig(display, config);
  handles_.visual = visual ? static_cast<unsigned>(visual->visualid) : 0;
  if (visual) XFree(visual);
  const int one_pixel[] = {GLX_PBUFFER_WIDTH, 1, GLX_PBUFFER_HEIGHT, 1, None};
  handles_.drawable = glXCreatePbuffer(display, config, one_pixel);
  const auto create = reinterpret_cast<PFNGLXCREATECONTEXTATTRIBSARBPROC>(
      glXGetProcAddressARB(reinterpret_cast<const GLubyte*>("glXCreateContextAttribsARB")));
  const int version[] = {GLX_CONTEXT_MAJOR_VERSION_ARB,
                         3,
                         GLX_CONTEXT_MINOR_VERSION_ARB,
                         3,
                         GLX_CONTEXT_PROFILE_MASK_ARB,
                         GLX_CONTEXT_CORE_PROFILE_BIT_ARB,
                         None};
  if (create) handles_.context = create(display, config, nullptr, True, version);
  if (!handles_.context) return missing("no OpenGL 3.3 context");
  if (!make_current()) return missing("the context cannot be made current");
  return {};
}

GlxContext::~GlxContext() {
  Display* display = display_of(handles_);
  if (!display) return;
  glXMakeContextCurrent(display, None, None, nullptr);
  if (handles_.context) glXDestroyContext(display, context_of(handles_));
  if (handles_.drawable) glXDestroyPbuffer(display, handles_.drawable);
  XCloseDisplay(display);
}

bool GlxContext::make_current() const {
  return glXMakeContextCurrent(display_of(handles_), handles_.drawable, handles_.drawable,
                               context_of(handles_)) == True;
}

}  // namespace view
}  // namespace tractus
