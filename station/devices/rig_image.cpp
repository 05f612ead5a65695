#include "station/devices/rig_image.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace devices {
namespace {

std::int32_t whole(double value) {
  return static_cast<std::int32_t>(std::llround(1e6 * std::clamp(value, -2000.0, 2000.0)));
}

/// Is it a machine that speaks, or noise? Far beyond what any rig of this kind does.
bool plausible(const RigReading& r) {
  return std::abs(r.x_m) <= 1.0 && std::abs(r.speed_m_s) <= 5.0 &&
         std::abs(r.turning_rad_s) <= 1000.0 && std::abs(r.fz_N) <= 5000.0 &&
         std::abs(r.tz_Nm) <= 100.0 && int(r.fault) <= int(rig::RigFault::sensor);
}

}  // namespace

void put_command(const RigCommand& command, std::uint16_t sequence, std::uint16_t* at) noexcept {
  at[rig::kControl] = static_cast<std::uint16_t>((command.enable ? rig::kEnable : 0) |
                                                 (command.reset_fault ? rig::kResetFault : 0) |
                                                 (command.rotary_on ? rig::kRotaryOn : 0));
  at[rig::kSequence] = sequence;
  rig::put_wide(at + rig::kSpeed_um_s, whole(command.speed_m_s));
  rig::put_wide(at + rig::kTorque_uNm, whole(command.torque_Nm));
}

Exchange take_reading(const std::uint16_t* image, RigReading& out) noexcept {
  const auto at = [&](int address) { return image + (address - rig::kReadingStart); };
  RigReading r;
  r.status = *at(rig::kStatus);
  r.fault = rig::RigFault(r.status >> 8);
  r.x_m = 1e-6 * rig::wide(at(rig::kPosition_um));
  r.speed_m_s = 1e-6 * rig::wide(at(rig::kVelocity_um_s));
  r.angle_urad = rig::wide(at(rig::kAngle_urad));
  r.turning_rad_s = 1e-6 * rig::wide(at(rig::kTurning_urad_s));
  r.fz_N = 1e-3 * rig::wide(at(rig::kForce_mN));
  r.tz_Nm = 1e-6 * rig::wide(at(rig::kHandTorque_uNm));
  if (!plausible(r)) return Exchange::garbage;
  out = r;
  return Exchange::ok;
}

RigIdentity identity_of(const std::uint16_t* found) noexcept {
  const auto at = [&](int address) { return found + (address - rig::kIdentityStart); };
  const auto who = *at(rig::kSimulatedPeer);
  return {.travel_m = 1e-6 * rig::wide(at(rig::kTravel_um)),
          .top_speed_m_s = 1e-6 * rig::wide(at(rig::kTopSpeed_um_s)),
          .simulated = who != rig::kRealMachine,
          .bus_clock = who == rig::kSimulatedBusClock};
}

}  // namespace devices
}  // namespace tractus
