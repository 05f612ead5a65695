/// The Modbus registers of the probing rig's electronics: addresses, bits and coding, shared by who
/// speaks to it and by the peer that plays it. rig-registers.md explains them.
#pragma once

#include <cstdint>

namespace tractus::devices::rig {

inline constexpr std::uint16_t kMapVersion = 1;
inline constexpr int kUnit = 1;         ///< the electronics
inline constexpr int kWorldUnit = 240;  ///< the simulated world around it; a real rig has none

// Command block: written as a whole, in one request, at least every kWatchdog_ms.
inline constexpr int kCommandStart = 0;
inline constexpr int kCommandCount = 6;
enum CommandRegister : int {
  kControl = 0,     ///< bits of Control
  kSequence = 1,    ///< any number; echoed in the readings
  kSpeed_um_s = 2,  ///< int32, linear stage, positive into the bone
  kTorque_uNm = 4,  ///< int32, rotary motor, positive along theta
};
enum Control : std::uint16_t {
  kEnable = 1u << 0,      ///< the linear drive may move; acts on its rising edge
  kResetFault = 1u << 1,  ///< clears a fault; acts on its rising edge
  kRotaryOn = 1u << 2,    ///< the rotary motor is powered
};

// Readings: a coherent sample of one instant.
inline constexpr int kReadingStart = 16;
inline constexpr int kReadingCount = 16;
enum ReadingRegister : int {
  kStatus = 16,          ///< bits of Status, fault code in the upper byte
  kSequenceEcho = 17,    ///< of the last command
  kTime_100us = 18,      ///< uint32, the electronics' own clock, wraps
  kPosition_um = 20,     ///< int32, multiples of kResolution_um
  kVelocity_um_s = 22,   ///< int32
  kAngle_urad = 24,      ///< int32, wraps
  kTurning_urad_s = 26,  ///< int32
  kForce_mN = 28,        ///< int32, push of the hand on the probe, positive into the bone
  kHandTorque_uNm = 30,  ///< int32, of the hand on the probe
};
enum Status : std::uint16_t {
  kEnabled = 1u << 0,      ///< the linear drive follows the speed command
  kFaulted = 1u << 1,      ///< the upper byte says which; motion is stopped
  kEmergency = 1u << 2,    ///< the e-stop has latched; only the panel's reset button clears it
  kAtInnerStop = 1u << 3,  ///< x = 0
  kAtOuterStop = 1u << 4,  ///< x = travel
  kRotaryPowered = 1u << 5,
  kStartPressed = 1u << 6,  ///< a person holds the start button of the panel; a rig may have none
  kSimulated = 1u << 7,     ///< always set by the peer that plays the rig
};
enum class RigFault : std::uint8_t {
  none = 0,
  watchdog = 1,   ///< no command for kWatchdog_ms
  stalled = 2,    ///< the load is above the thrust
  drive = 3,      ///< the integrated drive reports an error of its own
  emergency = 4,  ///< e-stop
  sensor = 5,     ///< the force/torque sensor is beyond its range
};

// Identity: constants.
inline constexpr int kIdentityStart = 32;
inline constexpr int kIdentityCount = 8;
enum IdentityRegister : int {
  kVersion = 32,  ///< kMapVersion
  kWatchdogTime_ms = 33,
  kTravel_um = 34,      ///< uint32
  kTopSpeed_um_s = 36,  ///< uint32
  kStepLength_um = 38,
  kSimulatedPeer = 39,  ///< one of Peer
};
enum Peer : std::uint16_t {
  kRealMachine = 0,
  kSimulatedRealTime = 1,  ///< nothing behind these registers is a machine
  kSimulatedBusClock = 2,  ///< likewise, and its time moves by kBusPeriod_us with every command
};
inline constexpr int kBusPeriod_us = 1000;
inline constexpr int kRegisterCount = 40;

inline constexpr int kWatchdog_ms = 6;  ///< with the brake, motion has stopped within 10 ms
inline constexpr int kResolution_um = 5;

// The world's unit: what people do to the rig, for work without it. Written singly or together.
enum WorldRegister : int {
  kHandForce_mN = 0,      ///< int32, push along x while no simulated surgeon is at work
  kHandTorqueIn_uNm = 2,  ///< int32, turn about x
  kStopButton = 4,        ///< 1: the e-stop is pressed
  kResetButton = 5,       ///< a person presses reset: acts on 0 → 1, once the e-stop is released
  kDriveError = 6,        ///< 1: the drive breaks down
  kSurgeon = 7,      ///< 0: the hand is the registers; 1: the simulated surgeon pushes and turns
  kStartButton = 8,  ///< 1: the start button is pressed
};
inline constexpr int kWorldCount = 9;

/// 32 bits lie in two registers, upper half first, two's complement.
inline std::int32_t wide(const std::uint16_t* at) noexcept {
  return static_cast<std::int32_t>(std::uint32_t{at[0]} << 16 | at[1]);
}
inline void put_wide(std::uint16_t* at, std::int32_t value) noexcept {
  const auto bits = static_cast<std::uint32_t>(value);
  at[0] = static_cast<std::uint16_t>(bits >> 16);
  at[1] = static_cast<std::uint16_t>(bits & 0xffffu);
}

}  // namespace tractus::devices::rig
