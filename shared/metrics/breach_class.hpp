/// The grade that surgeons give a screw's place: by how far it breaches the cortex of the pedicle
/// [Gertzbein1990].
#pragma once

#include "core/named.hpp"

namespace tractus::metrics {

/// A: no breach; B: below 2 mm; C: 2 to below 4 mm; D: 4 to below 6 mm; E: 6 mm or more.
enum class BreachClass { a, b, c, d, e };
constexpr auto words(BreachClass) {
  using enum BreachClass;
  return std::to_array<core::Word<BreachClass>>({{a, "A"}, {b, "B"}, {c, "C"}, {d, "D"}, {e, "E"}});
}

using core::name;

/// @param beyond_m  beyond the cortex's outer face; 0 or less: no breach
constexpr BreachClass breach_class_of(double beyond_m) {
  if (beyond_m <= 0.0) return BreachClass::a;
  if (beyond_m < 0.002) return BreachClass::b;
  if (beyond_m < 0.004) return BreachClass::c;
  return beyond_m < 0.006 ? BreachClass::d : BreachClass::e;
}

}  // namespace tractus::metrics
