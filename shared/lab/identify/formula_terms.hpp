/// What a search for formulas asks of a rig: the signals that a formula may name, and what a force
/// added to the law does to the residual.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "effects/expression.hpp"
#include "lab/identify/parameter_space.hpp"
#include "lab/identify/user_effects.hpp"

namespace tractus::lab {

class Problem;

/// A trial at the full rate as a formula sees it.
struct FormulaSignals {
  std::vector<std::vector<double>>
      states;  ///< in the order of ExpressionRig::states; empty: not recorded
  std::vector<effects::MemoryStep> steps;  ///< one per sample
};

/// Const methods may be called from several threads at once.
class FormulaTerms {
 public:
  virtual ~FormulaTerms() = default;

  virtual const effects::ExpressionRig& expressions() const = 0;
  /// @param structure, values  what the law is there: base_N is its.
  virtual FormulaSignals signals(const Structure& structure, std::span<const double> values,
                                 int trial) const = 0;
  /// The change of the whitened residual where `added`, N by sample, adds to the law's force:
  /// through the filter and the weights of ResidualModel::residuals.
  virtual void response(const Structure& structure, int trial, std::span<const double> added,
                        Eigen::Ref<Eigen::VectorXd> out) const = 0;
  /// By residual: is no moment of standstill in it, at which dry friction may take any value?
  virtual std::vector<bool> moving(int trial) const = 0;
  /// Work that the formulas of the structure take from the hand over the last of three slow and of
  /// three fast cycles through the depths recorded, J, the lesser of the two; and the sum of its
  /// amounts, to compare it with.
  struct Work {
    double taken_J = 0.0, turned_over_J = 0.0;
  };
  virtual Work work_of_cycles(const Structure& structure, std::span<const double> values) const = 0;
  /// The same problem with more effects to choose from.
  virtual std::unique_ptr<Problem> with(UserEffects more) const = 0;
};

}  // namespace tractus::lab
