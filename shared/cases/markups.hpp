/// Markups of 3D Slicer (`.mrk.json`): a plan as a line, a tip's path as a curve. The format is
/// Slicer's "markups schema 1.0.3": positions in millimetres, LPS or RAS as the file says.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/json.hpp"
#include "math/geometry.hpp"

namespace tractus::cases {

/// A straight tract, in V (LPS), m.
struct PlannedLine {
  math::Vec3 entry_m = math::Vec3::Zero();
  math::Vec3 target_m = math::Vec3::Zero();
};

/// A markups file with one line of two control points, "entry" and "target".
core::Json line_markup(const PlannedLine& line, const std::string& name);
/// A markups file with one open curve through points in V, m.
core::Json curve_markup(std::span<const math::Vec3> points_m, const std::string& name);

/// The one line in a markups file: its first control point is the entry, its second the target.
/// Errors: bad_input naming file and field (no line or several, other than two placed points, a
/// unit or space that is not known, points closer than 1 mm), not_found, io.
core::Result<PlannedLine> read_line_markup(const std::filesystem::path& path);

}  // namespace tractus::cases
