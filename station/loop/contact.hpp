/// What answers the handle's pose with a wrench: the model, as the loop sees it.
#pragma once

#include "models/palpation_runtime.hpp"

namespace tractus::loop {

class Contact {
 public:
  virtual ~Contact() = default;
  /// One tick, called by the loop's thread alone: no allocation, lock or failure.
  /// @param handle  pose and velocities in V; the accelerations are not the device's to know
  /// @param t_s     stamp of the tick
  virtual laws::PalpationStep step(const effects::HandleMotion& handle, double t_s) noexcept = 0;
};

/// The palpation model: the runtime is const, the bending of the last tick and what is known of the
/// handle's acceleration are here.
class PalpationContact final : public Contact {
 public:
  /// `runtime` must outlive this.
  explicit PalpationContact(const models::PalpationRuntime& runtime) : runtime_(runtime) {}
  laws::PalpationStep step(const effects::HandleMotion& handle, double t_s) noexcept override {
    effects::HandleMotion moving = handle;
    const double dt_s = t_s - last_t_s_;
    if (dt_s > 0.0 && dt_s < kLongestTick_s) {
      const double share = dt_s / (dt_s + kSmoothing_s);
      a_m_s2_ += share * ((handle.v_m_s - last_v_m_s_) / dt_s - a_m_s2_);
      alpha_rad_s2_ += share * ((handle.omega_rad_s - last_omega_rad_s_) / dt_s - alpha_rad_s2_);
    } else {  // the first tick, or one after a stall
      a_m_s2_.setZero();
      alpha_rad_s2_.setZero();
    }
    last_t_s_ = t_s;
    last_v_m_s_ = handle.v_m_s;
    last_omega_rad_s_ = handle.omega_rad_s;
    moving.a_m_s2 = a_m_s2_;
    moving.alpha_rad_s2 = alpha_rad_s2_;
    return runtime_.step(moving, state_);
  }

 private:
  static constexpr double kSmoothing_s = 0.01;  ///< of the differentiated velocity: one pole
  static constexpr double kLongestTick_s = 0.02;
  const models::PalpationRuntime& runtime_;
  laws::PalpationState state_;
  double last_t_s_ = -1.0;
  math::Vec3 last_v_m_s_ = math::Vec3::Zero(), last_omega_rad_s_ = math::Vec3::Zero();
  math::Vec3 a_m_s2_ = math::Vec3::Zero(), alpha_rad_s2_ = math::Vec3::Zero();
};

}  // namespace tractus::loop
