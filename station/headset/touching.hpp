/// A person touches points with the haptic handle.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/clock.hpp"
#include "station/devices/device.hpp"
#include "station/headset/alignment.hpp"

namespace tractus::headset {

/// One touch: pressed, then held still for a moment. The mean is what counts.
class Touch {
 public:
  enum class State { waiting, holding, moved, done };
  static constexpr double kHold_s = 0.3;
  static constexpr double kStill_m = 0.0015;  ///< from where it was pressed

  /// @param pressed  just now: a button went down, or Enter
  State feed(double t_s, const math::Vec3& tip_D_m, bool pressed);
  /// After `done`.
  math::Vec3 tip_D_m() const { return sum_ / double(samples_); }

 private:
  State state_ = State::waiting;
  double since_s_ = 0.0;
  math::Vec3 first_ = math::Vec3::Zero(), sum_ = math::Vec3::Zero();
  long samples_ = 0;
};

/// How those who ask and answer are reached.
struct TouchExchange {
  std::function<void(const FixturePoint& next)> ask;
  std::function<void(const FixturePoint& again)> moved;  ///< it was not held still
  std::function<bool()> enter;                           ///< Enter was pressed since
  std::function<bool()> stop;                            ///< somebody ends it
};

/// Asks for point after point and reads the opened device, with zero force on the hand all the
/// while.
/// @param tip_H_m  what touches, from the handle's origin
/// Errors: cancelled; unavailable (the device stopped answering).
core::Result<std::vector<Touched>> touch_points(devices::Device& device, core::Clock& clock,
                                                std::span<const FixturePoint> points,
                                                const math::Vec3& tip_H_m,
                                                const TouchExchange& talk);

}  // namespace tractus::headset
