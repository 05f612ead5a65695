#include "station/rig/machine.hpp"

namespace tractus::rig {

namespace registers = devices::rig;

Machine::Machine(const MachineParameters& p)
    : linear_(p.linear),
      rotary_(p.rotary),
      sensor_(p.sensor, p.seed),
      surgeon_(p.surgeon, p.seed ^ 0x5u),
      specimen_(p.specimen) {}

void Machine::command(const Command& command) noexcept {
  command_ = command;
  drive_.command(command.control);
}

void Machine::step() {
  surgeon_.step(linear_.x_m(), linear_.v_m_s(), rotary_.omega_rad_s(),
                world_.surgeon && drive_.enabled(), kStep_s);
  // With a specimen the sensor sits between stage and probe: it says what the stage pushes with, and the stage is loaded
  // by as much against its motion.
  const double from_bone_N =
      world_.surgeon ? 0.0 : specimen_.push_N(linear_.x_m(), linear_.v_m_s());
  const double push_N = world_.surgeon ? surgeon_.push_N() : world_.hand_force_N;
  const double turn_Nm = world_.surgeon ? surgeon_.turn_Nm() : world_.hand_torque_Nm;
  drive_.step(world_.panel, linear_.stalled(), sensor_.overloaded(), kStep_s);
  if (drive_.enabled())
    linear_.drive(command_.speed_m_s, push_N - from_bone_N, kStep_s);
  else
    linear_.brake(kStep_s);
  rotary_.step(drive_.rotary_on() ? command_.torque_Nm : 0.0, turn_Nm, kStep_s);
  if (steps_ % kSensorSteps == 0) sensor_.sample(push_N + from_bone_N, turn_Nm);
  ++steps_;
}

Reading Machine::reading() const noexcept {
  unsigned status = registers::kSimulated;
  if (drive_.enabled()) status |= registers::kEnabled;
  if (drive_.fault() != RigFault::none) status |= registers::kFaulted;
  if (drive_.emergency()) status |= registers::kEmergency;
  if (linear_.at_inner_stop()) status |= registers::kAtInnerStop;
  if (linear_.at_outer_stop()) status |= registers::kAtOuterStop;
  if (drive_.rotary_on()) status |= registers::kRotaryPowered;
  if (world_.panel.start_pressed) status |= registers::kStartPressed;
  status |= static_cast<unsigned>(drive_.fault()) << 8;
  return {static_cast<std::uint16_t>(status),
          command_.sequence,
          steps_,
          linear_.counted_m(),
          linear_.v_m_s(),
          rotary_.theta_rad(),
          rotary_.omega_rad_s(),
          sensor_.force_N(),
          sensor_.torque_Nm()};
}

}  // namespace tractus::rig
