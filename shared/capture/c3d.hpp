/// C3D: markers and analog channels of a motion capture system, in the layout that www.c3d.org
/// documents: a header block, parameters by group, frames of integers or floats; of Intel, DEC and
/// MIPS processors alike.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "math/geometry.hpp"

namespace tractus::capture {

struct AnalogChannel {
  std::string name, unit;
  std::vector<double> values;  ///< in that unit, at C3d::analog_rate_Hz from 0
};

struct C3d {
  double rate_Hz = 0.0, analog_rate_Hz = 0.0;
  std::size_t frames = 0;
  std::vector<std::string> points;
  /// [frame][point], m; not finite where it was not seen.
  std::vector<math::Vec3> p_C_m;
  std::vector<AnalogChannel> analog;
};

/// Errors: not_found, io; too_large over 256 MiB; bad_input "FILE: what is wrong": cut, of an
/// unknown processor, without a rate, in a unit of length that is none.
core::Result<C3d> read_c3d_file(const std::filesystem::path& path);

}  // namespace tractus::capture
