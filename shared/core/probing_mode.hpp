/// What the probing rig's controller was doing: one word for the law, the loop and the file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tractus::core {

/// A byte of every recorded sample: the numbers stay.
enum class ProbingMode : std::uint8_t {
  holding = 0,     ///< the probe turns too slowly: the stage does not move
  bone = 1,        ///< in a layer: eq. (2) of [Probing]
  resistance = 2,  ///< within R_i of a wall, stiffness and damping grown
  breach = 3,      ///< behind a wall: eq. (3); no stiffness, the breach's damping, rotary motor off
  stopped = 4,     ///< at the probe stop
};
inline constexpr int kProbingModes = 5;

/// @param mode  one of those above
constexpr std::string_view name(ProbingMode mode) {
  constexpr std::array<std::string_view, kProbingModes> kNames{"holding", "bone", "resistance",
                                                               "breach", "stopped"};
  return kNames[std::size_t(mode)];
}

}  // namespace tractus::core
