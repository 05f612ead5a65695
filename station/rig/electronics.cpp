#include "station/rig/electronics.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"

namespace tractus {
namespace rig {
namespace {

namespace registers = devices::rig;

constexpr core::Instant_ns kStep_ns = 100'000;
constexpr core::Instant_ns kLongestCatchUp_ns = 4'000'000;  // below the watchdog's time
constexpr int kBusSteps = int(registers::kBusPeriod_us * 1000 / kStep_ns);
static_assert(kLongestCatchUp_ns < registers::kWatchdog_ms * 1'000'000);

/// A number in units of 1e-3 or 1e-6, held to 32 bits.
std::int32_t whole(double value) {
  return static_cast<std::int32_t>(std::llround(std::clamp(value, -2147483648.0, 2147483647.0)));
}

/// The same, round and round: angles.
std::int32_t wrapped(double value) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llround(value)));
}

Command command_of(const std::uint16_t* at) {
  return {at[registers::kControl], at[registers::kSequence],
          1e-6 * registers::wide(at + registers::kSpeed_um_s),
          1e-6 * registers::wide(at + registers::kTorque_uNm)};
}

World world_of(const std::uint16_t* at) {
  return {1e-3 * registers::wide(at + registers::kHandForce_mN),
          1e-6 * registers::wide(at + registers::kHandTorqueIn_uNm),
          {at[registers::kStopButton] != 0, at[registers::kResetButton] != 0,
           at[registers::kDriveError] != 0, at[registers::kStartButton] != 0},
          at[registers::kSurgeon] != 0};
}

void put_world(const World& world, std::uint16_t* at) {
  registers::put_wide(at + registers::kHandForce_mN, whole(1e3 * world.hand_force_N));
  registers::put_wide(at + registers::kHandTorqueIn_uNm, whole(1e6 * world.hand_torque_Nm));
  at[registers::kStopButton] = world.panel.stop_pressed;
  at[registers::kResetButton] = world.panel.reset_pressed;
  at[registers::kDriveError] = world.panel.drive_error;
  at[registers::kStartButton] = world.panel.start_pressed;
  at[registers::kSurgeon] = world.surgeon;
}

void put_reading(const Reading& r, std::uint16_t* image) {
  image[registers::kStatus] = r.status;
  image[registers::kSequenceEcho] = r.sequence;
  registers::put_wide(image + registers::kTime_100us, static_cast<std::int32_t>(r.steps));
  registers::put_wide(image + registers::kPosition_um, whole(1e6 * r.x_m));
  registers::put_wide(image + registers::kVelocity_um_s, whole(1e6 * r.v_m_s));
  registers::put_wide(image + registers::kAngle_urad, wrapped(1e6 * r.theta_rad));
  registers::put_wide(image + registers::kTurning_urad_s, whole(1e6 * r.omega_rad_s));
  registers::put_wide(image + registers::kForce_mN, whole(1e3 * r.force_N));
  registers::put_wide(image + registers::kHandTorque_uNm, whole(1e6 * r.torque_Nm));
}

void put_identity(const LinearParameters& p, registers::Peer who, std::uint16_t* at) {
  const auto place = [&](int address) { return at + (address - registers::kIdentityStart); };
  *place(registers::kVersion) = registers::kMapVersion;
  *place(registers::kWatchdogTime_ms) = registers::kWatchdog_ms;
  registers::put_wide(place(registers::kTravel_um), whole(1e6 * p.travel_m));
  registers::put_wide(place(registers::kTopSpeed_um_s), whole(1e6 * p.top_speed_m_s));
  *place(registers::kStepLength_um) = registers::kResolution_um;
  *place(registers::kSimulatedPeer) = who;
}

}  // namespace

Electronics::Electronics(const MachineParameters& parameters, const World& world,
                         core::Clock& clock)
    : machine_(parameters), clock_(&clock), reached_(clock.now()) {
  machine_.set_world(world);
  put_world(world, world_.data());
  put_identity(parameters.linear, registers::kSimulatedRealTime, identity_.data());
}

Electronics::Electronics(const MachineParameters& parameters, const World& world)
    : machine_(parameters), clock_(nullptr) {
  machine_.set_world(world);
  put_world(world, world_.data());
  put_identity(parameters.linear, registers::kSimulatedBusClock, identity_.data());
}

void Electronics::advance() {
  const std::lock_guard lock(mutex_);
  advance_locked();
}

void Electronics::advance_locked() {
  if (!clock_) return;
  const core::Instant_ns now = clock_->now();
  if (now - reached_ > kLongestCatchUp_ns) {
    ++stalls_;
    reached_ = now - kLongestCatchUp_ns;
  }
  for (; now - reached_ >= kStep_ns; reached_ += kStep_ns) machine_.step();
}

std::uint64_t Electronics::stalls() const {
  const std::lock_guard lock(mutex_);
  return stalls_;
}

int Electronics::count(int unit) noexcept {
  if (unit == registers::kUnit) return registers::kRegisterCount;
  return unit == registers::kWorldUnit ? registers::kWorldCount : 0;
}

bool Electronics::write(int unit, int start, std::span<const std::uint16_t> values) {
  const std::lock_guard lock(mutex_);
  if (unit == registers::kUnit) {
    if (start != registers::kCommandStart || values.size() != command_.size()) return false;
    advance_locked();
    for (int k = 0; !clock_ && k < kBusSteps; ++k) machine_.step();
    std::ranges::copy(values, command_.begin());
    machine_.command(command_of(command_.data()));
    return true;
  }
  if (unit != registers::kWorldUnit || start < 0 || values.empty() ||
      std::size_t(start) + values.size() > world_.size())
    return false;
  advance_locked();
  std::ranges::copy(values, world_.begin() + start);
  machine_.set_world(world_of(world_.data()));
  return true;
}

void Electronics::read(int unit, std::span<std::uint16_t> image) {
  core::require(int(image.size()) == count(unit), "an image has as many registers as its unit");
  const std::lock_guard lock(mutex_);
  advance_locked();
  if (unit == registers::kWorldUnit) {
    std::ranges::copy(world_, image.begin());
    return;
  }
  std::ranges::fill(image, std::uint16_t{0});
  std::ranges::copy(command_, image.begin() + registers::kCommandStart);
  put_reading(machine_.reading(), image.data());
  std::ranges::copy(identity_, image.begin() + registers::kIdentityStart);
}

}  // namespace rig
}  // namespace tractus
