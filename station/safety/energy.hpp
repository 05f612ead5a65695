/// How much energy a device puts into a hand, and the damping that takes it back.
#pragma once

#include "math/geometry.hpp"

namespace tractus::safety {

/// Passivity observer [Hannaford2002; exact for a held wrench: Ryu2005]. Between two ticks the
/// device holds one wrench, so the work it does on the hand is known without any velocity:
///
///     E(n) = E(n−1) + F(n−1) · (p(n) − p(n−1)) + τ(n−1) · Δφ(n)                     (1)
///
/// E > 0: more was given to the hand than it ever put in. A passive surrounding keeps E <= 0; the
/// highest E is the energy that was injected (a field that is not conservative, a sampled stiff
/// wall, the growing share at the start). Real-time safe.
class EnergyObserver {
 public:
  /// First in the tick: where the handle is now, axes of D.
  void moved_to(const math::Pose& X_DH) noexcept;
  /// No pose in this tick: the next one starts a new stretch (what happened between is not known).
  void lost_sight() noexcept { seen_ = false; }
  /// Last in the tick: what the hand is given until the next one.
  void holds(const math::Wrench& on_hand_D) noexcept { held_ = on_hand_D; }

  double given_J() const noexcept { return given_J_; }        ///< E, eq. (1)
  double injected_J() const noexcept { return injected_J_; }  ///< the highest E so far, >= 0
  /// The stretch of the last tick alone.
  double last_J() const noexcept { return last_J_; }

 private:
  math::Pose last_;
  math::Wrench held_;
  bool seen_ = false;
  double given_J_ = 0.0, injected_J_ = 0.0, last_J_ = 0.0;
};

/// Passivity controller: damping against the hand's motion that would take the observed excess
/// back within one period, as far as a damper of bounded strength does:
///
///     b = min(b_max, E / (T |v|²)),   F' = F − b v;   what is left over likewise by rotation  (2)
///
/// What it gives still passes the limiter. Departs from the source: an allowance, below which
/// nothing is done, so that noise at rest is not felt.
struct PassivityController {
  static constexpr double kAllowance_J = 2e-4;
  static constexpr double kMost_Ns_per_m = 15.0;
  static constexpr double kMost_Nms_per_rad = 0.01;

  static math::Wrench damped(const math::Wrench& wanted, double given_J,
                             const math::Vec3& velocity_m_s, const math::Vec3& turn_rad_s,
                             double period_s) noexcept;
};

}  // namespace tractus::safety
