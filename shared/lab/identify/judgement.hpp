/// Whether a sample's error counts, and if not, why: one rule for compare, diagnose, fit, report and pages.
#pragma once

#include <array>
#include <cstdint>

#include "core/named.hpp"

namespace tractus::lab {

/// A sample is judged where the motion is known well enough to say what a right model would predict there.
enum class Judgement : std::uint8_t {
  judged,
  at_border,       ///< so near to a border of layers that its side is not known
  unknown_motion,  ///< the motion's own noise would make more error than the sensor's
  saturated,       ///< the sensor stood at the end of its range
  standstill,      ///< dry friction at rest explains any value that was measured
  no_equilibrium,  ///< the model's shank found no rest there
  at_jump,  ///< the model's shank jumps from one rest to another there, or may rest in several places
};
constexpr auto words(Judgement) {
  return std::to_array<core::Word<Judgement>>({
      {Judgement::judged, "judged"},
      {Judgement::at_border, "at a border of layers"},
      {Judgement::unknown_motion, "motion not known well enough"},
      {Judgement::saturated, "sensor at the end of its range"},
      {Judgement::standstill, "at rest within dry friction"},
      {Judgement::no_equilibrium, "no equilibrium of the shank"},
      {Judgement::at_jump, "several equilibria of the shank"},
  });
}
using core::name;

}  // namespace tractus::lab
