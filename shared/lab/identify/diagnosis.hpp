/// Which effect is missing from a model: the answer of the lab's engine.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/named.hpp"
#include "lab/identify/fit.hpp"

namespace tractus::lab {

enum class Verdict {
  complete,     ///< nothing that recorded signals predict is missing, nothing is added
  missing,      ///< the effects found explain the rest
  partly,       ///< effects found, more remains
  unexplained,  ///< something is missing that is not in the catalogue
  undecided,  ///< nothing is seen to be missing, but so much of the force is noise that it says little
};
constexpr auto words(Verdict) {
  using enum Verdict;
  return std::to_array<core::Word<Verdict>>({{complete, "complete"},
                                             {missing, "missing"},
                                             {partly, "partly"},
                                             {unexplained, "unexplained"},
                                             {undecided, "undecided"}});
}
using core::name;

struct FoundParameter {
  std::string name;               ///< as in a model file: "friction_N"
  std::vector<double> value, sd;  ///< one per component
};

struct FoundEffect {
  std::string id;
  double probability = 0.0;
  std::vector<FoundParameter> parameters;
};

/// How small a strength of an effect would have been seen by these recordings.
struct DetectionLimit {
  std::string parameter;        ///< as in a model file, a component with its index: "friction_N"
  std::optional<double> value;  ///< nothing: not even at the end of its range
};

/// An effect of the catalogue by itself on top of the base (or, once some were found, on top of
/// the others found).
struct Ranked {
  std::string id;
  double probability = 0.0;
  std::optional<double> held_out_rmse;  ///< nothing when it was not tried
  std::string note;  ///< "not excited: …", "at the edge of its range", or empty
  std::vector<DetectionLimit> detection_limits = {};  ///< of an effect that is not named
};

/// The error as effects are added one by one, in the order of what they bring.
struct Step {
  std::string model;  ///< "base", "+ coulomb_friction"
  double rmse = 0.0, held_out_rmse = 0.0;
  double noise_floor = 0.0;  ///< the error that a true model of this form would have
};

/// A structure that the data leave, with what it would be then.
struct Hypothesis {
  Structure structure;
  double probability = 0.0;  ///< among all that were fitted
  /// The same before what is not material was left out: what predicts as well as the answer, but no better than something
  /// simpler, has no probability and yet may be true.
  double weight = 0.0;
  std::vector<double> values;
};

struct DiscriminatingExperiment {
  std::vector<std::string> between;  ///< two effects, or one and "nothing"
  std::string recording = {};        ///< what to record, in words
  /// Of the probability of the true one, as simulated recordings say; nothing where none were simulated.
  std::optional<double> expected_gain = {};
};

struct Diagnosis {
  Verdict verdict = Verdict::complete;
  /// That the set of effects named (or none) is right; of `partly` and `unexplained`, that more is
  /// missing than the catalogue names; of `undecided` not a number.
  double probability = 0.0;
  struct {
    double rmse = 0.0, held_out_rmse = 0.0, noise_floor = 0.0;
  } base;
  double floor_share =
      0.0;  ///< noise floor of the final fit over the root mean square of the force; 0: not known
  std::vector<FoundEffect> effects;
  std::vector<Ranked> ranking;  ///< most probable first; the whole catalogue
  std::vector<Step> steps;
  std::vector<std::pair<std::string, std::string>> confounded;
  std::vector<Hypothesis> hypotheses;  ///< those left, most probable first, at most three
  std::optional<DiscriminatingExperiment> discriminating_experiment;
  std::string depends_on;  ///< what an unexplained rest varies with, in words; else empty
  /// Share of the rest's mean square that recorded signals predict in held-out trials; 0 if in too few of them.
  double dependence_explained = 0.0;
  /// Share of its judged squares that laws of physics predict in trials that they were not fitted to (law_dependence.hpp).
  double law_explained = 0.0;
  std::vector<std::string> notes;  ///< on the recording and on how the answer was reached
  Fit base_fit;                    ///< of the model as given
  Fit final_fit;                   ///< with the effects named; the base's when nothing is
};

struct DiagnoseOptions {
  int threads = 2;
  int max_effects = 3;
  std::vector<std::string> only = {};  ///< if not empty: try these effects alone
  bool detection_limits = true;        ///< also of the effects that are not named
  /// Told the ranking once, early: every effect by itself was tried, none together.
  std::function<void(const std::vector<Ranked>&)> early = {};
};

/// Errors: bad_input when there is nothing to judge by (no residuals, an unknown effect asked for);
/// cancelled.
core::Result<Diagnosis> diagnose(const Problem& problem, const DiagnoseOptions& options = {},
                                 const core::Progress& progress = {});

}  // namespace tractus::lab
