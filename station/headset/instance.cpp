#include "station/headset/instance.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <set>
#include <vector>

#include "core/try.hpp"

namespace tractus {
namespace headset {
namespace {
constexpr const char* kOpenGl = "XR_KHR_opengl_enable";
constexpr const char* kEgl = "XR_MNDX_egl_enable";

/// The extensions the runtime offers. Without a runtime this is the call that says so.
core::Result<std::set<std::string>> offered() {
  std::uint32_t count = 0;
  XrResult result = xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr);
  std::vector<XrExtensionProperties> all(
      count, typed<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES));
  if (XR_SUCCEEDED(result))
    result = xrEnumerateInstanceExtensionProperties(nullptr, count, &count, all.data());
  if (XR_FAILED(result))
    return core::Error{core::Errc::unavailable,
                       fmt::format("headset: no OpenXR runtime answers ({}); start the headset's "
                                   "software, or name its manifest in XR_RUNTIME_JSON",
                                   name_of(result))};
  std::set<std::string> names;
  for (const auto& one : all) names.insert(one.extensionName);
  return names;
}
}  // namespace

core::Result<std::unique_ptr<Instance>> Instance::make() {
  ::setenv("XR_LOADER_DEBUG", "none", 0);  // one line of ours, not the loader's five
  std::unique_ptr<Instance> made(new Instance);
  for (auto step :
       {&Instance::choose_binding, &Instance::create, &Instance::find_system, &Instance::find_eyes})
    TRY((*made.*step)());
  return made;
}

Instance::~Instance() {
  if (handle_) xrDestroyInstance(handle_);
}

core::Result<void> Instance::choose_binding() {
  auto names = TRY(offered());
  if (!names.contains(kOpenGl))
    return core::Error{
        core::Errc::unavailable,
        fmt::format("headset: the runtime takes no OpenGL ({} is missing)", kOpenGl)};
  const char* display = std::getenv("DISPLAY");
  const bool on_x = display && *display;
  binding_ = on_x || !names.contains(kEgl) ? Binding::glx : Binding::egl;
  if (binding_ == Binding::glx && !on_x)
    return core::Error{core::Errc::unavailable,
                       "headset: the runtime takes OpenGL on X alone; set DISPLAY"};
  return {};
}

core::Result<void> Instance::create() {
  auto info = typed<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
  std::strncpy(info.applicationInfo.applicationName, "tractus-station",
               XR_MAX_APPLICATION_NAME_SIZE - 1);
  std::strncpy(info.applicationInfo.engineName, "Tractus", XR_MAX_ENGINE_NAME_SIZE - 1);
  info.applicationInfo.applicationVersion = 1;
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  const std::array names{kOpenGl, kEgl};
  info.enabledExtensionNames = names.data();
  info.enabledExtensionCount = binding_ == Binding::egl ? 2 : 1;
  if (const XrResult result = xrCreateInstance(&info, &handle_); XR_FAILED(result)) {
    handle_ = XR_NULL_HANDLE;
    return refused("the runtime makes no instance", result);
  }
  auto properties = typed<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
  if (XR_SUCCEEDED(xrGetInstanceProperties(handle_, &properties)))
    runtime_ = properties.runtimeName;
  return {};
}

core::Result<void> Instance::find_system() {
  auto wanted = typed<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
  wanted.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  const XrResult result = xrGetSystem(handle_, &wanted, &system_);
  if (result == XR_ERROR_FORM_FACTOR_UNAVAILABLE)
    return core::Error{
        core::Errc::unavailable,
        fmt::format("headset: {} sees no headset; plug it in, switch it on", runtime_)};
  if (XR_FAILED(result)) return refused("the runtime has no headset", result);
  auto properties = typed<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
  if (XR_SUCCEEDED(xrGetSystemProperties(handle_, system_, &properties)))
    device_ = properties.systemName;
  return {};
}

core::Result<void> Instance::find_eyes() {
  constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  std::uint32_t count = 0;
  eyes_.fill(typed<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW));
  XrResult result =
      xrEnumerateViewConfigurationViews(handle_, system_, kStereo, 2, &count, eyes_.data());
  if (XR_FAILED(result) || count != 2)
    return refused("the runtime has no view of two eyes", result);
  std::vector<XrEnvironmentBlendMode> modes(8);
  result = xrEnumerateEnvironmentBlendModes(handle_, system_, kStereo, 8, &count, modes.data());
  if (XR_FAILED(result) || count == 0) return refused("the runtime has no blend mode", result);
  blend_ = modes.front();  // the runtime's own preference comes first
  return {};
}

bool Instance::simulated() const {
  return runtime_.find("SIMULATED") != std::string::npos ||
         device_.find("SIMULATED") != std::string::npos;
}

PFN_xrVoidFunction Instance::function(const char* name) const {
  PFN_xrVoidFunction found = nullptr;
  return XR_SUCCEEDED(xrGetInstanceProcAddr(handle_, name, &found)) ? found : nullptr;
}

XrPath Instance::path(const char* text) const {
  XrPath made = XR_NULL_PATH;
  xrStringToPath(handle_, text, &made);
  return made;
}

}  // namespace headset
}  // namespace tractus
