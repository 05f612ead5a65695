/// Measurements of the probing rig: `tractus-measurements/1`, a folder with `set.json` and a CSV
/// per trial.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"

namespace tractus::trial {

/// A probing recording: columns t_s,x_m,theta_rad,fz_N,tz_Nm; more are ignored. `theta_rad`,
/// `tz_Nm` and, on a rig that only turns, `x_m` with `fz_N` may be missing: those vectors are then
/// empty.
struct ProbingMeasurement {
  std::string id, file, operator_name, notes;
  std::vector<double> t_s;        ///< strictly increasing
  std::vector<double> x_m;        ///< depth of the tip from the entry, positive into the bone
  std::vector<double> theta_rad;  ///< turning about x; empty: not recorded
  std::vector<double> fz_N;       ///< push of the hand along x, positive into the bone
  std::vector<double> tz_Nm;      ///< torque of the hand about x; empty: not recorded
};

/// What set.json may say of the noise, `"noise":{"fz_N":0.05,"x_m":5e-7}`: standard deviations per
/// sample. What is not stated is estimated.
struct StatedNoise {
  std::optional<double> x_m, theta_rad, fz_N, tz_Nm;
};

struct ProbingSet {
  std::filesystem::path folder;
  StatedNoise noise;
  core::Json stated =
      core::Json::object();  ///< what else set.json may say (kStatedFields), as it stands there
  std::vector<ProbingMeasurement> trials;
};

/// The columns of a probing CSV, in the order they are written.
inline constexpr std::array<std::string_view, 5> kProbingColumns{"t_s", "x_m", "theta_rad", "fz_N",
                                                                 "tz_Nm"};

/// Errors: bad_input, one line "FILE:LINE: what is wrong, what is expected" as for palpation; a
/// file needs t_s and either x_m with fz_N or theta_rad with tz_Nm. too_large over 10⁷ rows a file
/// or 2·10⁷ a set. Memory: 40 bytes a row.
core::Result<ProbingSet> read_probing_set(const std::filesystem::path& folder);

/// Writes set.json and the CSVs into a new folder, whole or not at all. Numbers are written so that
/// they are read back to the same bits.
core::Result<void> write_probing_set(const std::filesystem::path& folder, const ProbingSet& set);

/// The rig that a set is of, "probing" or "palpation": which of the readers to call. Errors: as the
/// readers', for what stands in set.json before the trials.
core::Result<std::string> rig_of_set(const std::filesystem::path& folder);

}  // namespace tractus::trial
