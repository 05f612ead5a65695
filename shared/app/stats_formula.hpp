/// Model formulas: "y ~ x + scenario + (1|surgeon)".
///
///     response ~ term + term …      response: a column, or successes/trials for counts, where
///                                   trials is a column or a number
///     term: a column (text columns become factors) · factor(column) · 1 · 0 (no intercept) ·
///           (1|column), a random intercept per group
#pragma once

#include <string>
#include <vector>

#include "app/stats_table.hpp"
#include "statistics/design.hpp"

namespace commands {

struct Term {
  std::string column;
  bool factor = false;  ///< written factor(column)
};

struct Formula {
  std::string response;
  std::string trials;        ///< a column, or empty
  double trials_number = 1;  ///< where `trials` is empty
  std::vector<Term> terms;
  bool intercept = true;
  std::string group;  ///< of (1|group), or empty

  /// Every column it names, each once.
  std::vector<std::string> columns() const;
};

/// Errors: bad_input naming the place in the formula.
core::Result<Formula> parse_formula(const std::string& text);

/// Labels of a column: its texts, ordered as numbers where all are numbers, else alphabetically.
std::vector<std::string> levels_of(const Table& table, const std::string& column);

/// The fixed part as a design. A factor becomes one 0/1 column "scenario[hard]" per level but the
/// first. Errors: bad_input for text where a number is needed, a factor of one level or of more
/// than 200.
core::Result<statistics::Design> design_of(const Formula& formula, const Table& table);

}  // namespace commands
