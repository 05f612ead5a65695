/// A haptic device as the loop sees it. One file per device in catalogue/; a simulated one is a
/// product of its own.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/clock.hpp"
#include "core/json.hpp"
#include "core/result.hpp"
#include "math/geometry.hpp"

namespace tractus::devices {

/// How a call in the tick went; the loop decides what follows.
enum class Status {
  ok,
  stale,
  fault,
  gone,        ///< not on its bus any more
  forces_off,  ///< it took its own forces away: button, velocity guard, watchdog
};

/// One coherent sample: one stamp for everything in it.
struct Sample {
  core::Instant_ns stamp = 0;
  math::Pose X_DH;  ///< handle frame in the device's frame D
  math::Vec3 velocity_m_s = math::Vec3::Zero();
  math::Vec3 angular_velocity_rad_s = math::Vec3::Zero();
  bool saturated = false;      ///< the device could not give all of the last command
  std::uint32_t buttons = 0;   ///< a bit each, where there are any
  double gripper_gap_m = 0.0;  ///< where there is a gripper
};

struct Limits {
  double max_force_N = 0.0;
  double max_torque_Nm = 0.0;
  double rate_Hz = 0.0;
  std::string name = {};   ///< as the device calls itself; empty when it does not
  bool simulated = false;  ///< behind the driver stands no machine
};

class Device {
 public:
  virtual ~Device() = default;
  virtual core::Result<Limits> open() = 0;  ///< may block
  virtual Status read(core::Instant_ns now, Sample& out) noexcept = 0;
  virtual Status write(const math::Wrench& on_hand_D) noexcept = 0;  ///< wrench on the handle, at
                                                                     ///< its origin, axes of D
  virtual void close() noexcept = 0;  ///< zero force first; may be called twice
};

}  // namespace tractus::devices
