/// The simulated probing rig: `tractus-rig`, started here, behind the same Modbus as the machine.
#include "core/try.hpp"
#include "station/devices/catalogue.hpp"
#include "station/devices/modbus_rig.hpp"

namespace tractus::devices {
namespace {

core::Result<MadeRig> make_sim_rig(const RigOptions& options) {
  auto process = TRY(RigProcess::start({.program = options.program,
                                        .seed = options.seed,
                                        .skill = options.skill,
                                        .surgeon = options.surgeon,
                                        .specimen = options.specimen,
                                        .bus_clock = false}));
  std::string address = process.address();
  auto device = TRY(modbus_rig(address));
  return MadeRig{std::move(process), std::move(address), std::move(device)};
}

}  // namespace

DeviceInfo sim_rig_device() {
  return {.id = "sim-rig",
          .summary = "SIMULATED probing rig in a process of its own, with a simulated surgeon",
          .kind = DeviceKind::rig,
          .simulated = true,
          .addressed_by = AddressedBy::nothing,
          .make_rig = make_sim_rig};
}

}  // namespace tractus::devices
