/// One live tick of a probing law with effects: motion from force. Used by ProbingRuntime alone.
#pragma once

#include "effects/probing_effect.hpp"
#include "laws/probing_law.hpp"
#include "models/probing_runtime.hpp"

namespace tractus::models {

/// The tick is cut where the bone's depth crosses a border of the law, so that a stretch's law
/// never acts beyond its end.
class ProbingStep {
 public:
  ProbingStep(const laws::ProbingLaw& law, const ProbingStages& stages, double turning_rad_s,
              double dt_s, ProbingLive& live) noexcept;
  /// Moves `live` over the tick; returns the mean speed, m/s.
  double take(double force_N) noexcept;

 private:
  /// The stretch of the law in which the bone's depth stays during a piece of the tick.
  struct Piece {
    double left_s, low_m, high_m;
  };
  effects::ProbingTick candidate(double v_m_s, double over_s) const noexcept;
  effects::ProbingTick seen(effects::ProbingTick tick) const noexcept;
  double resistance_N(double v_m_s, const Piece& piece) const noexcept;
  double speed_m_s(double force_N, const Piece& piece) const noexcept;
  double move(double v_m_s, const Piece& piece) noexcept;
  void commit(const effects::ProbingTick& tick) noexcept;

  const laws::ProbingLaw& law_;
  const ProbingStages& stages_;
  double turning_rad_s_, dt_s_;
  double torque_Nm_;  // the rotary stage's at the tick's start
  ProbingLive& live_;
};

}  // namespace tractus::models
