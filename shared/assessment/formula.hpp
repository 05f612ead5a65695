/// Model formulas: "y ~ x + scenario * C(repetition) + I(x^2) + (1|surgeon)".
///
///     response ~ term + term …      response: a column, or successes/trials for counts, where
///                                   trials is a column or a number
///     term: variable · a:b (interaction) · a*b (a + b + a:b) · 1 · 0 (no intercept) ·
///           (1|column), a random intercept per group ·
///           (1 + x | a), (0 + x | a), (1 | a:b), (1 | a/b) = (1 | a) + (1 | a:b), several of them:
///           random terms as lme4 writes them, of numeric columns x, for 'lmm' and
///           'logistic'
///     variable: a column (text columns become factors) · C(column) or factor(column) ·
///           I(column^2) … I(column^9) · log(column) · `a name with blanks`
#pragma once

#include <string>
#include <vector>

#include "assessment/table.hpp"
#include "statistics/regression/design.hpp"

namespace tractus::assessment {

/// A column as it enters a model.
struct Variable {
  enum class As { itself, factor, power, log };
  std::string column;
  As as = As::itself;
  int exponent = 1;

  std::string name() const;  ///< "x", "I(x^2)", "log(x)"
  bool operator==(const Variable&) const = default;
};

/// A product of variables, one for a main effect.
struct Term {
  std::vector<Variable> variables;

  std::string name() const;  ///< "a:b"
  /// Does it hold every variable of `other`?
  bool contains(const Term& other) const;
  bool operator==(const Term& other) const { return contains(other) && other.contains(*this); }
};

/// (1 + trial | surgeon): what varies between the levels of one or more columns together.
struct RandomEffects {
  bool intercept = true;
  std::vector<std::string> slopes;   ///< numeric columns
  std::vector<std::string> columns;  ///< whose combinations are the levels

  std::string group() const;  ///< "surgeon", "surgeon:day"
  bool operator==(const RandomEffects&) const = default;
};

struct Formula {
  std::string response;
  std::string trials;        ///< a column, or empty
  double trials_number = 1;  ///< where `trials` is empty
  std::vector<Term> terms;   ///< main effects before their interactions
  bool intercept = true;
  std::string group;  ///< of (1|group) where that is the one random term, else empty
  std::vector<RandomEffects> random;  ///< where it is not: all random terms

  /// Every column it names, each once.
  std::vector<std::string> columns() const;
  /// The columns of its main effects, in order.
  std::vector<std::string> factors() const;
};

/// Errors: bad_input naming the place in the formula.
core::Result<Formula> parse_formula(const std::string& text);

/// Labels of a column: its texts, ordered as numbers where all are numbers, else alphabetically.
std::vector<std::string> levels_of(const Table& table, const std::string& column);
/// For each row the place of its label among `levels`.
std::vector<std::size_t> places_of(const Table& table, const std::string& column,
                                   const std::vector<std::string>& levels);

/// The fixed part as a design, and which term each column belongs to.
struct ModelMatrix {
  statistics::Design design;
  std::vector<int> term_of;  ///< per column: index into terms, −1 for the intercept
};

/// A factor becomes one 0/1 column "scenario[hard]" per level but the first; within a term it gets
/// every level where the term without it is not in the model, so that the columns span the same
/// space as the cells (the rule of Wilkinson & Rogers 1973 as R applies it). Products of columns
/// make interactions. Errors: bad_input for text where a number is needed, a logarithm of what is
/// not positive, a factor of one level or of more than 200, over 2000 columns.
core::Result<ModelMatrix> model_matrix(const Formula& formula, const Table& table);

}  // namespace tractus::assessment
