/// Where the haptic device stands in the room that the headset sees, from points that were touched.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "math/geometry.hpp"

namespace tractus::headset {

/// A point of a fixture, in the room's frame S (the headset's STAGE: metres, y up).
struct FixturePoint {
  std::string name;
  math::Vec3 p_S_m;
};

/// Reads `tractus-fixture/1`: {"format", "name", "points": [{"name", "stage_m": [x, y, z]}, …]}.
/// Errors: bad_input naming the field; fewer than three points or more than eight, points on a
/// line, and points that could be taken for each other (two sides of the triangle equally long:
/// touched in the wrong order it would fit as well).
core::Result<std::vector<FixturePoint>> read_fixture(const std::filesystem::path& path);

/// Such a point, and where the handle's tip was when it touched it.
struct Touched {
  FixturePoint point;
  math::Vec3 p_D_m;
};

struct Alignment {
  math::Pose X_SD;
  double rms_m = 0.0;  ///< of the distances left between points and touches
  double worst_m = 0.0;
  std::string worst;  ///< the point's name
};

/// Rigid, by least squares [Umeyama1991, scale 1; Horn1987 asks the same]:
///
///     min over R, p:  Σ |p_S,i − (R p_D,i + p)|²
///
/// Errors: bad_input, one line: fewer than three points, points on a line, a point further off than
/// `limit_m`.
core::Result<Alignment> align(std::span<const Touched> touched, double limit_m);

/// An alignment as a station keeps it.
struct KeptAlignment {
  Alignment alignment;
  std::string device;  ///< its id: another one stands elsewhere
  bool simulated = false;
  std::int64_t made_utc_us = 0;
};

/// Writes `alignment.json` in the station's folder, whole or not at all. Errors: io.
core::Result<void> keep_alignment(const std::filesystem::path& folder, const KeptAlignment& kept,
                                  std::span<const Touched> touched);
/// Nothing when the folder has none. Errors: bad_input naming the field.
core::Result<std::optional<KeptAlignment>> kept_alignment(const std::filesystem::path& folder);

}  // namespace tractus::headset
