/// A user's formula: its grammar and its units. What it evaluates to is FormulaProgram's.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "effects/dimension.hpp"
#include "effects/memory_operator.hpp"

namespace tractus::effects {

/// A name that a formula may use, with its dimension.
struct Quantity {
  std::string name;
  Dimension dimension;
};

/// A call of a memory operator in a formula's text.
struct MemoryCall {
  MemoryOperator which;
  std::size_t from, to;  ///< its characters
  std::vector<std::pair<std::size_t, std::size_t>> arguments;
};

/// What the check of a formula found out.
struct FormulaFacts {
  Dimension dimension;               ///< of the result
  std::vector<bool> uses;            ///< by quantity: does the formula name it?
  std::vector<bool> vanishes;        ///< by quantity: is the result surely 0 where it always is 0?
  std::vector<MemoryCall> memories;  ///< those inside another's arguments before it
};

/// Reads a formula and derives the dimension of every part of it; the whole must have the one that
/// is expected, if one is.
///
///     choice   = either ["?" choice ":" choice]
///     either   = both {"||" both}              both     = compared {"&&" compared}
///     compared = sum {("<"|">"|"<="|">="|"=="|"!=") sum}
///     sum      = product {("+"|"-") product}   product  = signed {("*"|"/") signed}
///     signed   = ("-"|"+") signed | primary ["^" signed]
///     primary  = number | name | function "(" choice {"," choice} ")" | "(" choice ")"
///
/// Comparisons and choices make laws by pieces; a sum has one dimension on both sides; a power of a
/// dimension is a plain number.
/// Functions: abs sqrt sign (sgn) min max exp ln sin cos tan asin acos atan sinh cosh tanh;
/// constant: pi; the memory operators of memory_operator.hpp, six at most. The number 0 fits every dimension. At most 1000 characters, nested some 50 deep.
/// Errors: bad_input naming the part: "`x_m + v_m_s`: m and m/s", and for a name that is none the
/// nearest that is one.
core::Result<FormulaFacts> check_formula(std::string_view formula,
                                         std::span<const Quantity> quantities,
                                         const std::optional<Dimension>& expected);
/// Is it a name that quantities may have: letters, digits, _, not a function's or a constant's?
bool is_free_name(std::string_view name);

/// A checked formula made ready to evaluate, by muParser.
class FormulaProgram {
 public:
  /// Errors: bad_input with muParser's words.
  /// @param memories  of the formula's facts.
  static core::Result<FormulaProgram> make(const std::string& formula,
                                           std::span<const Quantity> quantities,
                                           std::span<const MemoryCall> memories = {});
  FormulaProgram(FormulaProgram&&) noexcept;
  FormulaProgram& operator=(FormulaProgram&&) noexcept;
  ~FormulaProgram();

  /// Where the quantities' values are put, in their order.
  std::span<double> inputs() const noexcept;
  /// The value at the present inputs; 0 where it is not finite. Allocates nothing and never throws;
  /// one thread at a time.
  double value() const noexcept;
  /// The same of a formula that remembers: moves its memory on to this moment. The first moment that
  /// a memory sees is where its operators start.
  double value(const MemoryStep& step, FormulaMemory& memory) const noexcept;
  bool remembers() const noexcept;
  /// How often `value` met what is not finite, on this thread, by any program, since it began: who
  /// asks before and after a replay learns whether it was sound.
  static std::uint64_t times_not_finite() noexcept;

 private:
  struct Parts;
  explicit FormulaProgram(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace tractus::effects
