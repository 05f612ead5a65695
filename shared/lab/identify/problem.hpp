/// A rig's measurements held against a rig's model: all that the lab's engine knows of either.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"
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
  bool shape = false;  ///< has no value at which its effect vanishes: tried from several starts
  double off = 0.0;    ///< if it is no shape: where its effect vanishes
  /// If above 0: the loss is rough in it (the place of a border, which samples cross one by one),
  /// so it is also sought by trial within this of where it is.
  double rough = 0.0;
  /// Standard deviation (of the logarithm, if logarithmic) with which the start is believed before
  /// the data speak; infinite for a parameter of an added effect.
  double prior_sd = std::numeric_limits<double>::infinity();
};

/// One channel that is compared.
struct Channel {
  std::string name;        ///< "fz_N"; palpation's primary "force_N", the norm of the force's error
  double noise_floor = 0;  ///< rmse that a true model would have: the channel's own noise with the
                           ///< motion's noise as it passes through the base model
};

/// An effect of the catalogue seen from this recording.
struct Candidate {
  effects::EffectFacts facts;
  bool possible = true;
  std::string why_not;  ///< if not possible: "theta_rad was not recorded"
};

/// A number that is reported and not fitted.
struct Derived {
  std::string name;
  double value = 0.0, sd = 0.0;  ///< sd for residuals of variance 1
};

/// One trial's error, measured − predicted at the full rate, [channel][sample] in the order of
/// Problem::channels; of a primary that is a norm (force_N) the norm of the error.
struct Residuals {
  std::vector<double> t_s;
  std::vector<std::vector<double>> channels;
  /// 1 inside, 0 where the motion is too poorly known to judge (layer borders, first contact).
  std::vector<double> trusted;
};

/// Named states of one trial at the full rate ("depth_m", "speed_m_s", …), for finding where an
/// error sits and on what it depends: [state][sample], one sample per Residuals::t_s.
struct States {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
};

/// Thresholds of the selection on a rig, as mean squares of the whitened residual: how near to 1 a
/// true model comes there.
struct SelectionThresholds {
  double at_floor = 1.8;              ///< below this nothing is left to explain
  double least_excess_share = 0.001;  ///< of the given model's excess: less is as good as nothing
  double stop_below = 1.25;           ///< below this no further effect is looked for
  double stop_if_given_below =
      0.0;  ///< nor if the given model is below this and no effect betters it
  double least_gain_share = 0.12;  ///< of the mean square, that a further effect must take away
  double least_gain_of_excess = 0.004;   ///< and of the given model's excess
  double observations_per_trial = 12.0;  ///< observations that a trial is worth
  double drift_r2_on_motion =
      0.45;  ///< a trend of which the motion's memory explains this share is no sensor's
};

/// Const methods may be called from several threads at once.
class Problem {
 public:
  virtual ~Problem() = default;

  virtual std::string_view rig() const = 0;
  virtual int trials() const = 0;
  virtual std::string trial_id(int trial) const = 0;
  virtual double seconds(int trial) const = 0;
  /// What was compared; the first is the primary.
  virtual const std::vector<Channel>& channels() const = 0;
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

  virtual Eigen::Index residual_size(int trial) const = 0;
  /// Residuals of one trial (measured − predicted) as the fit sees them: both sides through the
  /// same filter, decimated so that neighbours are nearly independent, divided by the noise that is
  /// expected there, so that a true model leaves variance 1; poorly known stretches weighted down.
  /// Channel after channel, all that the fit uses. What is free per trial is
  /// eliminated here. Same size for every structure.
  virtual void residuals(const Structure& structure, std::span<const double> values, int trial,
                         Eigen::Ref<Eigen::VectorXd> out) const = 0;
  /// Residuals of one trial at points near `values`, as columns, for differences from those at
  /// `values`. A problem whose law has several answers stays with the one it has at `values`. By
  /// default `residuals` at each point.
  virtual void residuals_near(const Structure& structure, std::span<const double> values,
                              const std::vector<std::vector<double>>& points, int trial,
                              Eigen::Ref<Eigen::MatrixXd> out) const;
  /// Are those so cheap that a search should differentiate anew at every step?
  virtual bool differs_cheaply() const { return false; }
  virtual SelectionThresholds selection_thresholds() const { return {}; }
  /// How many numbers per trial `residuals` has eliminated by itself for that structure.
  virtual int free_per_trial(const Structure& structure) const = 0;

  /// Unweighted error at the full rate.
  virtual Residuals full_rate(const Structure& structure, std::span<const double> values,
                              int trial) const = 0;
  virtual States states(int trial) const = 0;

  /// Numbers to report of an effect that are not parameters of the fit: the range of what is free
  /// per trial; empty for all others.
  virtual std::vector<Derived> derived(const Structure& structure, std::span<const double> values,
                                       std::string_view effect) const = 0;
  /// Remarks on the recording itself that belong into every answer: "tz_Nm was not recorded: …".
  virtual const std::vector<std::string>& notes() const = 0;

  /// The given model with these values and the structure's effects added, as a model file.
  virtual core::Json model(const Structure& structure, std::span<const double> values) const = 0;
};

/// Parameters of an effect of the catalogue as a fit moves them: none if it is free per trial.
std::vector<Parameter> parameters_of(const effects::EffectFacts& facts);

/// What to record so that two candidates are told apart, or one shows (`b` empty).
std::string experiment_for(const Problem& problem, std::string_view a, std::string_view b);

}  // namespace tractus::lab
