/// Measurements: `tractus-measurements/1`, a folder with `set.json` and a CSV per trial.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "math/geometry.hpp"

namespace trial {

/// A palpation recording: columns t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm;
/// more are ignored.
struct PalpationMeasurement {
  std::string id, file, operator_name, notes;
  std::vector<double> t_s;             ///< strictly increasing
  std::vector<math::Pose> X_VH;        ///< handle frame in the volume's frame, unit quaternions
  std::vector<math::Wrench> wrench_H;  ///< what the bone does to the probe, in H
};

struct PalpationSet {
  std::filesystem::path folder;
  std::string volume;  ///< relative to the folder; empty if the set does not name one
  std::vector<PalpationMeasurement> trials;
};

/// Errors: bad_input, one line "FILE:LINE: what is wrong, what is expected" for a missing column,
/// text, a number that is not finite, time that does not run forward, a quaternion far from unit
/// length, too few rows, a rig that is not palpation; paths that leave the folder; too_large over
/// 10⁷ rows a file.
core::Result<PalpationSet> read_palpation_set(const std::filesystem::path& folder);

/// Writes set.json and the CSVs into a new folder, whole or not at all.
core::Result<void> write_palpation_set(const std::filesystem::path& folder,
                                       const PalpationSet& set);

}  // namespace trial
