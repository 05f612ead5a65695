/// Posterior probabilities over the structures that were fitted, and which of them these recordings
/// cannot separate.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/identify/selection.hpp"

namespace tractus::lab {

/// Probabilities over the structures that were fitted, by how well each predicts whole trials that it was not fitted to:
/// −n/2 ln S summed over the trials, S what is left there (the geometric mean of the fit's weighted loss and of the primary
/// channel's mean square without weights), n the independent observations that a trial is worth, less the
/// logarithm of the number of structures of that size; averaged over Bayesian bootstraps of the trials [Yao2018,
/// pseudo-BMA+]. A structure has no probability if a simpler one leaves as much but for a share that is not material, or if
/// the trials do not tell an effect of it from none.
class StructurePosterior {
 public:
  StructurePosterior(const Residual& residual, const Selection& selection, const Solution& chosen);

  const Structure& most_probable() const { return entries_.front().structure; }
  /// Among those fitted.
  double of_structure(const Structure& structure) const;
  /// Of all structures with that effect.
  double of_effect(const std::string& id) const;
  /// Those that are left: each of a weight of at least PosteriorSettings::least_left, of those with most weight; the chosen
  /// one first.
  std::vector<Hypothesis> hypotheses(const Selection& selection) const;
  /// Pairs of an effect named and one that does nearly as well in its place.
  std::vector<std::pair<std::string, std::string>> confounded() const;
  std::optional<DiscriminatingExperiment> discriminating_experiment(
      const ParameterSpace& space) const;

 private:
  struct Entry {
    Structure structure;
    double probability = 0.0, mean_square = 0.0;
    double weight = 0.0;      // before what is not material was left out
    Eigen::VectorXd losses;   // by fold, held out
    Eigen::VectorXd squares;  // the same without weights, of the primary channel
    std::optional<double> held_out_rmse = {};
  };
  void leave_out_immaterial(const Residual& residual, const Selection& selection);
  bool simpler(const Structure& one, const Structure& other) const;
  void weigh(const Residual& residual);

  std::vector<Entry> entries_;     // most probable first
  std::vector<Entry> immaterial_;  // without a probability
  Structure chosen_;
  std::map<std::string, std::vector<std::string>>
      parents_;  // simpler effects that one contains as a limit
};

}  // namespace tractus::lab
