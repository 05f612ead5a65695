/// Measured minus predicted, as a fit sees it and at the full rate.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/identify/judgement.hpp"
#include "lab/identify/parameter_space.hpp"

namespace tractus::lab {

/// A number that is reported and not fitted.
struct Derived {
  std::string name;
  double value = 0.0, sd = 0.0;  ///< sd for residuals of variance 1
};

/// One trial's error, measured − predicted at the full rate, [channel][sample] in the order of
/// RecordedTrials::channels; of a primary that is a norm (force_N) the norm of the error.
struct Residuals {
  std::vector<double> t_s;
  std::vector<std::vector<double>> channels;
  std::vector<Judgement> judgement;  ///< one per sample
};

/// Const methods may be called from several threads at once.
class ResidualModel {
 public:
  virtual ~ResidualModel() = default;

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
  /// What `residuals` would leave of each of `stretches` stretches of a trial if what is free per trial were fitted to the
  /// other stretches. Nothing changes where nothing is free.
  virtual void leave_stretches_out(const Structure& /*structure*/, int /*trial*/, int /*stretches*/,
                                   Eigen::Ref<Eigen::VectorXd> /*residual*/) const {}
  /// How many numbers per trial `residuals` has eliminated by itself for that structure.
  virtual int free_per_trial(const Structure& structure) const = 0;

  /// Rmse of the primary's judged samples that a model of this structure and these values would have if it were true:
  /// the sensor's noise and the errors of the motion as that model passes them on.
  virtual double noise_floor(const Structure& structure, std::span<const double> values) const = 0;

  /// Unweighted error at the full rate.
  virtual Residuals full_rate(const Structure& structure, std::span<const double> values,
                              int trial) const = 0;

  /// Which samples of a trial touch nothing, so that the pose's errors make no force there; empty where a rig has no such.
  virtual std::vector<bool> in_free_air(int /*trial*/) const { return {}; }

  /// Numbers to report of an effect that are not parameters of the fit: the range of what is free
  /// per trial; empty for all others.
  virtual std::vector<Derived> derived(const Structure& structure, std::span<const double> values,
                                       std::string_view effect) const = 0;
};

}  // namespace tractus::lab
