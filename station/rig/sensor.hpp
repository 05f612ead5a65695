/// The force and torque sensor under the probe: bias and noise of its own.
#pragma once

#include <cstdint>
#include <random>

namespace tractus::rig {

/// Plausible for a sensor of this range, and ours.
struct SensorParameters {
  double force_bias_sd_N = 0.5;  ///< the bias is drawn once
  double force_noise_N = 0.05;   ///< standard deviation, white, every sample anew
  double torque_bias_sd_Nm = 0.002;
  double torque_noise_Nm = 0.0005;
  double force_range_N = 1000.0;
};

class Sensor {
 public:
  Sensor(const SensorParameters& parameters, std::uint64_t seed);
  void sample(double force_N, double torque_Nm);
  double force_N() const noexcept { return force_N_; }
  double torque_Nm() const noexcept { return torque_Nm_; }
  bool overloaded() const noexcept { return overloaded_; }
  double force_bias_N() const noexcept { return force_bias_N_; }

 private:
  SensorParameters p_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double force_bias_N_, torque_bias_Nm_;
  double force_N_ = 0.0, torque_Nm_ = 0.0;
  bool overloaded_ = false;
};

}  // namespace tractus::rig
