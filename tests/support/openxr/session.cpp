/// The session: its life, its frames, their pace.
#include <chrono>
#include <cmath>
#include <map>
#include <thread>

#include "tests/support/openxr/runtime.hpp"

namespace tractus {
namespace fakexr {

void change(XrSessionState state) {
  XrEventDataBuffer buffer{};
  auto& event = reinterpret_cast<XrEventDataSessionStateChanged&>(buffer);
  event.type = XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED;
  event.session = kSession;
  event.state = state;
  event.time = world().now_ns;
  world().events.push_back(buffer);
}

XrResult missing_session(const char* call) {
  World& w = world();
  if (!w.session) return violation(std::string(call) + ": of no session", XR_ERROR_HANDLE_INVALID);
  return w.lost ? XR_ERROR_SESSION_LOST : XR_SUCCESS;
}

bool tracked() {
  const auto from = control().untracked_from.load(), to = control().untracked_to.load();
  return from == 0 || world().frame < from || world().frame > to;
}

bool context_is_current() {
  const World& w = world();
  void* current = w.context_is_egl ? static_cast<void*>(eglGetCurrentContext())
                                   : static_cast<void*>(glXGetCurrentContext());
  return current && current == w.context;
}

namespace {

bool take_binding(const void* next) {
  World& w = world();
  const auto* base = static_cast<const XrBaseInStructure*>(next);
  if (!base) return false;
  if (base->type == XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR && w.opengl_enabled) {
    const auto& glx = *reinterpret_cast<const XrGraphicsBindingOpenGLXlibKHR*>(base);
    w.context = glx.glxContext;
    w.context_is_egl = false;
    control().binding = 1;
    return glx.xDisplay && glx.glxContext && glx.glxDrawable && glx.glxFBConfig;
  }
  if (base->type == XR_TYPE_GRAPHICS_BINDING_EGL_MNDX && w.egl_enabled) {
    const auto& egl = *reinterpret_cast<const XrGraphicsBindingEGLMNDX*>(base);
    w.context = egl.context;
    w.context_is_egl = true;
    control().binding = 2;
    return egl.display && egl.context && egl.getProcAddress;
  }
  return false;
}

XrResult XRAPI_CALL create_session(XrInstance, const XrSessionCreateInfo* info, XrSession* out) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (!is(info, XR_TYPE_SESSION_CREATE_INFO) || info->systemId != kSystem)
    return violation("xrCreateSession: type or system");
  if (!w.requirements_asked)
    return violation("xrCreateSession: nobody asked which OpenGL is wanted",
                     XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING);
  if (control().refuse_graphics) return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  if (!take_binding(info->next))
    return violation("xrCreateSession: no binding of graphics", XR_ERROR_GRAPHICS_DEVICE_INVALID);
  if (!context_is_current()) violation("xrCreateSession: the context is not current");
  w.session = true;
  w.running = w.exit_asked = w.lost = w.ending = w.waited = w.begun = false;
  change(XR_SESSION_STATE_IDLE);
  change(XR_SESSION_STATE_READY);
  *out = kSession;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_session(XrSession session) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (!w.session || session != kSession) return violation("xrDestroySession: of none");
  if (!w.swapchains.empty()) violation("xrDestroySession: swapchains are left");
  if (!w.spaces.empty()) violation("xrDestroySession: spaces are left");
  if (w.running && !w.lost && !w.ending) violation("xrDestroySession: it runs");
  w.session = w.running = false;
  ++control().sessions_ended;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL begin_session(XrSession, const XrSessionBeginInfo* info) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (const auto bad = missing_session("xrBeginSession"); bad != XR_SUCCESS) return bad;
  if (!is(info, XR_TYPE_SESSION_BEGIN_INFO) ||
      info->primaryViewConfigurationType != XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO)
    return violation("xrBeginSession: type or views");
  if (w.running) return violation("xrBeginSession: it runs", XR_ERROR_SESSION_RUNNING);
  if (w.state != XR_SESSION_STATE_READY)
    return violation("xrBeginSession: before READY", XR_ERROR_SESSION_NOT_READY);
  w.running = true;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL end_session(XrSession) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (const auto bad = missing_session("xrEndSession"); bad != XR_SUCCESS) return bad;
  if (!w.running) return violation("xrEndSession: it does not run", XR_ERROR_SESSION_NOT_RUNNING);
  if (w.state != XR_SESSION_STATE_STOPPING)
    return violation("xrEndSession: before STOPPING", XR_ERROR_SESSION_NOT_STOPPING);
  w.running = w.waited = w.begun = false;
  change(XR_SESSION_STATE_IDLE);
  if (w.exit_asked) change(XR_SESSION_STATE_EXITING);
  // Put on again at once.
  if (!w.exit_asked) change(XR_SESSION_STATE_READY);
  return XR_SUCCESS;
}

void wind_down() {
  for (const auto state :
       {XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_STOPPING})
    change(state);
}

XrResult XRAPI_CALL request_exit(XrSession) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (const auto bad = missing_session("xrRequestExitSession"); bad != XR_SUCCESS) return bad;
  if (!w.running)
    return violation("xrRequestExitSession: it does not run", XR_ERROR_SESSION_NOT_RUNNING);
  w.exit_asked = true;
  wind_down();
  return XR_SUCCESS;
}

/// What happens to the session at this frame; not XR_SUCCESS when it is lost.
XrResult happen() {
  World& w = world();
  Control& c = control();
  if (w.frame == c.lose_session_at) {
    w.ending = true;
    change(XR_SESSION_STATE_LOSS_PENDING);
    return XR_SUCCESS;
  }
  if (w.frame == c.lose_instance_at) {
    w.ending = true;
    XrEventDataBuffer buffer{};
    buffer.type = XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING;
    w.events.push_back(buffer);
  }
  if (w.frame == c.call_fails_at) {
    w.lost = true;
    return XR_ERROR_SESSION_LOST;
  }
  if (w.frame == c.take_off_at) wind_down();
  if (w.frame == c.quit_at) {
    w.exit_asked = true;
    wind_down();
  }
  return XR_SUCCESS;
}

XrTime monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// To the next frame that can still be met, and later when that was commanded.
void keep_pace(XrTime period) {
  World& w = world();
  Control& c = control();
  const XrTime late = w.frame == c.late_at ? XrTime(c.late_by.load()) * period : 0;
  if (!c.paced) {
    w.now_ns += period + late;
    return;
  }
  const XrTime now = monotonic_ns();
  const XrTime passed = std::max<XrTime>(0, (now - w.now_ns) / period);
  w.now_ns += (w.frame == 1 ? now / period * period - w.now_ns : 0);
  if (w.frame > 1) w.now_ns += (passed + 1) * period + late;
  std::this_thread::sleep_for(std::chrono::nanoseconds(std::max<XrTime>(0, w.now_ns - now)));
}

XrResult XRAPI_CALL wait_frame(XrSession, const XrFrameWaitInfo*, XrFrameState* out) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (const auto bad = missing_session("xrWaitFrame"); bad != XR_SUCCESS) return bad;
  if (!is(out, XR_TYPE_FRAME_STATE)) return violation("xrWaitFrame: wrong type");
  if (!w.running)
    return violation("xrWaitFrame: the session does not run", XR_ERROR_SESSION_NOT_RUNNING);
  if (w.waited) return violation("xrWaitFrame: twice without xrBeginFrame");
  ++w.frame;
  if (const auto lost = happen(); lost != XR_SUCCESS) return lost;
  const auto period = static_cast<XrTime>(1e9 / control().rate_Hz);
  keep_pace(period);
  w.shown_at = w.now_ns + 2 * period;
  w.waited = true;
  w.told.clear();
  out->predictedDisplayTime = w.shown_at;
  out->predictedDisplayPeriod = period;
  out->shouldRender = w.state == XR_SESSION_STATE_VISIBLE || w.state == XR_SESSION_STATE_FOCUSED
                          ? XR_TRUE
                          : XR_FALSE;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL begin_frame(XrSession, const XrFrameBeginInfo*) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (const auto bad = missing_session("xrBeginFrame"); bad != XR_SUCCESS) return bad;
  if (!w.waited) return violation("xrBeginFrame: before xrWaitFrame", XR_ERROR_CALL_ORDER_INVALID);
  if (w.begun) violation("xrBeginFrame: the last frame was not ended");
  w.waited = false;
  w.begun = true;
  return XR_SUCCESS;
}

