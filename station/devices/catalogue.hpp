/// Which devices there are, haptic handles and probing rigs. One file each in catalogue/: a file
/// `sim_lambda6.cpp` defines `DeviceInfo sim_lambda6_device()`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/devices/device.hpp"
#include "station/devices/rig_device.hpp"
#include "station/devices/rig_process.hpp"

namespace tractus::devices {

/// The drilled channel as a simulated hand knows it from planning: where to go, not what is wrong
/// with it. In D.
struct KnownTract {
  math::Vec3 entry_m = math::Vec3::Zero();    ///< centre of the mouth
  math::Vec3 axis = -math::Vec3::UnitX();     ///< unit vector into the bone
  math::Vec3 medial = math::Vec3::UnitY();    ///< unit vector, perpendicular to axis
  math::Vec3 superior = math::Vec3::UnitZ();  ///< unit vector, perpendicular to both
  double length_m = 0.04;
  double radius_m = 0.0025;
  /// Depth from which bone was seen all round in the planning images: what is felt nearer to the
  /// mouth is its rim, and no wall.
  double enclosed_from_m = 0.0;
};

/// What a device does about its zero, which it loses while it is switched off.
enum class Homing : std::uint8_t {
  refuse,  ///< takes it as it is; says so when it is lost
  move,    ///< looks for it anew: the handle moves by itself, somebody must stand by
};

/// What the hand holds.
enum class Tool : std::uint8_t { probe, burr };

/// What a simulated hand feels and how steady it is. Defaults from people.
struct HandSense {
  double force_threshold_N = 0.030;  ///< the smallest force that is felt, 29 to 34 mN [King2010]
  double force_weber = 0.07;         ///< JND of force, share of it [Pang1991]
  /// Standard deviation of a slow wander along each axis: 285 µm in three, of surgeons whose
  /// instrument goes through an entry [Wells2013].
  double wander_m = 0.000165;
};

/// Options of a device: the first six of a simulated one, the last two of a machine.
struct DeviceOptions {
  std::uint64_t seed = 1;        ///< of everything random in a simulated device
  double duration_s = 30.0;      ///< of a simulated hand's plan
  double probe_length_m = 0.13;  ///< handle's origin to tip
  KnownTract channel = {};
  Tool tool = Tool::probe;         ///< with a burr a simulated hand makes the channel
  HandSense sense = {};            ///< of a simulated hand
  std::filesystem::path sdk = {};  ///< the vendor's library or folder; empty: where it installs
  Homing homing = Homing::refuse;
};

/// What a trainee says afterwards.
struct SimulatedAnswer {
  bool breach = false;
  std::string wall;         ///< "medial", …, "anterior"; empty when there is no breach
  double confidence = 0.0;  ///< 0 … 1
};

/// The simulated person that moves a simulated device. It is never told the truth of a case: it
/// answers from the forces and motions of its own hand. All but `answer` may be called from any
/// thread.
class SimulatedTrainee {
 public:
  virtual ~SimulatedTrainee() = default;
  virtual std::string name() const = 0;          ///< "simulated hand, seed 7"
  virtual bool done() const noexcept = 0;        ///< the plan is over
  virtual double progress() const noexcept = 0;  ///< 0 … 1
  virtual void rest(bool on) noexcept = 0;       ///< a pause: the hand stays where it is
  virtual SimulatedAnswer answer() const = 0;    ///< after the loop has ended
};

/// A device and, when it is simulated, who moves it (owned by the device).
struct MadeDevice {
  std::unique_ptr<Device> device;
  SimulatedTrainee* trainee = nullptr;
};

/// What a rig is told before it is made: a machine the first, a simulated one the others.
struct RigOptions {
  std::string address;                  ///< HOST:PORT, or a serial line "/dev/…[@BAUD]"
  std::filesystem::path program = {};   ///< tractus-rig; empty: beside this program
  std::uint64_t seed = 1;               ///< of the simulated surgeon and of the sensor
  double skill = 0.5;                   ///< of the simulated surgeon, 0 … 1
  bool surgeon = true;                  ///< a SIMULATED surgeon pushes; else nobody does
  std::filesystem::path specimen = {};  ///< SIMULATED material in front of the probe; empty: none
};

/// A rig and, when it is simulated, the process that plays it.
struct MadeRig {
  std::optional<RigProcess> process;
  std::string address;  ///< where it answers
  std::unique_ptr<RigDevice> device;
};

/// With what a trial is done.
enum class DeviceKind : std::uint8_t {
  handle,  ///< a haptic handle: a case is palpated or drilled
  rig,     ///< a probing rig: a scenario is probed
};

/// How a person says where a device is.
enum class AddressedBy : std::uint8_t {
  nothing,  ///< it is simulated and made here
  sdk,      ///< --sdk: the vendor's library, which finds it on the USB
  line,     ///< --address: HOST:PORT, or a serial line
};

struct DeviceInfo {
  std::string id;       ///< "sim-lambda6"
  std::string summary;  ///< one line
  DeviceKind kind = DeviceKind::handle;
  bool simulated = false;
  AddressedBy addressed_by = AddressedBy::nothing;
  /// Of a handle; null of a rig. Errors: out_of_range naming the option.
  core::Result<MadeDevice> (*make)(const DeviceOptions& options) = nullptr;
  /// Of a rig; null of a handle. Errors: bad_input (address), unavailable (no process).
  core::Result<MadeRig> (*make_rig)(const RigOptions& options) = nullptr;
};

/// Every device, in file-name order.
std::vector<DeviceInfo> all();
/// Those of one kind.
std::vector<DeviceInfo> all(DeviceKind kind);
/// Nothing when there is none of that name.
std::optional<DeviceInfo> find(const std::string& id);
/// Errors: not_found naming those of the kind.
core::Result<DeviceInfo> find(const std::string& id, DeviceKind kind);

bool is_rig(const std::string& id);
/// A name that the catalogue does not know is no simulated device.
bool is_simulated(const std::string& id);

/// For --help and refusals: "lambda6 or sim-lambda6".
std::string listed(const std::vector<DeviceInfo>& devices);
std::string listed(DeviceKind kind);
std::string listed(AddressedBy addressed_by);

}  // namespace tractus::devices
