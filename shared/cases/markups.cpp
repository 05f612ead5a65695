#include "cases/markups.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "core/try.hpp"

namespace tractus {
namespace cases {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using math::Vec3;

constexpr const char* kSchema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/"
    "Schema/markups-schema-v1.0.3.json#";
constexpr double kShortest_m = 1e-3;
constexpr double kFarthest_mm = 1e5;  // as far as a volume may lie (volume::check_geometry)

Json control_point(std::size_t number, const std::string& label, const Vec3& at_m) {
  return {{"id", std::to_string(number)},
          {"label", label},
          {"position", {at_m.x() * 1e3, at_m.y() * 1e3, at_m.z() * 1e3}},
          {"positionStatus", "defined"}};
}

Json markup_file(const char* type, const std::string& name, Json points) {
  Json markup = {{"type", type},
                 {"name", name},
                 {"coordinateSystem", "LPS"},
                 {"coordinateUnits", "mm"},
                 {"controlPoints", std::move(points)}};
  return {{"@schema", kSchema}, {"markups", Json::array({std::move(markup)})}};
}

Error bad(const std::string& where, const std::string& what) {
  return {Errc::bad_input, where + what};
}

/// "mm", or a code with its scheme and meaning, as ["mm", "UCUM", "millimeter"].
core::Result<double> read_unit_mm(const Json& markup, const std::string& where) {
  if (!markup.contains("coordinateUnits")) return 1.0;
  const Json& units = markup["coordinateUnits"];
  const Json& code = units.is_array() && !units.empty() ? units[0] : units;
  if (code == "mm") return 1.0;
  if (code == "um") return 1e-3;
  return bad(where, "coordinateUnits: \"mm\" or \"um\" is expected");
}

/// −1 where x and y point to the patient's right and front (RAS), 1 in LPS.
core::Result<double> read_sign(const Json& markup, const std::string& where) {
  const Json system = markup.value("coordinateSystem", Json("LPS"));
  if (system == "LPS") return 1.0;
  if (system == "RAS") return -1.0;
  return bad(where, "coordinateSystem: \"LPS\" or \"RAS\" is expected");
}

bool is_placed(const Json& point) {
  const Json status = point.is_object() ? point.value("positionStatus", Json("defined")) : Json();
  return status == "defined";
}

core::Result<Vec3> read_position_mm(const Json& point, const std::string& where) {
  const Json position = point.value("position", Json());
  if (!position.is_array() || position.size() != 3)
    return bad(where, "position: three numbers are expected");
  Vec3 out;
  for (int a = 0; a < 3; ++a) {
    const Json& number = position[std::size_t(a)];
    if (!number.is_number() || !(std::abs(number.get<double>()) <= kFarthest_mm))
      return bad(where, fmt::format("position/{}: a number of millimetres is expected", a));
    out[a] = number.get<double>();
  }
  return out;
}

core::Result<Json> find_line(const Json& file, const std::string& where) {
  if (!file.is_object() || !file.contains("markups") || !file["markups"].is_array())
    return bad(where, "no \"markups\" here: a markups file of 3D Slicer (.mrk.json) is expected");
  std::optional<Json> line;
  for (const Json& markup : file["markups"]) {
    if (!markup.is_object() || markup.value("type", Json()) != "Line") continue;
    if (line) return bad(where, "holds several lines: one, from entry to target, is expected");
    line = markup;
  }
  if (!line) return bad(where, "holds no markup of type \"Line\": draw one from entry to target");
  return *line;
}

}  // namespace

Json line_markup(const PlannedLine& line, const std::string& name) {
  return markup_file("Line", name,
                     Json::array({control_point(1, "entry", line.entry_m),
                                  control_point(2, "target", line.target_m)}));
}

Json curve_markup(std::span<const Vec3> points_m, const std::string& name) {
  Json points = Json::array();
  for (const Vec3& at_m : points_m) points.push_back(control_point(points.size() + 1, "", at_m));
  return markup_file("Curve", name, std::move(points));
}

core::Result<PlannedLine> read_line_markup(const std::filesystem::path& path) {
  const auto where = path.string() + ": ";
  const auto file = TRY(core::read_json(path));
  const auto line = TRY(find_line(file, where));
  const double unit_mm = TRY(read_unit_mm(line, where));
  const double sign = TRY(read_sign(line, where));
  std::vector<Vec3> placed_m;
  const Json points = line.value("controlPoints", Json::array());
  for (const Json& point : points) {
    if (!is_placed(point)) continue;
    const Vec3 at_mm = TRY(read_position_mm(point, where + "controlPoints/")) * unit_mm;
    placed_m.push_back(Vec3(sign * at_mm.x(), sign * at_mm.y(), at_mm.z()) * 1e-3);
  }
  if (placed_m.size() != 2)
    return bad(where, fmt::format("the line has {} placed points: two, entry and target, are "
                                  "expected",
                                  placed_m.size()));
  if ((placed_m[1] - placed_m[0]).norm() < kShortest_m)
    return bad(where, "entry and target are less than 1 mm apart");
  return PlannedLine{placed_m[0], placed_m[1]};
}

}  // namespace cases
}  // namespace tractus
