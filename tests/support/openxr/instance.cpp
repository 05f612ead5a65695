/// Instance, system, views, paths, events.
#include <algorithm>
#include <cstring>
#include <map>

#include "tests/support/openxr/runtime.hpp"

namespace tractus {
namespace fakexr {
namespace {

std::vector<XrExtensionProperties> extensions() {
  std::vector<XrExtensionProperties> out;
  const auto offer = [&](const char* name) {
    XrExtensionProperties one{XR_TYPE_EXTENSION_PROPERTIES, nullptr, {}, 1};
    std::strcpy(one.extensionName, name);
    out.push_back(one);
  };
  if (control().offer_opengl) offer(XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
  if (control().offer_egl) offer(XR_MNDX_EGL_ENABLE_EXTENSION_NAME);
  return out;
}

XrResult XRAPI_CALL enumerate_extensions(const char*, std::uint32_t capacity, std::uint32_t* count,
                                         XrExtensionProperties* out) {
  return fill(extensions(), capacity, count, out);
}

XrResult XRAPI_CALL create_instance(const XrInstanceCreateInfo* info, XrInstance* instance) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (!is(info, XR_TYPE_INSTANCE_CREATE_INFO)) return violation("xrCreateInstance: wrong type");
  if (w.instance) return violation("xrCreateInstance: a second one", XR_ERROR_LIMIT_REACHED);
  const auto offered = extensions();
  for (std::uint32_t i = 0; i < info->enabledExtensionCount; ++i) {
    const std::string name = info->enabledExtensionNames[i];
    if (std::ranges::none_of(offered, [&](const auto& o) { return name == o.extensionName; }))
      return violation("xrCreateInstance: " + name + " is not offered",
                       XR_ERROR_EXTENSION_NOT_PRESENT);
    w.opengl_enabled |= name == XR_KHR_OPENGL_ENABLE_EXTENSION_NAME;
    w.egl_enabled |= name == XR_MNDX_EGL_ENABLE_EXTENSION_NAME;
  }
  w.instance = true;
  ++control().instances;
  *instance = kInstance;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_instance(XrInstance instance) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (instance != kInstance || !w.instance) return violation("xrDestroyInstance: of none");
  if (w.session) violation("xrDestroyInstance: a session is left");
  w.instance = w.opengl_enabled = w.egl_enabled = w.requirements_asked = false;
  w.actions_attached = false;
  w.events.clear();
  w.frame = 0;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL instance_properties(XrInstance, XrInstanceProperties* out) {
  if (!is(out, XR_TYPE_INSTANCE_PROPERTIES)) return violation("xrGetInstanceProperties: type");
  out->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
  std::strcpy(out->runtimeName, "Tractus test runtime, SIMULATED");
  return XR_SUCCESS;
}

XrResult XRAPI_CALL get_system(XrInstance, const XrSystemGetInfo* info, XrSystemId* system) {
  if (!is(info, XR_TYPE_SYSTEM_GET_INFO)) return violation("xrGetSystem: wrong type");
  if (info->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY)
    return XR_ERROR_FORM_FACTOR_UNSUPPORTED;
  if (control().no_system) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
  *system = kSystem;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL system_properties(XrInstance, XrSystemId system, XrSystemProperties* out) {
  if (!is(out, XR_TYPE_SYSTEM_PROPERTIES) || system != kSystem)
    return violation("xrGetSystemProperties: type or system");
  out->systemId = kSystem;
  out->vendorId = 0;
  out->graphicsProperties = {4096, 4096, 16};
  out->trackingProperties = {XR_TRUE, XR_TRUE};
  std::strcpy(out->systemName, "SIMULATED headset");
  return XR_SUCCESS;
}

XrResult XRAPI_CALL view_configurations(XrInstance, XrSystemId, std::uint32_t capacity,
                                        std::uint32_t* count, XrViewConfigurationType* out) {
  return fill(std::vector{XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO}, capacity, count, out);
}

XrResult XRAPI_CALL view_configuration(XrInstance, XrSystemId, XrViewConfigurationType type,
                                       XrViewConfigurationProperties* out) {
  *out = {XR_TYPE_VIEW_CONFIGURATION_PROPERTIES, nullptr, type, XR_FALSE};
  return XR_SUCCESS;
}

XrResult XRAPI_CALL view_configuration_views(XrInstance, XrSystemId system,
                                             XrViewConfigurationType type, std::uint32_t capacity,
                                             std::uint32_t* count, XrViewConfigurationView* out) {
  if (system != kSystem || type != XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO)
    return violation("xrEnumerateViewConfigurationViews: system or type");
  const auto w = static_cast<std::uint32_t>(control().width_px.load());
  const auto h = static_cast<std::uint32_t>(control().height_px.load());
  const XrViewConfigurationView eye{
      XR_TYPE_VIEW_CONFIGURATION_VIEW, nullptr, w, 4096, h, 4096, 1, 4};
  for (std::uint32_t i = 0; i < capacity; ++i)
    if (!is(&out[i], XR_TYPE_VIEW_CONFIGURATION_VIEW))
      return violation("xrEnumerateViewConfigurationViews: wrong type");
  return fill(std::vector{eye, eye}, capacity, count, out);
}

XrResult XRAPI_CALL blend_modes(XrInstance, XrSystemId, XrViewConfigurationType,
                                std::uint32_t capacity, std::uint32_t* count,
                                XrEnvironmentBlendMode* out) {
  return fill(std::vector{XR_ENVIRONMENT_BLEND_MODE_OPAQUE}, capacity, count, out);
}

XrResult XRAPI_CALL requirements(XrInstance, XrSystemId, XrGraphicsRequirementsOpenGLKHR* out) {
  if (!is(out, XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR))
    return violation("xrGetOpenGLGraphicsRequirementsKHR: wrong type");
  out->minApiVersionSupported = XR_MAKE_VERSION(3, 3, 0);
  out->maxApiVersionSupported = XR_MAKE_VERSION(4, 6, 0);
  world().requirements_asked = true;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL string_to_path(XrInstance, const char* text, XrPath* path) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  auto at = std::ranges::find(w.paths, text);
  if (at == w.paths.end()) at = w.paths.insert(at, text);
  *path = static_cast<XrPath>(at - w.paths.begin()) + 1;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL path_to_string(XrInstance, XrPath path, std::uint32_t capacity,
                                   std::uint32_t* count, char* out) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (path == 0 || path > w.paths.size()) return XR_ERROR_PATH_INVALID;
  const std::string& text = w.paths[path - 1];
  *count = static_cast<std::uint32_t>(text.size() + 1);
  if (capacity >= *count) std::strcpy(out, text.c_str());
  return XR_SUCCESS;
}

XrResult XRAPI_CALL result_to_string(XrInstance, XrResult result, char* out) {
  std::strcpy(out, std::to_string(static_cast<int>(result)).c_str());
  return XR_SUCCESS;
}

XrResult XRAPI_CALL poll_event(XrInstance instance, XrEventDataBuffer* out) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (instance != kInstance) return violation("xrPollEvent: of no instance");
  if (!is(out, XR_TYPE_EVENT_DATA_BUFFER)) return violation("xrPollEvent: wrong type");
  if (w.events.empty()) return XR_EVENT_UNAVAILABLE;
  *out = w.events.front();
  w.events.pop_front();
  if (is(out, XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED))
    w.state = reinterpret_cast<XrEventDataSessionStateChanged*>(out)->state;
  return XR_SUCCESS;
}

}  // namespace

PFN_xrVoidFunction instance_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> all{
      {"xrEnumerateInstanceExtensionProperties", as_void(enumerate_extensions)},
      {"xrCreateInstance", as_void(create_instance)},
      {"xrDestroyInstance", as_void(destroy_instance)},
      {"xrGetInstanceProperties", as_void(instance_properties)},
      {"xrGetSystem", as_void(get_system)},
      {"xrGetSystemProperties", as_void(system_properties)},
      {"xrEnumerateViewConfigurations", as_void(view_configurations)},
      {"xrGetViewConfigurationProperties", as_void(view_configuration)},
      {"xrEnumerateViewConfigurationViews", as_void(view_configuration_views)},
      {"xrEnumerateEnvironmentBlendModes", as_void(blend_modes)},
      {"xrGetOpenGLGraphicsRequirementsKHR", as_void(requirements)},
      {"xrStringToPath", as_void(string_to_path)},
      {"xrPathToString", as_void(path_to_string)},
      {"xrResultToString", as_void(result_to_string)},
      {"xrPollEvent", as_void(poll_event)}};
  const auto at = all.find(name);
  return at == all.end() ? nullptr : at->second;
}

}  // namespace fakexr
}  // namespace tractus
