/// The dimension of a quantity: what a user's formula is checked with.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace tractus::effects {

/// Powers of metre, kilogram and second; an angle has none (rad = 1). Powers may be fractions, as
/// of a root: they are kept in sixtieths, so halves, thirds, quarters, fifths and tenths are exact.
class Dimension {
 public:
  constexpr Dimension() = default;
  /// A unit as people write it: "N*s^2/m^2", "1/m", "rad/s", "N·m", "1". Units: m kg s N Pa J W Hz
  /// rad; a power may be a multiple of 1/60, as in "N*s^0.4/m^0.4". Errors: bad_input naming the part that is no unit.
  static core::Result<Dimension> parse(std::string_view unit);

  bool plain() const noexcept { return *this == Dimension(); }  ///< of a number without unit
  /// Powers of metre, kilogram and second; nothing where one is a fraction.
  std::optional<std::array<int, 3>> whole_powers() const noexcept;
  /// As "N*s/m", "1" for none; by N, but for kg alone.
  std::string text() const;

  Dimension operator*(const Dimension& other) const noexcept;
  Dimension operator/(const Dimension& other) const noexcept;
  /// Nothing where the power is not a multiple of 1/60 or beyond ±100.
  std::optional<Dimension> power(double exponent) const;
  bool operator==(const Dimension&) const = default;

 private:
  enum { kMetre, kKilogram, kSecond };
  constexpr Dimension(int metre, int kilogram, int second) : sixtieths_{metre, kilogram, second} {}
  std::array<int, 3> sixtieths_{};
};

}  // namespace tractus::effects
