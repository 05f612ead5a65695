/// A structure fitted to a problem: nonlinear least squares over base and effects together.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "lab/identify/problem.hpp"

namespace tractus::lab {

/// One fitted number.
struct Estimate {
  std::string pointer;
  double value = 0.0;
  double sd = 0.0;        ///< standard error; infinite where the data do not inform it
  bool informed = true;   ///< the data say something of it; else it stays where it was
  bool at_bound = false;  ///< it ended at its lowest or highest value
};

struct FitOptions {
  int threads = 2;
  int max_iterations = 40;
  bool held_out = true;  ///< also fit without each trial (or stretch of time) in turn
};

struct TrialError {
  std::string id;
  double rmse = 0.0;           ///< of the primary channel, full rate, judged samples
  double held_out_rmse = 0.0;  ///< by a fit that did not see the trial
};

struct Fit {
  Structure structure;
  std::vector<double> values;        ///< in the order of ParameterSpace::parameters
  std::vector<Estimate> estimates;   ///< one per value
  Eigen::MatrixXd correlation;       ///< [value][value], 0 with those not informed
  double rmse = 0.0;                 ///< of the primary channel over all trials
  double held_out_rmse = 0.0;        ///< NaN when not asked for
  std::vector<double> channel_rmse;  ///< one per RecordedTrials::channels()
  std::vector<TrialError> trials;    ///< one per trial
  Eigen::VectorXd trial_score;       ///< held-out mean squared whitened residual per fold
  double whitened_rms = 0.0;         ///< root mean square of the whitened residuals: 1 at the floor
  double noise_floor = 0.0;          ///< of the primary channel
  std::string folds;                 ///< "trials" or "stretches of time": what was held out
  /// Identifiability in sentences: what is not informed, which numbers are known only together.
  std::vector<std::string> remarks;
  bool converged = false;
};

/// Fits base and effects of `structure` jointly. Errors: bad_input for an unknown effect or one
/// that this recording cannot show; cancelled.
core::Result<Fit> fit(const Problem& problem, const Structure& structure,
                      const FitOptions& options = {}, const core::Progress& progress = {});

}  // namespace tractus::lab
