/// The formulas that a search tries: products of at most three factors of place, speed, turning and
/// memory, each with at most two numbers in it, and an amplitude whose unit makes newtons of them.
#pragma once

#include <string>
#include <vector>

#include "effects/dimension.hpp"
#include "effects/formula.hpp"

namespace tractus::lab {

/// What the recordings hold, for the values at which a number is tried.
struct SignalScales {
  double least_depth_m = 0.0, most_depth_m = 0.0;
  double slow_m_s = 0.0, fast_m_s = 0.0;  ///< 10 % and 90 % of the moving samples are slower
  double longest_s = 0.0;
  double work_J = 0.0;       ///< done on the bone in a trial, median
  double turning_rad_s = 0;  ///< median amount; 0 where nothing turns
};

/// A number within a factor, at one of the values at which it is tried.
struct FactorNumber {
  std::string name, unit, meaning;
  double value, low, high;
  bool logarithmic = true;
};

enum class FactorPart { place, speed, turning, memory, whole };

/// One factor at one choice of its numbers. `whole` ones stand for place and speed together.
struct Factor {
  FactorPart part;
  std::string text;  ///< in a formula's grammar, ready to stand in a product
  effects::Dimension unit;
  std::vector<FactorNumber> numbers;
  std::string
      words;  ///< what it says in physics, to be joined: "dry friction", "that fades with depth"
  bool odd_in_speed = false;
  bool alone = false;  ///< stands in no product
};

/// The factors of the grammar at every choice of their numbers that these recordings can tell apart.
std::vector<Factor> factors_of(const SignalScales& scales);

/// A product of factors, by their index.
struct Term {
  std::vector<std::size_t> factors;
  std::string family;            ///< the product's text: the same for all choices of its numbers
  effects::Dimension amplitude;  ///< unit of the factor before the product
};

/// Every product of the grammar whose amplitude has a unit of mechanics.
std::vector<Term> terms_of(const std::vector<Factor>& factors);

/// "amplitude * …" with the amplitude's unit and the numbers of all factors.
std::string formula_of(const Term& term);
std::vector<FactorNumber> numbers_of(const Term& term, const std::vector<Factor>& factors);
/// What the product says in physics.
std::string words_of(const Term& term, const std::vector<Factor>& factors);
/// Names with units that a factor's text may use: the rig's states, then its numbers.
std::vector<effects::Quantity> quantities_of(const Factor& factor);

}  // namespace tractus::lab
