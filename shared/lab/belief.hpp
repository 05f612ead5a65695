/// How probable the structures that were fitted are, and which of them these recordings cannot
/// tell apart.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/selection.hpp"

namespace lab {

/// Is a whitened mean square so near to 1 that nothing is left to explain? `before`: of the given
/// model.
bool at_floor(const Problem& problem, double mean_square, double before);
/// Is enough of what the given model left explained to name effects at all?
bool explains(double mean_square, double before);

/// Probabilities over the structures that were fitted: e^(−cost). Some mass is kept for what is in
/// no catalogue: the more is left over the floor, the more.
class Belief {
 public:
  Belief(const Residual& residual, const Selection& selection, const Solution& chosen);

  /// That what is missing is in no catalogue.
  double outside() const { return outside_; }
  double of_structure(const Structure& structure) const;
  /// Of all structures with that effect.
  double of_effect(const std::string& id) const;
  /// Pairs of an effect named and one that does nearly as well in its place.
  std::vector<std::pair<std::string, std::string>> confounded() const;
  std::optional<Settle> settle(const Problem& problem) const;

 private:
  struct Entry {
    Structure structure;
    double probability = 0.0, mean_square = 0.0;
  };
  std::vector<Entry> entries_;  // most probable first
  Structure chosen_;
  double outside_ = 0.0;
};

}  // namespace lab
