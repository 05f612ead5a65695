/// The runtime and the headset behind it, found through the OpenXR loader.
#pragma once

#include <array>
#include <memory>

#include "station/headset/xr.hpp"

namespace tractus::headset {

/// How OpenGL is handed over.
enum class Binding {
  glx,  ///< XR_KHR_opengl_enable, Xlib: a station with X
  egl,  ///< XR_KHR_opengl_enable and XR_MNDX_egl_enable: a machine without
};

/// Connection to the active runtime ($XR_RUNTIME_JSON, else as the system names it) and to the
/// head-mounted display that it offers. Two eyes, OpenGL; nothing else is looked for.
class Instance {
 public:
  /// GLX where the runtime takes it and $DISPLAY is set, else EGL where offered. Errors:
  /// unavailable, one line: no runtime, no headset, no OpenGL that we have.
  static core::Result<std::unique_ptr<Instance>> make();
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  XrInstance handle() const { return handle_; }
  XrSystemId system() const { return system_; }
  Binding binding() const { return binding_; }
  const std::string& runtime() const { return runtime_; }  ///< as it calls itself
  const std::string& device() const { return device_; }    ///< the headset's name
  /// Behind the runtime stands no headset: its name says SIMULATED.
  bool simulated() const;
  const std::array<XrViewConfigurationView, 2>& eyes() const { return eyes_; }
  XrEnvironmentBlendMode blend() const { return blend_; }
  /// A function of an extension; null when the runtime has none.
  PFN_xrVoidFunction function(const char* name) const;
  XrPath path(const char* text) const;

 private:
  Instance() = default;
  core::Result<void> choose_binding();
  core::Result<void> create();
  core::Result<void> find_system();
  core::Result<void> find_eyes();

  XrInstance handle_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  Binding binding_ = Binding::glx;
  std::string runtime_, device_;
  std::array<XrViewConfigurationView, 2> eyes_{};
  XrEnvironmentBlendMode blend_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
};

}  // namespace tractus::headset
