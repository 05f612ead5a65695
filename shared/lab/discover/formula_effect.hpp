/// A term of the grammar as a user effect: what fit, replay and station run.
#pragma once

#include <string>
#include <vector>

#include "lab/discover/discovery.hpp"
#include "lab/discover/grammar.hpp"

namespace tractus::lab {

struct FormulaEffect {
  std::string id;
  Term term;
  std::vector<FactorNumber> numbers;
  effects::EffectInstance use;
  effects::EffectFacts facts;  ///< its search starts where the screen found it best
};

/// @param amplitude  to begin with, in the term's unit.
FormulaEffect formula_effect(const std::string& id, const Term& term,
                             const std::vector<Factor>& factors, double amplitude);

/// With the fitted numbers, as an effect of this id. @param fit  of a structure that has it.
ProposedTerm proposed_term(const FormulaEffect& effect, const std::vector<Factor>& factors,
                           const Fit& fit, const std::string& id);

}  // namespace tractus::lab