bool same(const XrView& told, const XrCompositionLayerProjectionView& view) {
  const auto& p = told.pose.position;
  const auto& q = told.pose.orientation;
  const auto& a = view.pose.position;
  const auto& b = view.pose.orientation;
  return p.x == a.x && p.y == a.y && p.z == a.z && q.x == b.x && q.y == b.y && q.z == b.z &&
         q.w == b.w && told.fov.angleLeft == view.fov.angleLeft &&
         told.fov.angleRight == view.fov.angleRight && told.fov.angleUp == view.fov.angleUp &&
         told.fov.angleDown == view.fov.angleDown;
}

XrResult check_layer(const XrCompositionLayerProjection& layer) {
  World& w = world();
  if (layer.type != XR_TYPE_COMPOSITION_LAYER_PROJECTION || layer.viewCount != 2)
    return violation("xrEndFrame: a projection of two eyes is expected");
  const Space* space = object_of(w.spaces, layer.space);
  if (!space) return violation("xrEndFrame: no such space", XR_ERROR_HANDLE_INVALID);
  std::array<const Swapchain*, 2> pictures{};
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const XrCompositionLayerProjectionView& view = layer.views[eye];
    pictures[eye] = object_of(w.swapchains, view.subImage.swapchain);
    if (!pictures[eye]) return violation("xrEndFrame: no such swapchain", XR_ERROR_HANDLE_INVALID);
    if (pictures[eye]->acquired >= 0) return violation("xrEndFrame: a picture was not released");
    if (pictures[eye]->released_in != w.frame)
      return violation("xrEndFrame: a picture is not of this frame");
    const XrRect2Di& rect = view.subImage.imageRect;
    if (rect.offset.x < 0 || rect.offset.y < 0 || rect.extent.width <= 0 ||
        rect.offset.x + rect.extent.width > pictures[eye]->width ||
        rect.offset.y + rect.extent.height > pictures[eye]->height)
      return violation("xrEndFrame: outside the picture", XR_ERROR_SWAPCHAIN_RECT_INVALID);
    bool located = false;
    for (const auto& told : w.told)
      located |= told.space == layer.space && same(told.views[eye], view);
    if (!located) return violation("xrEndFrame: an eye is not where it was located");
  }
  look_at(*pictures[0], *pictures[1]);
  ++control().shown;
  if (space->type == XR_REFERENCE_SPACE_TYPE_VIEW) ++control().in_head;
  return XR_SUCCESS;
}

