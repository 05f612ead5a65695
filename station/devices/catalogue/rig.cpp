/// The probing rig: a machine behind Modbus, held by a person.
#include "core/try.hpp"
#include "station/devices/catalogue.hpp"
#include "station/devices/modbus_rig.hpp"

namespace tractus::devices {
namespace {

core::Result<MadeRig> make_rig(const RigOptions& options) {
  auto device = TRY(modbus_rig(options.address));
  return MadeRig{std::nullopt, options.address, std::move(device)};
}

}  // namespace

DeviceInfo rig_device() {
  return {.id = "rig",
          .summary = "probing rig behind Modbus, over TCP or a serial line, held by a person",
          .kind = DeviceKind::rig,
          .simulated = false,
          .addressed_by = AddressedBy::line,
          .make_rig = make_rig};
}

}  // namespace tractus::devices
