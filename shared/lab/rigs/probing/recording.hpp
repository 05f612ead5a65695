/// One trial of the probing rig made ready to be compared: motion smoothed and differentiated,
/// noise estimated, force filtered and thinned.
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "effects/probing_effect.hpp"
#include "lab/identify/judgement.hpp"
#include "lab/settings.hpp"
#include "lab/signal/decimator.hpp"
#include "laws/probing_law.hpp"
#include "trial/probing_set.hpp"

namespace tractus::lab {

inline constexpr const auto& kProbingRecording = kSettings.probing_recording;

/// A motion, and where its speed is too small to tell its direction: the samples, and the motion there with the least
/// speed that would be told. Dry friction may then push either way, or not at all.
struct SampledMotion {
  effects::ProbingMotion motion;
  std::vector<std::size_t> rest;
  effects::ProbingMotion at_rest;
};

struct ProbingRecording : SampledMotion {
  std::string id;
  bool turns = false;                ///< the torque is judged, not the force
  std::vector<double> recorded_x_m;  ///< as it came, for smoothing anew; empty without sliding
  double x_noise_sd_m = 0.0;         ///< of one recorded position
  double x_rounding_sd_m = 0.0;      ///< the part of it that smoothing does not average away
  std::vector<double> x_sd_m, v_sd_m_s, a_sd_m_s2;  ///< standard errors of the smoothed motion
  std::vector<double> theta_sd_rad,
      omega_sd_rad_s;            ///< the same of the turning; empty without an angle
  std::vector<double> measured;  ///< of the primary channel (fz_N, or tz_Nm), full rate
  std::vector<char> saturated;   ///< where the sensor of `measured` stood at the end of its range
  std::vector<double> other;     ///< tz_Nm beside fz_N, or empty
  double noise_sd = 0.0;         ///< of one sample of `measured`
  double slow_noise_sd = 0.0;    ///< of one sample after filter and thinning
  double other_noise_sd = 0.0;
  Decimator decimator{1.0, 1.0};
  std::vector<double> measured_thin;  ///< filtered and thinned
  // What a border or a poorly known motion makes of an output; set by weigh().
  std::vector<double> sd_thin;       ///< expected of each output under a true model
  std::vector<Judgement> judgement;  ///< full rate
  double floor = 0.0;  ///< rmse of the judged samples under a true model without effects

  double seconds() const { return motion.t_s.back() - motion.t_s.front(); }
  std::size_t size() const { return motion.t_s.size(); }
};

/// What a fit predicts for: of a recording that is faster than need be only every n-th sample, with the filter for those.
struct FitSamples : SampledMotion {
  Decimator decimator{1.0, 1.0};
};
FitSamples fit_samples(const ProbingRecording& recording);

/// Prepares a trial, which is used up. @param turns  compare the torque of the turning stage, not the force. @param borders_m  of the given model's layers. Errors: bad_input naming the trial: too few samples, too slow, no motion.
core::Result<ProbingRecording> prepare(trial::ProbingMeasurement&& trial,
                                       const trial::StatedNoise& stated, bool turns,
                                       std::span<const double> borders_m, const std::string& where);

/// Marks in each recording of a set the samples at which the sensor of `measured` stood at the end of its range: that of the set,
/// which few samples of each recording reach, or its own, where the sensor was zeroed before each.
void mark_saturated(std::span<ProbingRecording> recordings);

/// Smooths the recorded positions, with breaks where they pass a border of layers: speed and acceleration may
/// jump there. The moment of passing is where the smoothed motion before it reaches the border.
/// @param borders_m  of the model.
void set_motion(ProbingRecording& recording, std::span<const double> borders_m);

/// Where layers begin and end.
std::vector<double> borders_of(std::span<const laws::Layer> layers);

/// What lies outside ± of what dry friction at rest may do: exactly 0 within.
inline double beyond(double residual, double half_width) {
  const double size = std::abs(residual) - half_width;
  return size <= 0.0 ? 0.0 : residual < 0.0 ? -size : size;
}

/// Estimates the noise anew from what a fit left over: noise that is coloured shows there at low frequency too, where the
/// force itself hides it. Never below what single samples say.
/// @param residual  measured − predicted at the full rate, N. @param thin  the same after filter and thinning, N.
void estimate_noise(ProbingRecording& recording, std::span<const double> residual,
                    std::span<const double> thin);

/// What is expected of each output if `law` were true: the sensor's noise, the motion's noise as
/// the law passes it on, and near a border of layers the error of a sample that is taken on the
/// wrong side. @param by_effects  variance of each sample by what the motion's noise makes of the model's effects.
void weigh(const laws::ProbingLaw& law, std::span<const double> by_effects,
           ProbingRecording& recording);

}  // namespace tractus::lab
