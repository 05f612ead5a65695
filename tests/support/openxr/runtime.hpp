/// What the runtime's files share: its objects, and how it says what was wrong.
#pragma once

#include <EGL/egl.h>
#include <GL/glx.h>

#include <array>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_XLIB
#define XR_USE_PLATFORM_EGL
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include "tests/support/openxr/control.hpp"

namespace tractus::fakexr {

struct Swapchain {
  std::vector<unsigned> textures;
  int width = 0, height = 0;
  std::uint32_t next = 0;
  int acquired = -1, waited = -1, released = -1;  ///< index of an image; -1: none
  std::uint64_t released_in = 0;                  ///< frame
};

struct Space {
  XrReferenceSpaceType type = XR_REFERENCE_SPACE_TYPE_VIEW;
  int hand = -1;  ///< of an action space
};

struct Action {
  XrActionType type;
};

/// One session of one instance at a time.
struct World {
  std::mutex mutex;
  bool instance = false, egl_enabled = false, opengl_enabled = false;
  bool requirements_asked = false, actions_attached = false;
  bool session = false, running = false, exit_asked = false, lost = false;
  bool ending = false;  ///< a loss was announced
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;
  void* context = nullptr;  ///< that the application handed over
  bool context_is_egl = false;
  std::deque<XrEventDataBuffer> events;
  std::set<Swapchain*> swapchains;
  std::set<Space*> spaces;
  std::set<Action*> actions;
  std::vector<std::string> paths;
  std::uint64_t frame = 0;  ///< the one that was waited for
  bool waited = false, begun = false;
  XrTime now_ns = 1'000'000'000, shown_at = 0;
  struct Told {
    XrSpace space;
    std::array<XrView, 2> views;
  };
  std::vector<Told> told;  ///< in this frame
  bool pressed = false, was_pressed = false;
};

World& world();
Control& control();

/// Notes what the application did wrong, and gives `answer`.
XrResult violation(const std::string& what, XrResult answer = XR_ERROR_VALIDATION_FAILURE);

/// A struct's type is what the call takes.
template <class T>
bool is(const T* thing, XrStructureType type) {
  return thing && thing->type == type;
}

template <class Handle, class T>
Handle handle_of(T* object) {
  return reinterpret_cast<Handle>(object);
}

/// The object behind a handle, or null.
template <class T, class Handle>
T* object_of(const std::set<T*>& among, Handle handle) {
  T* object = reinterpret_cast<T*>(handle);
  return among.contains(object) ? object : nullptr;
}

/// The idiom of two calls: how many, then all.
template <class T>
XrResult fill(const std::vector<T>& all, std::uint32_t capacity, std::uint32_t* count, T* out) {
  if (!count) return violation("an enumeration without a count");
  *count = static_cast<std::uint32_t>(all.size());
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < all.size()) return XR_ERROR_SIZE_INSUFFICIENT;
  std::copy(all.begin(), all.end(), out);
  return XR_SUCCESS;
}

inline const XrInstance kInstance = reinterpret_cast<XrInstance>(0x1157);
inline const XrSession kSession = reinterpret_cast<XrSession>(0x5e55);
inline constexpr XrSystemId kSystem = 7;

bool context_is_current();
void change(XrSessionState state);  ///< queued for the application
XrResult missing_session(const char* call);
bool tracked();
bool write_png(const std::string& path, const std::vector<unsigned char>& rgba, int width,
               int height);
/// The last released pictures of a layer: counted, and kept when that is wanted.
void look_at(const Swapchain& left, const Swapchain& right);
/// The function of that name among those of a file; null when it is not there.
PFN_xrVoidFunction instance_function(const std::string& name);
PFN_xrVoidFunction session_function(const std::string& name);
PFN_xrVoidFunction picture_function(const std::string& name);
PFN_xrVoidFunction space_function(const std::string& name);
PFN_xrVoidFunction action_function(const std::string& name);

template <class F>
PFN_xrVoidFunction as_void(F function) {
  return reinterpret_cast<PFN_xrVoidFunction>(function);
}

}  // namespace tractus::fakexr
