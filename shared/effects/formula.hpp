/// A user's formula: its grammar and its units. What it evaluates to is FormulaProgram's.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "effects/dimension.hpp"

namespace tractus::effects {

/// A name that a formula may use, with its dimension.
struct Quantity {
  std::string name;
  Dimension dimension;
};

/// What the check of a formula found out.
struct FormulaFacts {
  std::vector<bool> uses;      ///< by quantity: does the formula name it?
  std::vector<bool> vanishes;  ///< by quantity: is the result surely 0 where it is 0?
};

/// Reads a formula and derives the dimension of every part of it.
///
///     choice  = either ["?" choice ":" choice]          comparisons and choices make laws by
///     pieces either  = both {"||" both}        both = compared {"&&" compared} compared = sum
///     {("<"|">"|"<="|">="|"=="|"!=") sum} sum     = product {("+"|"-") product}             one
///     dimension on both sides product = signed {("*"|"/") signed} signed  = ("-"|"+") signed |
///     primary ["^" signed] a power of a dimension is a plain number primary = number | name |
///     function "(" choice {"," choice} ")" | "(" choice ")"
///
/// Functions: abs sqrt sign (sgn) min max exp ln sin cos tan asin acos atan sinh cosh tanh;
/// constant: pi. The number 0 fits every dimension. At most 1000 characters, nested some 50 deep.
/// Errors: bad_input naming the part: "`x_m + v_m_s`: m and m/s".
core::Result<FormulaFacts> check_formula(std::string_view formula,
                                         std::span<const Quantity> quantities,
                                         const Dimension& expected);
/// Is it a name that quantities may have: letters, digits, _, not a function's or a constant's?
bool is_free_name(std::string_view name);

/// A checked formula made ready to evaluate, by muParser.
class FormulaProgram {
 public:
  /// Errors: bad_input with muParser's words.
  static core::Result<FormulaProgram> make(const std::string& formula,
                                           std::span<const Quantity> quantities);
  FormulaProgram(FormulaProgram&&) noexcept;
  FormulaProgram& operator=(FormulaProgram&&) noexcept;
  ~FormulaProgram();

  /// Where the quantities' values are put, in their order.
  std::span<double> inputs() const noexcept;
  /// The value at the present inputs; 0 where it is not finite. Allocates nothing and never throws;
  /// one thread at a time.
  double value() const noexcept;
  /// How often `value` met what is not finite, on this thread, by any program, since it began: who
  /// asks before and after a replay learns whether it was sound.
  static std::uint64_t times_not_finite() noexcept;

 private:
  struct Parts;
  explicit FormulaProgram(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace tractus::effects
