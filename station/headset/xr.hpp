/// OpenXR as this folder uses it: the core header, and its answers in words.
#pragma once

#include <openxr/openxr.h>

#include <string>

#include "core/result.hpp"

namespace tractus::headset {

/// "XR_ERROR_SESSION_LOST"
std::string name_of(XrResult result);

/// One line for a person: what was asked, what the runtime answered. Errc::unavailable.
core::Error refused(const char* what, XrResult result);

/// A runtime's struct, zeroed but for its type.
template <class T>
T typed(XrStructureType type) {
  T made{};
  made.type = type;
  return made;
}

}  // namespace tractus::headset
