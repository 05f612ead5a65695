#include "station/headset/xr.hpp"

#include <fmt/format.h>
#include <openxr/openxr_reflection.h>

namespace tractus::headset {

std::string name_of(XrResult result) {
  switch (result) {
#define TRACTUS_XR_NAME(name, value) \
  case name:                         \
    return #name;
    XR_LIST_ENUM_XrResult(TRACTUS_XR_NAME)
#undef TRACTUS_XR_NAME
  }
  return fmt::format("XrResult {}", static_cast<int>(result));
}

core::Error refused(const char* what, XrResult result) {
  return {core::Errc::unavailable, fmt::format("headset: {}: {}", what, name_of(result))};
}

}  // namespace tractus::headset
