/// One palpation made ready to be compared: poses smoothed and differentiated, noise estimated,
/// wrench filtered and thinned.
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "lab/decimator.hpp"
#include "models/palpation_runtime.hpp"
#include "trial/measurement_set.hpp"

namespace lab {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Force and torque one under another, N and N·m, in H.
inline Vec6 stacked(const math::Wrench& wrench) {
  return (Vec6() << wrench.force_N, wrench.torque_Nm).finished();
}

struct PalpationRecording {
  std::string id;
  models::PalpationMotion motion;
  std::vector<math::Vec3> p_sd_m;      ///< standard error of the smoothed position, V
  std::vector<double> turn_sd_rad;     ///< of the smoothed orientation, about any axis
  std::vector<double> v_sd_m_s;        ///< of the smoothed velocity, along any axis
  std::vector<double> omega_sd_rad_s;  ///< of the smoothed turning, about any axis
  std::vector<Vec6> measured;          ///< full rate
  Vec6 noise_sd = Vec6::Zero();        ///< of one sample
  Vec6 slow_noise_sd = Vec6::Zero();   ///< of one output of the decimator
  Decimator decimator{1.0, 1.0};
  Eigen::Matrix<double, 6, Eigen::Dynamic> measured_thin;  // [channel][output]
  // Set by weigh().
  std::vector<math::Vec2> deflection_m;  ///< of a model near the truth: where a search begins
  std::vector<Mat6> whitener;            ///< of each output's residual, lower triangular
  std::vector<double> trusted;           ///< 0 or 1, full rate
  Vec6 floor = Vec6::Zero();             ///< rmse of the trusted samples under a true model
  std::vector<double> field_per_m;       ///< |g| at the tip, where it touches

  std::size_t size() const { return motion.t_s.size(); }
  double seconds() const { return motion.t_s.back() - motion.t_s.front(); }
  Eigen::Index outputs() const { return measured_thin.cols(); }
  /// A prediction filtered and thinned as the measurement was.
  Eigen::Matrix<double, 6, Eigen::Dynamic> thinned(const std::vector<math::Wrench>& wrench_H) const;
};

/// Prepares a trial, which is used up. Errors: bad_input naming the trial: too few samples, too
/// slow.
core::Result<PalpationRecording> prepare(trial::PalpationMeasurement&& trial,
                                         const math::Vec3& down, const std::string& where);

/// What is expected of each output if `runtime` were true: the sensor's noise, the pose's error as
/// the model passes it on, and where the shank snaps from one rest to another the size of the jump,
/// whose moment is known to a few samples only. At the full rate samples are not trusted that lie
/// at such a snap, or where a pressed point moves so slowly along or across its force that the sign
/// is not known (what friction and losses do there is not known either).
/// Follows the shank's rests anew and keeps them.
void weigh(const models::PalpationRuntime& runtime, PalpationRecording& recording);

/// The model's answer to a motion near the recording's, its rests followed from those kept.
void predict(const models::PalpationRuntime& runtime, const PalpationRecording& recording,
             const models::PalpationMotion& motion, models::PalpationAnswer& out);

}  // namespace lab