/// SYNCHRONIZED, VISIBLE, FOCUSED: a frame each.
void go_on() {
  World& w = world();
  if (!w.events.empty()) return;
  if (w.state == XR_SESSION_STATE_READY) change(XR_SESSION_STATE_SYNCHRONIZED);
  if (w.state == XR_SESSION_STATE_SYNCHRONIZED) change(XR_SESSION_STATE_VISIBLE);
  if (w.state == XR_SESSION_STATE_VISIBLE) change(XR_SESSION_STATE_FOCUSED);
}

XrResult XRAPI_CALL end_frame(XrSession, const XrFrameEndInfo* info) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (const auto bad = missing_session("xrEndFrame"); bad != XR_SUCCESS) return bad;
  if (!is(info, XR_TYPE_FRAME_END_INFO)) return violation("xrEndFrame: wrong type");
  if (!w.begun) return violation("xrEndFrame: before xrBeginFrame", XR_ERROR_CALL_ORDER_INVALID);
  w.begun = false;
  if (info->displayTime != w.shown_at)
    return violation("xrEndFrame: of another time", XR_ERROR_TIME_INVALID);
  if (info->environmentBlendMode != XR_ENVIRONMENT_BLEND_MODE_OPAQUE)
    return violation("xrEndFrame: blend mode", XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED);
  if (info->layerCount > 1) return violation("xrEndFrame: one layer is expected");
  ++control().frames;
  XrResult result = XR_SUCCESS;
  if (info->layerCount == 1)
    result = check_layer(*reinterpret_cast<const XrCompositionLayerProjection*>(info->layers[0]));
  go_on();
  return result;
}

}  // namespace

PFN_xrVoidFunction session_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> all{
      {"xrCreateSession", as_void(create_session)},
      {"xrDestroySession", as_void(destroy_session)},
      {"xrBeginSession", as_void(begin_session)},
      {"xrEndSession", as_void(end_session)},
      {"xrRequestExitSession", as_void(request_exit)},
      {"xrWaitFrame", as_void(wait_frame)},
      {"xrBeginFrame", as_void(begin_frame)},
      {"xrEndFrame", as_void(end_frame)}};
  const auto at = all.find(name);
  return at == all.end() ? nullptr : at->second;
}

}  // namespace fakexr
}  // namespace tractus
