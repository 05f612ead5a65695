/// What is asked of the chosen structure after the search.
#include <cmath>

#include "lab/identify/drift_on_motion.hpp"
#include "lab/identify/held_out.hpp"
#include "lab/identify/held_out_fall.hpp"
#include "lab/identify/selection.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

/// How far the places of rest of the base's layers have moved from the model's, root mean square.
/// `count`: of how many.
double moved(const Solution& at, int& count) {
  double sum = 0.0;
  count = 0;
  for (std::size_t k = 0; k < at.values.size(); ++k) {
    const Parameter& p = at.parameters[k];
    if (!p.pointer.starts_with('/') || !p.pointer.ends_with("/equilibrium_m")) continue;
    sum += (at.values[k] - p.start) * (at.values[k] - p.start);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace

/// A trend that is free in every trial can stand in for any slow law. Where it follows the motion
/// it is no sensor's: what it stood in for is left unexplained instead.
void Selection::refuse_trends() {
  for (const Candidate& candidate : residual_.problem().candidates()) {
    const std::string& id = candidate.facts.id;
    if (!candidate.facts.free_per_trial || !contains(chosen().structure, id)) continue;
    if (drift_r2_on_motion(residual_, chosen(), id) <
        residual_.problem().selection_thresholds().drift_r2_on_motion)
      continue;
    const Structure less = minus(chosen().structure, id);
    part(Solution(chosen()), less);
    chosen_ = name(less);
    refused_ = id;
  }
}

/// Weights of a robust fit may hide what an effect makes worse: an effect stays only if the error without weights,
/// on held-out trials, is lower with it.
void Selection::require_lower_error() {
  for (bool dropped = true; dropped && !chosen_.empty();) {
    dropped = false;
    const Solution whole = differentiated(chosen());
    const double with = held_out_rmse(residual_, whole);
    for (const std::string& id : whole.structure.effects) {
      const Structure less = minus(whole.structure, id);
      part(whole, less);
      const Solution without = differentiated(tried_.at(name(less)));
      if (predicts_better(residual_, without, held_out_rmse(residual_, without), whole, with))
        continue;
      chosen_ = name(less);
      dropped = true;
      break;
    }
  }
}

/// What a sensor adds looks, in contact alone, as if every layer were shifted: each by the constant
/// over its stiffness. One constant that brings all of them back to where the model has them is the
/// simpler reading; it is named if it lowers the held-out error too.
void Selection::explain_shifts() {
  for (const Candidate& candidate : residual_.problem().candidates())
    if (candidate.facts.is_bias) explain_shifts_by(candidate.facts.id);
}

void Selection::explain_shifts_by(const std::string& bias) {
  const auto seen = screens_.find(bias);
  if (seen == screens_.end() || !seen->second.excited || contains(chosen().structure, bias)) return;
  int layers = 0;
  const double before_m = moved(chosen(), layers);
  if (layers < 2 || before_m < kSettings.selection.shifted_m) return;
  const Solution from = differentiated(chosen());
  const Solution& with = fitted(from, bias, 1);
  const double after_m = moved(with, layers);
  if (after_m < (layers == 2 ? kSettings.selection.restored_of_two : kSettings.selection.restored) *
                    before_m &&
      with.mean_square() < kSettings.selection.no_worse * from.mean_square()) {
    if (held_out_rmse(residual_, differentiated(with)) < held_out_rmse(residual_, from))
      chosen_ = name(with.structure);
    else
      instead_of_shifts_ = bias;
  }
}

/// In which order they brought most, by the error on held-out trials: the best single of them first.
void Selection::set_order() {
  order_.clear();
  Structure sum;
  for (std::size_t k = 0; k < chosen().structure.effects.size(); ++k) {
    std::string best;
    double least = 0.0;
    for (const std::string& id : chosen().structure.effects) {
      if (contains(sum, id)) continue;
      const Structure next = plus(sum, id);
      if (!tried_.contains(name(next))) part(Solution(chosen()), next);
      const double error = held_out_rmse(residual_, differentiated(tried_.at(name(next))));
      if (best.empty() || error < least) best = id, least = error;
    }
    order_.push_back(best);
    sum = plus(sum, best);
  }
}

}  // namespace lab
}  // namespace tractus
