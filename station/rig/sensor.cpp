#include "station/rig/sensor.hpp"

#include <cmath>

namespace tractus::rig {

Sensor::Sensor(const SensorParameters& parameters, std::uint64_t seed)
    : p_(parameters), random_(seed) {
  force_bias_N_ = p_.force_bias_sd_N * normal_(random_);
  torque_bias_Nm_ = p_.torque_bias_sd_Nm * normal_(random_);
}

void Sensor::sample(double force_N, double torque_Nm) {
  force_N_ = force_N + force_bias_N_ + p_.force_noise_N * normal_(random_);
  torque_Nm_ = torque_Nm + torque_bias_Nm_ + p_.torque_noise_Nm * normal_(random_);
  overloaded_ = !(std::abs(force_N_) <= p_.force_range_N);
}

}  // namespace tractus::rig
