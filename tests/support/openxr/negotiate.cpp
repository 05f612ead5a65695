/// How the loader finds the runtime. The header of this negotiation is not packaged: the two
/// structs are declared here as [OpenXR Loader, "Loader/Runtime negotiation"] has them.
#include <cstdlib>
#include <cstring>

#include "tests/support/openxr/runtime.hpp"

namespace tractus::fakexr {

World& world() {
  static World one;
  return one;
}

Control& control() {
  static Control own;
  static Control* const at = [] {
    const char* path = std::getenv("TRACTUS_OPENXR_TEST");
    Control* mapped = path ? support::mapped_in<Control>(path) : nullptr;
    return mapped ? mapped : &own;
  }();
  return *at;
}

XrResult violation(const std::string& what, XrResult answer) {
  Control& c = control();
  ++c.violations;
  const std::size_t used = std::strlen(c.words), room = sizeof(c.words) - used;
  if (what.size() + 2 < room) std::strcpy(c.words + used, (what + "\n").c_str());
  return answer;
}

namespace {
XRAPI_ATTR XrResult XRAPI_CALL get_proc_addr(XrInstance, const char* name,
                                             PFN_xrVoidFunction* function) {
  *function = nullptr;
  for (auto find :
       {instance_function, session_function, picture_function, space_function, action_function})
    if (!*function) *function = find(name);
  if (std::strcmp(name, "xrGetInstanceProcAddr") == 0) *function = as_void(get_proc_addr);
  return *function ? XR_SUCCESS : XR_ERROR_FUNCTION_UNSUPPORTED;
}

struct LoaderInfo {
  int type;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t lowest_interface, highest_interface;
  XrVersion lowest_api, highest_api;
};
struct RuntimeRequest {
  int type;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t interface;
  XrVersion api;
  PFN_xrGetInstanceProcAddr get_instance_proc_addr;
};
constexpr int kLoaderInfo = 1, kRuntimeRequest = 3;
}  // namespace
}  // namespace tractus::fakexr

namespace fakexr = tractus::fakexr;

extern "C" __attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const fakexr::LoaderInfo* loader, fakexr::RuntimeRequest* request) {
  if (!loader || loader->type != fakexr::kLoaderInfo || !request ||
      request->type != fakexr::kRuntimeRequest || loader->lowest_interface > 1)
    return XR_ERROR_INITIALIZATION_FAILED;
  request->interface = 1;
  request->api = XR_CURRENT_API_VERSION;
  request->get_instance_proc_addr = fakexr::get_proc_addr;
  return XR_SUCCESS;
}
