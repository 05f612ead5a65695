/// Rigid bodies over time, out of a motion capture system.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "math/geometry.hpp"

namespace tractus {
namespace capture {

/// A body's frame B in the capture system's frame C. Frames in which it was not seen are left out.
struct BodyTrack {
  std::vector<double> t_s;  ///< strictly increasing
  std::vector<math::Pose> X_CB;
};

/// A marker's way, m; frames in which it was not seen are left out.
struct MarkerTrack {
  std::vector<double> t_s;
  std::vector<math::Vec3> p_C_m;
};

struct Motion {
  std::map<std::string, BodyTrack> bodies;
  std::map<std::string, MarkerTrack> markers;
  double rate_Hz = 0.0;
};

/// By what stands in the file: a QTM export of bodies or markers (TSV), a Motive export of rigid
/// bodies (CSV, quaternions) or markers, C3D (markers), or a CSV with `t_s` and `NAME.px_m` …
/// `NAME.qz` (a quaternion of zeros: not seen; retimed where it has `arrived_s`). Errors:
/// not_found, io; bad_input "FILE:LINE: what is wrong" (C3D: "FILE: …"); too_large over 2·10⁶
/// frames (C3D: 256 MiB).
core::Result<Motion> read_motion(const std::filesystem::path& path);

/// Where a body's markers are in its own frame, m: three at least, not on a line.
using BodyShape = std::map<std::string, math::Vec3>;

/// Fits a body to its markers in each frame that shows three of them or more: least squares over
/// turns and translations [Horn1987, by singular values]. Frames that fit worse than `worst_m`
/// (root mean square) are left out. Errors: bad_input naming a marker that is not in the motion, a
/// shape on a line, or that no frame fitted.
core::Result<BodyTrack> fit_body(const Motion& motion, const BodyShape& shape,
                                 double worst_m = 0.003);

namespace detail {
core::Result<Motion> read_qtm(const std::filesystem::path& path);
core::Result<Motion> read_motive(const std::filesystem::path& path);
core::Result<Motion> read_plain(const std::filesystem::path& path);
core::Result<Motion> read_c3d(const std::filesystem::path& path);
}  // namespace detail

}  // namespace capture
}  // namespace tractus
