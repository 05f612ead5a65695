/// Posterior probabilities over the structures that were fitted, and which of them these recordings
/// cannot separate.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/identify/selection.hpp"

namespace tractus::lab {

/// Is a whitened mean square so near to 1 that nothing remains to be explained? `before`: the mean
/// square of the given model.
bool at_floor(const Problem& problem, double mean_square, double before);
/// Is enough of what the given model left explained to name effects at all?
bool explains(double mean_square, double before);

/// Probabilities over the structures that were fitted, proportional to e^(−cost). Some probability is
/// reserved for physics that no catalogue has: the more, the larger the residual above the floor.
class StructurePosterior {
 public:
  StructurePosterior(const Residual& residual, const Selection& selection, const Solution& chosen);

  /// Probability that the missing effect is in no catalogue.
  double outside() const { return outside_; }
  double of_structure(const Structure& structure) const;
  /// Of all structures with that effect.
  double of_effect(const std::string& id) const;
  /// Pairs of an effect named and one that does nearly as well in its place.
  std::vector<std::pair<std::string, std::string>> confounded() const;
  std::optional<DiscriminatingExperiment> discriminating_experiment(
      const ParameterSpace& space) const;

 private:
  struct Entry {
    Structure structure;
    double probability = 0.0, mean_square = 0.0;
  };
  std::vector<Entry> entries_;  // most probable first
  Structure chosen_;
  double outside_ = 0.0;
};

}  // namespace tractus::lab
