/// What to record next on the palpation rig.
#pragma once

#include <string>
#include <string_view>

namespace tractus::lab {

/// A recording that would show an effect, or separate two (`b` may be empty).
std::string palpation_recording(std::string_view a, std::string_view b);

}  // namespace tractus::lab
