/// A rig's measurements held against a rig's model: all that the lab's engine knows of either.
#pragma once

#include "lab/identify/formula_terms.hpp"
#include "lab/identify/parameter_space.hpp"
#include "lab/identify/recorded_trials.hpp"
#include "lab/identify/residual_model.hpp"
#include "lab/settings.hpp"

namespace tractus::lab {

/// Const methods may be called from several threads at once.
class Problem : public RecordedTrials, public ParameterSpace, public ResidualModel {
 public:
  virtual const SelectionThresholds& selection_thresholds() const = 0;
  /// Null where no formulas are searched for.
  virtual const FormulaTerms* formula_terms() const { return nullptr; }
};

}  // namespace tractus::lab
