/// Lengths and points as people type them: millimetres, or with the unit written out.
#pragma once

#include <string>

#include "core/result.hpp"
#include "math/geometry.hpp"

namespace tractus::commands {

/// "1.5", "1.5mm", "1.5 mm" or "0.0015m" → m. `option` leads the message. Errors: bad_input.
core::Result<double> length_m(const std::string& text, const std::string& option);

/// "45.5,200,-61" (mm), "45.5,200,-61 mm" or "0.0455,0.2,-0.061 m" → m. Errors: bad_input.
core::Result<math::Vec3> point_m(const std::string& text, const std::string& option);

}  // namespace tractus::commands
