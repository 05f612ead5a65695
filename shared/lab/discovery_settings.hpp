/// The numbers of the search for formulas: a part of settings.hpp, which says what the last words mean.
#pragma once

#include <cstddef>

namespace tractus::lab {

/// The formulas that a search tries.
struct GrammarSettings {
  /// A fit may move a number of a factor by this factor to both sides. Prior.
  double number_reach = 30.0;
  /// Ripples along the depths recorded, at most. Bound.
  double most_waves = 30.0;
};

/// The search for a formula.
struct DiscoverySettings {
  /// Formulas whose held-out errors are reported beyond those proposed. Bound.
  std::size_t spare = 2;
  /// Draws of the weights of trials for probabilities and stability. Bound.
  std::ptrdiff_t bootstraps = 400;
  /// A mean square of the whitened residual below this says nothing more: the noise is known no better. Tuned.
  double least_variance = 0.3;
  /// Neighbours over which a correlation is followed. Bound.
  std::ptrdiff_t most_correlation = 200;
  /// A term of which the model's own numbers imitate all but this share adds nothing. Tuned.
  double least_own_share = 2e-3;
  /// An amplitude is believed to make at most so many times the residual's size. Prior.
  double most_amplitude = 3.0;
  /// Of a number without prior, this share of one residual's information is believed. Numeric.
  double vague = 1e-3;
  /// Formulas that are refitted in full after the screen. Bound.
  std::size_t refitted = 8;
  /// Of those, to which a second term is added. Bound.
  std::size_t extended = 1;
  /// Second terms tried on each. Bound.
  std::size_t second_terms = 4;
  /// A mean square below this leaves nothing for a second term. Tuned.
  double enough = 1.3;
  /// A formula must lower the error on this share of the held-out trials. Tuned.
  double least_trials = 0.8;
  /// What leaves more than so many noise floors on held-out trials is likelier only near the truth. Tuned.
  double far_from_floor = 4.0;
  /// And is never stated above this. Prior.
  double most_if_far = 0.5;
  /// Knots of an unknown function of one signal. Bound.
  int knots_of_one = 20;
  /// And of each of two. Bound.
  int knots_of_two = 7;
  /// A formula returns no more work than this share of what it turns over. Numeric.
  double active_share = 1e-3;
};

}  // namespace tractus::lab
