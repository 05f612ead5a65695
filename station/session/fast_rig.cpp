#include "station/session/fast_rig.hpp"

#include <array>

#include "station/devices/rig_image.hpp"
#include "station/rig/electronics.hpp"

namespace tractus {
namespace session {
namespace {
namespace registers = devices::rig;

rig::MachineParameters machine_of(const RigSetup& setup) {
  rig::MachineParameters out;
  out.seed = setup.seed;
  out.surgeon = rig::SurgeonParameters::of_skill(setup.skill);
  return out;
}

rig::World world_of(const RigSetup& setup) {
  rig::World out;
  out.surgeon = setup.surgeon;
  return out;
}

class FastRig final : public devices::RigDevice {
 public:
  explicit FastRig(const RigSetup& setup) : electronics_(machine_of(setup), world_of(setup)) {}

  core::Result<devices::RigIdentity> open() override {
    electronics_.read(registers::kUnit, image_);
    return devices::identity_of(image_.data() + registers::kIdentityStart);
  }

  devices::Exchange exchange(const devices::RigCommand& command,
                             devices::RigReading& reading) noexcept override {
    std::array<std::uint16_t, registers::kCommandCount> block{};
    devices::put_command(command, ++sequence_, block.data());
    electronics_.write(registers::kUnit, registers::kCommandStart, block);
    electronics_.read(registers::kUnit, image_);
    return devices::take_reading(image_.data() + registers::kReadingStart, reading);
  }

  void close() noexcept override {}

 private:
  rig::Electronics electronics_;
  std::array<std::uint16_t, registers::kRegisterCount> image_{};
  std::uint16_t sequence_ = 0;
};

}  // namespace

devices::MadeRig fast_rig(const RigSetup& setup) {
  return {std::nullopt, "this process", std::make_unique<FastRig>(setup)};
}

}  // namespace session
}  // namespace tractus
