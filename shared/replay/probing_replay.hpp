/// A recorded probing replayed through a model, both ways: the push that its motion asks for, and
/// the motion that its push makes.
#pragma once

#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"
#include "models/probing_runtime.hpp"
#include "plot/figure.hpp"
#include "trial/probing_set.hpp"

namespace tractus::replay {

/// A model's answer to one recording, at the recording's times.
struct ProbingReplayed {
  /// The recorded motion made smooth and differentiated (lab::prepare), from which forces follow.
  models::ProbingMotion motion;
  models::ProbingForces forces;  ///< what the sensor would have said; fz_N empty if the rig turns
  /// Depth to which the recorded push would have driven the model from where the recording begins,
  /// effects of the sensor left out; the stage turns as recorded, or all the time where no angle
  /// was. Empty if no push was recorded.
  std::vector<double> live_x_m;
};

/// Replays one recording. Errors: bad_input naming the file: too few samples, fewer than 50 a
/// second; those of making the model run.
core::Result<ProbingReplayed> replay(const models::ProbingModel& model,
                                     const trial::ProbingMeasurement& recording,
                                     const trial::StatedNoise& noise, const std::string& where);

/// Measured and simulated beside each other, one channel ("fz_N", "tz_Nm" or, of the live
/// direction, "x_m").
struct ProbingRow {
  std::string scope;  ///< "all", "operator", "trial"
  std::string name;
  std::string channel;
  struct Side {
    double mean = 0.0, sd = 0.0, max = 0.0;  ///< max of the amount
  };
  std::size_t samples = 0;
  Side measured, simulated;
  double rmse = 0.0;  ///< of measured − simulated
  double r2 = 0.0;    ///< 1 − rmse² / variance of the measurement; NaN where it does not vary
};

/// Of all, of each operator, of each trial. Vectors go together.
std::vector<ProbingRow> rows(const std::vector<trial::ProbingMeasurement>& recordings,
                             const std::vector<ProbingReplayed>& replayed);
/// Tidy CSV; a number that does not exist is an empty cell.
std::string csv(const std::vector<ProbingRow>& rows);
std::string printed(const std::vector<ProbingRow>& rows);
core::Json to_json(const ProbingRow& row);

/// t_s, the recorded motion and the simulated forces as a probing CSV has them, then what was
/// measured, the speed used, and the live depth.
std::string csv(const trial::ProbingMeasurement& recording, const ProbingReplayed& replayed);

/// The smoothed motion that the forces follow from, as an FMU of the model takes it
/// (fmu/variables.hpp).
std::string motion_csv(const models::ProbingMotion& motion);

/// Push with depth, error, torque, depth as driven by the recorded push, and push against depth.
plot::Figure trial_figure(const trial::ProbingMeasurement& recording,
                          const ProbingReplayed& replayed);

}  // namespace tractus::replay
