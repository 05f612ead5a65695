/// The vendor's C interface to lambda.6, found at run time in the SDK that the user installed.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/result.hpp"

namespace tractus::devices {

/// Functions of Force Dimension's SDK (`dhd`, `drd`), as its public documentation names and types
/// them. Nothing of the SDK is linked or shipped. Answers: 0 or one of the positive words below is
/// fine, below 0 an error. `id` is what `open` gave. Lengths m, angles rad, forces N, torques N·m;
/// x towards the operator, y to the right, z up.
struct DhdApi {
  static constexpr int kTimeGuard = 1;  ///< asked too soon: what is given is the last sample
  static constexpr int kSaturated = 2;  ///< the motors could not give all of the command
  static constexpr int kStatusCount = 16;
  enum Status : int {
    kPower = 0,
    kConnected = 1,
    kForce = 5,
    kForceOffCause = 14,
  };
  enum ForceOff : int {
    kForceOffNone = 0,
    kForceOffButton = 1,
    kForceOffVelocity = 2,
    kForceOffWatchdog = 3,
    kForceOffSoftware = 4,
    kForceOffUnplugged = 5,
    kForceOffDeadMan = 6,
  };
  enum Error : int { kCom = 2, kBusy = 3, kNoDriver = 4, kNoDevice = 5, kInUse = 20 };
  /// The firmware's watchdog counts in these.
  static constexpr double kWatchdogStep_s = 125e-6;

  int (*open)() = nullptr;  ///< drdOpen, or dhdOpen where there is no drd
  int (*close)(char id) = nullptr;
  int (*stop)(char id) = nullptr;  ///< brakes; forces off
  int (*last_error)() = nullptr;
  const char* (*last_error_text)() = nullptr;
  const char* (*system_name)(char id) = nullptr;
  int (*serial_number)(unsigned short* number, char id) = nullptr;
  bool (*has_active_wrist)(char id) = nullptr;
  bool (*has_gripper)(char id) = nullptr;
  int (*status)(int status[kStatusCount], char id) = nullptr;
  int (*enable_force)(unsigned char on, char id) = nullptr;
  int (*gravity)(double g_m_s2, char id) = nullptr;
  int (*compensate_gravity)(int on, char id) = nullptr;
  int (*enable_expert_mode)() = nullptr;
  int (*set_watchdog)(unsigned char steps, char id) = nullptr;
  int (*watchdog)(unsigned char* steps, char id) = nullptr;
  int (*pose)(double* x, double* y, double* z, double matrix[3][3], char id) = nullptr;
  int (*velocity)(double* x, double* y, double* z, char id) = nullptr;
  int (*turn)(double* x, double* y, double* z, char id) = nullptr;
  unsigned (*buttons)(char id) = nullptr;
  int (*gripper_gap)(double* gap, char id) = nullptr;
  int (*set_wrench)(double fx, double fy, double fz, double tx, double ty, double tz,
                    double gripper, char id) = nullptr;
  // Robotic part; null where the library has none.
  bool (*is_initialised)(char id) = nullptr;
  int (*initialise)(char id) = nullptr;  ///< the handle moves by itself
  int (*stop_regulation)(bool forces_stay, char id) = nullptr;
};

/// The library in memory; closed when this goes.
class DhdLibrary {
 public:
  /// @param given  a file, or the SDK's folder; empty: $FDSDK, then the names that the SDK installs
  /// (libdrd.so.3, libdrd.so, libdhd.so.3, libdhd.so). Errors: unavailable naming what was tried;
  /// bad_input naming the functions that a library lacks.
  static core::Result<DhdLibrary> load(const std::filesystem::path& given);

  const DhdApi& api() const noexcept { return api_; }
  const std::string& name() const noexcept { return name_; }  ///< what was loaded

 private:
  struct Close {
    void operator()(void* handle) const noexcept;
  };
  core::Result<void> resolve();
  std::unique_ptr<void, Close> handle_;
  std::string name_;
  DhdApi api_;
};

}  // namespace tractus::devices
