#pragma once
/// From the fine step to a file: effects of the measurement, sampling, noise, quantisation.
#include <vector>

#include "probing/draw.hpp"

namespace blind {

struct Samples {
  std::vector<double> t_s, x_m, theta_rad, force_N, torque_Nm;
  double floor_N =
      0;  ///< RMS of recorded minus true force: noise and quantisation as they came out
};

/// Torque of the rotary stage at the fine step.
std::vector<double> torque(const Series& series, const Rotary& rotary);

/// The force as a perfect sensor chain with the set's measurement effects would record it, at steps
/// of `step_s`.
std::vector<double> as_recorded(const std::vector<double>& force_N,
                                const std::vector<double>& torque_Nm,
                                const std::vector<HiddenEffect>& effects, std::uint64_t trial_seed,
                                double step_s = kFineStep_s);

/// The motion at the recording's rate, sampled as the record is but free of noise; speed and
/// acceleration by central differences: what the best reader of the file could know of it.
Series sampled_motion(const Series& series, const SetPlan& plan);

Samples sample(const Series& series, const std::vector<double>& force_N,
               const std::vector<double>& torque_Nm, const SetPlan& plan, std::uint64_t trial_seed);

}  // namespace blind
