/// The machine behind its registers, in real time or with its clock on the bus. Safe to use from
/// several threads.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <span>

#include "core/clock.hpp"
#include "station/rig/machine.hpp"

namespace tractus::rig {

class Electronics {
 public:
  /// The machine's time starts now. Borrows the clock. `world` is how things are at the start.
  Electronics(const MachineParameters& parameters, const World& world, core::Clock& clock);
  /// Without a clock: every command block moves the machine's time by kBusPeriod_us before it acts,
  /// as if the bus were cycled in time, and nothing else moves it.
  Electronics(const MachineParameters& parameters, const World& world);

  /// Steps the machine up to now. When this process was held up for more than 4 ms, what is more
  /// is left out and counted: the machine stood still for that long, it did not miss its commands.
  void advance();
  /// Held-up stretches so far.
  std::uint64_t stalls() const;

  /// Registers from `start` on. False: there are none, or they are not to be written so; then
  /// nothing was done. The unit's command block is taken whole or not at all.
  bool write(int unit, int start, std::span<const std::uint16_t> values);
  /// All registers of a unit as they are now; the size must be `count(unit)`.
  void read(int unit, std::span<std::uint16_t> image);
  /// How many registers a unit has; 0: no such unit.
  static int count(int unit) noexcept;

 private:
  void advance_locked();
  mutable std::mutex mutex_;  // guards all below
  Machine machine_;
  core::Clock* clock_;  // null: the bus is the clock
  core::Instant_ns reached_ = 0;
  std::uint64_t stalls_ = 0;
  std::array<std::uint16_t, devices::rig::kCommandCount> command_{};
  std::array<std::uint16_t, devices::rig::kWorldCount> world_{};
  std::array<std::uint16_t, devices::rig::kIdentityCount> identity_{};
};

}  // namespace tractus::rig
