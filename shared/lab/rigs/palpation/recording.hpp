/// One palpation made ready to be compared: poses smoothed and differentiated, noise estimated, the
/// moments chosen at which a fit looks.
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "lab/identify/judgement.hpp"
#include "models/palpation_runtime.hpp"
#include "trial/measurement_set.hpp"

namespace tractus::lab {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Force and torque one under another, N and N·m, in H.
inline Vec6 stacked(const math::Wrench& wrench) {
  return (Vec6() << wrench.force_N, wrench.torque_Nm).finished();
}

struct PalpationRecording {
  static constexpr double kDead = 1e6;
  std::string id, note;
  models::PalpationMotion motion;      ///< smoothed; every so many-th sample of a fast recording
  std::vector<math::Vec3> p_sd_m;      ///< standard error of the smoothed position, V
  std::vector<double> turn_sd_rad;     ///< of the smoothed orientation, about any axis
  std::vector<double> v_sd_m_s;        ///< of the smoothed velocity, along any axis
  std::vector<double> omega_sd_rad_s;  ///< of the smoothed turning, about any axis
  std::vector<double> a_sd_m_s2;       ///< of the smoothed acceleration, along any axis
  std::vector<Vec6> measured;          ///< as recorded, at the motion's samples
  Vec6 noise_sd = Vec6::Zero();        ///< of one sample; kDead of a channel that says nothing
  std::vector<std::array<bool, 6>>
      saturated;                      ///< per sample, the channels at the end of their range
  std::vector<std::size_t> instants;  ///< the samples that a fit compares
  // Set by weigh().
  std::vector<math::Vec2> deflection_m;  ///< of a model near the truth: where a search begins
  std::vector<Mat6> whitener;            ///< of each instant's residual, lower triangular
  double usual_square = 1.0;             ///< mean of a whitened residual's squares by noise alone
  std::vector<Judgement> judgement;      ///< per sample
  Vec6 floor = Vec6::Zero();             ///< rmse of the judged samples under a true model
  std::vector<double> motion_N;          ///< per sample: of the force, by the motion's errors
  std::vector<double> field_per_m;       ///< |g| at the tip, where it touches

  std::size_t size() const { return motion.t_s.size(); }
  double seconds() const { return motion.t_s.back() - motion.t_s.front(); }
  /// Squares of the noise, 0 of dead channels.
  Vec6 sensor_squares() const {
    return (noise_sd.array() < kDead).select(noise_sd.cwiseAbs2(), Vec6::Zero());
  }
  /// Measured − predicted, 0 of dead channels.
  Vec6 missed(std::size_t sample, const math::Wrench& predicted_H) const {
    return (noise_sd.array() < kDead).select(measured[sample] - stacked(predicted_H), Vec6::Zero());
  }
  /// 0 … size() − 1.
  std::vector<std::size_t> all() const;
};

/// Prepares a trial, which is used up. Of a recording faster than 250 Hz the motion is smoothed at
/// its full rate and then every so many-th sample is kept, as it was measured.
/// @param most_samples  of a longer recording the stretch of so many samples is taken in which the
/// force changes most; `note` says so.
/// Errors: bad_input naming the trial: too few samples, too slow.
core::Result<PalpationRecording> prepare(trial::PalpationMeasurement&& trial,
                                         const math::Vec3& down, const std::string& where,
                                         std::size_t most_samples);

/// Finds the samples at which a channel of the sensor stood at the end of its range, as all recordings tell it.
void mark_saturated(std::span<PalpationRecording> recordings);

/// Every `stride`-th sample is an instant.
void choose_instants(PalpationRecording& recording, std::size_t stride);

}  // namespace tractus::lab
