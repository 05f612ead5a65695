/// A SIMULATED hand that touches a fixture's points with a simulated handle.
#pragma once

#include <span>
#include <vector>

#include "station/devices/device.hpp"
#include "station/headset/alignment.hpp"

namespace tractus::headset {

/// Goes from point to point (minimum jerk [Flash1985]), comes to rest a fraction of a millimetre
/// beside it, holds still but for a tremor, presses the button; begins again after the last.
class TouchingHand final : public devices::Device {
 public:
  /// Where the simulated device stands in the room: on a table before the person, who looks along
  /// −z, and turned a little.
  static math::Pose stands_at();

  TouchingHand(std::span<const FixturePoint> points, const math::Vec3& tip_H_m);
  core::Result<devices::Limits> open() override;
  devices::Status read(core::Instant_ns now, devices::Sample& out) noexcept override;
  devices::Status write(const math::Wrench& on_hand_D) noexcept override;
  void close() noexcept override {}

 private:
  std::vector<math::Vec3> tips_D_m_;
  math::Vec3 tip_H_m_;
  core::Instant_ns start_ = -1;
};

}  // namespace tractus::headset
