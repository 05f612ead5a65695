/// What the probing rig's controller was doing: one word for the law, the loop and the file.
#pragma once

#include <cstdint>

#include "core/named.hpp"

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

constexpr auto words(ProbingMode) {
  using enum ProbingMode;
  return std::to_array<Word<ProbingMode>>({{holding, "holding"},
                                           {bone, "bone"},
                                           {resistance, "resistance"},
                                           {breach, "breach"},
                                           {stopped, "stopped"}});
}

}  // namespace tractus::core
