/// Measurements: `tractus-measurements/1`, a folder with `set.json` and a CSV per trial.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"
#include "math/geometry.hpp"

namespace tractus::trial {

/// A palpation recording: columns t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm;
/// more are ignored.
struct PalpationMeasurement {
  std::string id, file, operator_name, notes;
  std::vector<double> t_s;             ///< strictly increasing
  std::vector<math::Pose> X_VH;        ///< handle frame in the volume's frame, unit quaternions
  std::vector<math::Wrench> wrench_H;  ///< what the bone does to the probe, in H
};

/// Where the palpated channel is, when the set says so:
/// `"tract":{"entry_m":[…],"axis":[…],"length_m":…}`.
struct StatedTract {
  math::Vec3 entry_m = math::Vec3::Zero();  ///< centre of the mouth, in V
  math::Vec3 axis = math::Vec3::UnitZ();    ///< unit vector into the bone, in V
  double length_m = 0.0;
};

struct PalpationSet {
  std::filesystem::path folder;
  std::string volume;  ///< relative to the folder and within it; empty if the set does not name one
  std::optional<StatedTract> tract;
  core::Json stated =
      core::Json::object();  ///< what else set.json may say (kStatedFields), as it stands there
  std::vector<PalpationMeasurement> trials;
};

inline constexpr std::array kStatedFields{
    "name",  "notes", "operators", "instrument", "instruments", "sampling_rate_Hz",
    "noise", "down",  "simulated", "source"};

/// The columns of a palpation CSV, in the order they are written.
inline constexpr std::array<std::string_view, 14> kPalpationColumns{
    "t_s", "px_m", "py_m", "pz_m", "qw",    "qx",    "qy",
    "qz",  "fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"};

/// Errors: bad_input, one line "FILE:LINE: what is wrong, what is expected" for a missing column,
/// text, a number that is not finite, time that does not run forward, a quaternion more than 1 %
/// from unit length (nearer ones are normalised), a position over 100 m or a force or torque over
/// 10⁶ (a wrong unit), too few rows, a rig that is not palpation, a field that is not known; paths
/// that leave the folder, also through links; too_large over 10⁷ rows a file or 2·10⁷ a set.
/// Memory: 120 bytes a row.
core::Result<PalpationSet> read_palpation_set(const std::filesystem::path& folder);

/// Where gravity pulls in V: the set's "down", three numbers of any length; −z if it does not say.
/// Errors: bad_input naming the field.
core::Result<math::Vec3> stated_down(const PalpationSet& set);

/// Writes set.json and the CSVs into a new folder, whole or not at all. Numbers are written so that
/// they are read back to the same bits.
core::Result<void> write_palpation_set(const std::filesystem::path& folder,
                                       const PalpationSet& set);

/// One row of kPalpationColumns, without the line's end.
std::string palpation_row(double t_s, const math::Pose& X_VH, const math::Wrench& wrench_H);

}  // namespace tractus::trial
