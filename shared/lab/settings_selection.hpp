/// The numbers of the choice between structures, of its validation and of the answer; how to read them: settings.hpp.
#pragma once

#include <cstddef>

namespace tractus::lab {

/// The search over structures.
struct SelectionSettings {
  /// Share by which an effect must lower the error on held-out trials, without weights: less is not material, and
  /// small flaws of any motion or sensor make 0.3 to 1 % of it. Bound.
  double least_fall = 0.02;
  /// The same of an effect that is free in each trial: a sensor's cross-talk and slow noise, followed by numbers of each
  /// trial's own, make 3 % of it. Bound.
  double least_fall_of_free = 0.05;
  /// A further effect must lower the loss, 2 nats, by so much for each number added. Tuned.
  double clear_loss = 30.0;
  /// Structures of a size that are grown by one effect. Bound.
  std::size_t grown = 4;
  /// And those with the least mean square. Bound.
  std::size_t grown_by_square = 2;
  /// Effects tried on each. Bound.
  std::size_t tried_on_each = 6;
  /// Start values that are fitted in full. Bound.
  int tries = 2;
  /// The best of a size are fitted to the end before they are compared. Bound.
  std::size_t refined = 3;
  /// If the best of a size leaves a greater mean square, it is begun anew from other shapes. Tuned.
  double reshape_above = 0.9;
  /// So many of each effect. Bound.
  int reshape_tries = 8;
  /// A constant of the sensor replaces shifts of all layers if it leaves less than this share of
  /// them, where there are two layers. Tuned.
  double restored_of_two = 0.05;
  /// And where there are more. Tuned.
  double restored = 0.15;
  /// What counts as a shift. Tuned.
  double shifted_m = 5e-5;
  /// And the mean square may grow by no more than this factor. Tuned.
  double no_worse = 1.1;
  /// The price of a number. Tuned.
  double price_nats = 5.0;
  /// A mean square below this says nothing more: the noise is known no better. Tuned.
  double least_mean_square = 0.02;
  /// Steps to the least strength that would have been seen. Numeric.
  int sensitivity_steps = 4;
};

/// Probabilities over structures.
struct PosteriorSettings {
  /// Within this factor of the chosen structure's excess another is as good. Tuned.
  double as_good = 1.5;
  /// The probability at which no further experiment is recommended. Tuned.
  double settled = 0.95;
  /// Probability that is spread over all structures alike, for what the comparison does not foresee: the share of wrong
  /// names on the development sets. Tuned.
  double unforeseen = 0.02;
  /// From this probability on it is asked whether a structure lowers the unweighted error. Bound.
  double least_asked = 0.002;
  /// From this probability on a structure counts as left, to be told from the others by a further recording. Bound.
  double least_left = 0.03;
  /// So many at most. Bound.
  std::size_t most_left = 3;
  /// Bayesian bootstraps over the trials. Bound.
  int bootstraps = 400;
};

/// Held-out errors and standard errors of a fit.
struct ValidationSettings {
  /// Of fewer trials, stretches of time are held out. Tuned.
  int fewest_trials = 4;
  /// So many over all trials. Tuned.
  int stretches = 8;
  /// What is free per trial is fitted without each of so many stretches of it. Numeric.
  int stretches_of_trial = 24;
  /// Numbers with a greater correlation are reported as known only together. Tuned.
  double known_together = 0.98;
  /// A direction that one fold alone informs to more than this share is not corrected for it.
  /// Numeric.
  double most_of_one_fold = 0.9;
  /// Student's 95 % point over the normal's, squared, to first order in 1/k. Derived.
  double few_clusters = 3.0;
  /// Chance that any effect of a catalogue is named though the base has all. Custom.
  double found_by_chance = 0.05;
  /// A number whose standard error is more than this share of its prior's is not informed by the
  /// data. Tuned.
  double uninformed = 0.95;
};

/// The answer.
struct DiagnosisSettings {
  /// Of fewer trials the answer says that more would help. Tuned.
  std::size_t few_trials = 4;
  /// Signals that predict the rest must do so in this share of the trials. Derived: 8 of 10 have a chance of 5 % by luck.
  double most_trials = 0.8;
  /// So many effects at once more often imitate one that is in no catalogue than they are right. Tuned.
  std::size_t imitating_effects = 3;
  /// Effects are named only if at most this share of what there was to explain is left. Tuned.
  double most_left = 0.25;
  /// Probability that so many only imitate. Tuned.
  double imitation = 0.6;
  /// Nothing can be said to be complete where the noise floor is more than this share of the force. Tuned: of 60 sets of
  /// oscillators all right answers were below 0.11, all at 0.3 and more were wrong.
  double undecided_share = 0.2;
};

}  // namespace tractus::lab
