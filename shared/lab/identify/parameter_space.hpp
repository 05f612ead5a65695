/// The structures that may be tried and the numbers that a fit of each may move.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"
#include "effects/effect.hpp"

namespace tractus::lab {

/// What is added to the given model, by the catalogue's ids, sorted. The model's own effects belong
/// to the base and are not named here.
struct Structure {
  std::vector<std::string> effects;
  bool operator==(const Structure&) const = default;
};

/// One number that a fit may move.
struct Parameter {
  std::string pointer;  ///< "/base/layers/0/stiffness_N_per_m", "coulomb_friction/friction_N"; a
                        ///< component of several ends in its index, "pose_offset/offset_m/0"
  double start, low, high;
  double step;  ///< a change that is felt but small, of the logarithm if logarithmic: the unit of
                ///< finite differences
  bool logarithmic = false;  ///< searched in its logarithm; start and low are then > 0
  bool shape = false;   ///< has no value at which its effect vanishes: tried from several starts
  double off = 0.0;     ///< if it is no shape: where its effect vanishes
  double period = 0.0;  ///< if above 0: so much more is the same, as of an angle
  /// If above 0: the loss is rough in it (the place of a border, which samples cross one by one),
  /// so it is also sought by trial within this of where it is.
  double rough = 0.0;
  /// Standard deviation (of the logarithm, if logarithmic) with which the start is believed before
  /// the data speak; infinite for a parameter of an added effect.
  double prior_sd = std::numeric_limits<double>::infinity();
};

/// An effect of the catalogue seen from this recording.
struct Candidate {
  effects::EffectFacts facts;
  bool possible = true;
  std::string why_not;  ///< if not possible: "theta_rad was not recorded"
};

/// Const methods may be called from several threads at once.
class ParameterSpace {
 public:
  virtual ~ParameterSpace() = default;

  /// The whole catalogue of this rig (with the user's own effects, if any) in the catalogue's
  /// order, without those that the model carries already.
  virtual const std::vector<Candidate>& candidates() const = 0;

  /// The numbers that a fit of this structure moves: base parameters that are not fixed, then the
  /// model's own effects', then the added effects'. Same order for the same structure.
  virtual std::vector<Parameter> parameters(const Structure& structure) const = 0;

  /// Where to begin the search for an effect that is added: one vector per start, its numbers in
  /// the order of its parameters here (those free per trial have none). Of a strength only the
  /// scale counts, the engine estimates it. By default what the effect states, or a grid over the
  /// numbers of shape.
  /// @param residual  whitened, of all trials one under another, before the effect is added.
  virtual effects::Starts starts(std::string_view effect, const Eigen::VectorXd& residual) const;

  /// The given model with these values and the structure's effects added, as a model file.
  virtual core::Json model(const Structure& structure, std::span<const double> values) const = 0;
};

/// Parameters of an effect of the catalogue as a fit moves them: none if it is free per trial.
std::vector<Parameter> parameters_of(const effects::EffectFacts& facts);

/// What to record so that two candidates are told apart, or one shows (`b` empty).
std::string experiment_for(const ParameterSpace& space, std::string_view a, std::string_view b);

/// Does a JSON pointer lie at or below `pattern`, in which `*` stands for every element?
bool covers(std::string_view pattern, std::string_view pointer);

}  // namespace tractus::lab
