/// The rig as a machine: axes, electronics, sensor, and the hand on it. Knows no bone.
#pragma once

#include <cstdint>

#include "station/rig/drive.hpp"
#include "station/rig/linear_axis.hpp"
#include "station/rig/rotary_axis.hpp"
#include "station/rig/sensor.hpp"
#include "station/rig/specimen.hpp"
#include "station/rig/surgeon.hpp"

namespace tractus::rig {

inline constexpr double kStep_s = 1e-4;  ///< 10 kHz
inline constexpr int kSensorSteps = 5;   ///< the sensor samples at 2 kHz

struct MachineParameters {
  LinearParameters linear;
  RotaryParameters rotary;
  SensorParameters sensor;
  SurgeonParameters surgeon;
  Specimen specimen;  ///< in front of the probe, while no simulated surgeon is at work
  std::uint64_t seed = 1;
};

/// What the bus asks for.
struct Command {
  std::uint16_t control = 0, sequence = 0;
  double speed_m_s = 0.0, torque_Nm = 0.0;
};

/// What people and breakdowns do to it.
struct World {
  double hand_force_N = 0.0, hand_torque_Nm = 0.0;
  Panel panel;
  bool surgeon = false;  ///< the simulated one instead of the two numbers above
};

/// A coherent sample of one instant.
struct Reading {
  std::uint16_t status = 0, sequence = 0;
  std::uint32_t steps = 0;  ///< of kStep_s, wraps
  double x_m = 0.0, v_m_s = 0.0, theta_rad = 0.0, omega_rad_s = 0.0;
  double force_N = 0.0, torque_Nm = 0.0;
};

/// Same seed, same calls → same bits.
class Machine {
 public:
  explicit Machine(const MachineParameters& parameters);
  void command(const Command& command) noexcept;
  void set_world(const World& world) noexcept { world_ = world; }
  void step();
  Reading reading() const noexcept;
  const LinearAxis& linear() const noexcept { return linear_; }
  const Drive& drive() const noexcept { return drive_; }
  const Sensor& sensor() const noexcept { return sensor_; }

 private:
  LinearAxis linear_;
  RotaryAxis rotary_;
  Drive drive_;
  Sensor sensor_;
  Surgeon surgeon_;
  Specimen specimen_;
  Command command_;
  World world_;
  std::uint32_t steps_ = 0;
};

}  // namespace tractus::rig
