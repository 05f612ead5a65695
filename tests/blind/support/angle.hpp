#pragma once

#include <numbers>

namespace blind {

inline constexpr double kTwoPi = 2.0 * std::numbers::pi;  // rad

}  // namespace blind
