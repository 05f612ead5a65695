/// A force that is some function of one or two signals, without a formula: a table.
#pragma once

#include <string>
#include <vector>

#include "lab/discover/formula_screen.hpp"

namespace tractus::lab {

struct UnknownFunction {
  std::vector<std::string> signals;  ///< one or two, as in formulas: "x_m", "since_reversal(x_m)"
  std::vector<std::string> units;
  std::vector<std::vector<double>> knots;  ///< by signal
  std::vector<double> force_N;             ///< at the knots; of two signals, the second runs faster
  Evidence evidence;
};

/// Functions of every signal and of pairs of them, straight between knots and held to
/// be smooth, on top of a fitted model; best first.
std::vector<UnknownFunction> unknown_functions(const Residual& residual, const Solution& at,
                                               const FormulaScreen& screen, double correlation);

}  // namespace tractus::lab
