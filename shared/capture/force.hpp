/// Force/torque recordings, and the true rate of a device's clock.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "math/geometry.hpp"

namespace tractus::capture {

/// In the sensor's frame S, at its origin.
struct ForceTrack {
  std::vector<double> t_s;  ///< strictly increasing, of the sensor's clock
  std::vector<math::Wrench> wrench_S;
};

/// Names of the six channels of a C3D file: three forces, three torques.
using ForceChannels = std::vector<std::string>;

/// A CSV `t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm` (retimed where it has `arrived_s`), or the analog
/// channels of a C3D file (N, and Nm or Nmm; else their unit is refused). Errors: as
/// trial::read_csv and read_c3d_file; bad_input naming the channel that is missing, where time does
/// not run forward, or with fewer than two rows.
core::Result<ForceTrack> read_force(const std::filesystem::path& path,
                                    const ForceChannels& channels = {"Fx", "Fy", "Fz", "Mx", "My",
                                                                     "Mz"});

/// How much of the recording computer's time passes in one second of a device's: from when its
/// samples are dated (`t_s`) and when they arrived. A sample arrives late and never early, so the
/// least late of each stretch tell (as [Paxson1998] does for clocks over a network); the slope is
/// the median of those between them [Theil1950]. 1 when less than 2 s were recorded.
/// Errors: bad_input when both run more than 5 % apart.
core::Result<double> device_rate(std::span<const double> t_s, std::span<const double> arrived_s);

}  // namespace tractus::capture
