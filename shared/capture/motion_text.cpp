/// Motion out of text: Qualisys Track Manager's TSV, OptiTrack Motive's CSV, our own CSV.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "capture/force.hpp"
#include "capture/motion.hpp"
#include "core/csv.hpp"
#include "core/try.hpp"
#include "core/words.hpp"
#include "trial/csv.hpp"

namespace tractus {
namespace capture::detail {
namespace {
namespace fs = std::filesystem;
using core::CsvReader;
using core::Errc;
using core::Error;
using math::Vec3;

constexpr std::size_t kMaxFrames = 2'000'000, kMaxLine = 1 << 20;

std::optional<double> number(std::string_view cell) {
  double value = 0.0;
  const auto [end, failed] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (failed != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

using Cells = std::vector<std::string_view>;

Error too_many(const fs::path& path) {
  return {Errc::too_large, fmt::format("{}: more than {} frames", path.string(), kMaxFrames)};
}

void add(BodyTrack& track, double t_s, const math::Pose& pose) {
  track.t_s.push_back(t_s);
  track.X_CB.push_back(pose);
}

/// The header of a QTM export: words in the first column, values after it.
struct QtmHeader {
  double rate_Hz = 0.0;
  std::vector<std::string> bodies, markers;
  std::vector<std::size_t> from;  ///< columns in which each body begins, as the columns' names say
};

/// Where "NAME X" stands, or "X": there may be an empty column between two bodies.
std::vector<std::size_t> first_columns(const Cells& names) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == "X" || names[k].ends_with(" X")) out.push_back(k);
  return out;
}

std::vector<std::string> names_of(const Cells& cells) {
  std::vector<std::string> out;
  for (std::size_t k = 1; k < cells.size(); ++k)
    if (!cells[k].empty()) out.push_back(core::one_line(cells[k]));
  return out;
}

/// A body's sixteen columns: X Y Z (mm), three angles, residual, Rot[0 … 8] by columns of the
/// matrix. QTM writes zeros and a residual of −1 (or empty cells) where it saw nothing.
std::optional<math::Pose> qtm_pose(const Cells& cells, std::size_t from) {
  std::array<double, 16> v{};
  for (std::size_t k = 0; k < 16; ++k) {
    const auto value = number(cells[from + k]);
    if (!value) return std::nullopt;
    v[k] = *value;
  }
  math::Mat3 turn;
  turn << v[7], v[10], v[13], v[8], v[11], v[14], v[9], v[12], v[15];
  if (v[6] < 0.0 || std::abs(turn.determinant() - 1.0) > 0.01) return std::nullopt;
  return math::Pose{1e-3 * Vec3(v[0], v[1], v[2]), math::Quat(turn).normalized()};
}

/// @param begun  `cells` are already those of the first row
core::Result<Motion> qtm_rows(CsvReader& lines, Cells& cells, const fs::path& path,
                              const QtmHeader& header, bool numbered, bool begun) {
  Motion out;
  out.rate_Hz = header.rate_Hz;
  const bool six = !header.bodies.empty();
  const std::size_t names = six ? header.bodies.size() : header.markers.size();
  const std::size_t from = numbered ? 2 : 0, each = six ? 16 : 3;
  std::size_t frame = 0;
  double last_s = -1e300;
  for (bool more = begun || TRY(lines.next(cells)); more; more = TRY(lines.next(cells))) {
    if (frame == kMaxFrames) return too_many(path);
    if (core::is_blank(cells)) continue;
    if (cells.size() < from + each * names)
      return lines.wrong(
          fmt::format("{} columns where {} are expected", cells.size(), from + each * names));
    double t_s = double(frame) / header.rate_Hz;
    if (numbered) {
      const auto stated = number(cells[1]);
      if (!stated || *stated <= last_s) return lines.wrong("a time that runs forward is expected");
      last_s = t_s = *stated;
    }
    ++frame;
    for (std::size_t n = 0; n < names; ++n) {
      if (six) {
        const std::size_t at = header.from.size() == names ? header.from[n] : from + each * n;
        if (at + each > cells.size())
          return lines.wrong(
              fmt::format("{} columns where {} are expected", cells.size(), at + each));
        if (const auto pose = qtm_pose(cells, at)) add(out.bodies[header.bodies[n]], t_s, *pose);
        continue;
      }
      const auto x = number(cells[from + 3 * n]), y = number(cells[from + 3 * n + 1]),
                 z = number(cells[from + 3 * n + 2]);
      if (!x || !y || !z || (*x == 0.0 && *y == 0.0 && *z == 0.0)) continue;
      out.markers[header.markers[n]].t_s.push_back(t_s);
      out.markers[header.markers[n]].p_C_m.push_back(1e-3 * Vec3(*x, *y, *z));
    }
  }
  return out;
}
}  // namespace

core::Result<Motion> read_qtm(const fs::path& path) {
  auto lines = TRY(CsvReader::open(path, kMaxLine, '\t'));
  QtmHeader header;
  Cells cells;
  while (TRY(lines.next(cells))) {
    if (cells[0] == "FREQUENCY" && cells.size() > 1)
      header.rate_Hz = number(cells[1]).value_or(0.0);
    if (cells[0] == "BODY_NAMES") header.bodies = names_of(cells);
    if (cells[0] == "MARKER_NAMES") header.markers = names_of(cells);
    // Then a row of column names, or in an export of markers straight the numbers.
    const bool columns = cells[0] == "Frame" || cells[0] == "X" || cells[0].ends_with(" X") ||
                         (!header.bodies.empty() && cells[0] == header.bodies[0]);
    const bool numbers = number(cells[0]).has_value();
    if (!columns && !numbers) continue;
    if (!(header.rate_Hz > 0.0)) return lines.wrong("FREQUENCY is missing above");
    if (header.bodies.empty() && header.markers.empty())
      return lines.wrong("neither BODY_NAMES nor MARKER_NAMES is above");
    if (columns && !header.bodies.empty()) header.from = first_columns(cells);
    const std::size_t wanted =
        header.bodies.empty() ? 3 * header.markers.size() : 16 * header.bodies.size();
    const bool numbered = cells[0] == "Frame" || (numbers && cells.size() >= wanted + 2);
    return qtm_rows(lines, cells, path, header, numbered, numbers);
  }
  return Error{Errc::bad_input,
               fmt::format("{}: no row of numbers after the header", path.string())};
}

namespace {
/// Where a Motive export keeps each rigid body: seven columns, rotation x y z w, position x y z.
/// Of a marker, three columns, in the place of the position's.
struct MotiveColumns {
  std::map<std::string, std::array<int, 7>> bodies, markers;
  int time = -1;
};

/// A column's place among a body's seven, from "Rotation" or "Position" and "X" … "W".
std::optional<std::size_t> place_of(const std::string& kind, const std::string& axis) {
  const std::size_t base = kind == "Rotation" ? 0 : kind == "Position" ? 4 : 7;
  const auto at = std::string_view("XYZW").find(axis.empty() ? '?' : axis[0]);
  if (at == std::string_view::npos || base + at > 6) return std::nullopt;
  return base + at;
}

MotiveColumns motive_columns(const std::vector<std::vector<std::string>>& rows) {
  MotiveColumns out;
  const auto& types = rows[0];
  const auto &names = rows[1], &kinds = rows[rows.size() - 2], &axes = rows.back();
  for (std::size_t k = 0; k < axes.size(); ++k) {
    if (axes[k].starts_with("Time")) out.time = int(k);
    if (k >= types.size() || k >= names.size() || k >= kinds.size()) continue;
    if (types[k] != "Rigid Body" && types[k] != "Marker") continue;
    const auto place = place_of(kinds[k], axes[k]);
    if (!place) continue;
    auto& group = types[k] == "Marker" ? out.markers : out.bodies;
    auto [one, fresh] = group.try_emplace(core::one_line(names[k]));
    if (fresh) one->second.fill(-1);
    one->second[*place] = int(k);
  }
  std::erase_if(out.bodies, [](const auto& body) {
    return std::ranges::find(body.second, -1) != body.second.end();
  });
  std::erase_if(out.markers, [](const auto& marker) {
    return std::find(marker.second.begin() + 4, marker.second.end(), -1) != marker.second.end();
  });
  return out;
}

std::optional<double> cell_at(const Cells& cells, int at) {
  return std::size_t(at) < cells.size() ? number(cells[std::size_t(at)]) : std::nullopt;
}

std::optional<Vec3> motive_point(const Cells& cells, const std::array<int, 7>& at, double unit_m) {
  const auto x = cell_at(cells, at[4]), y = cell_at(cells, at[5]), z = cell_at(cells, at[6]);
  if (!x || !y || !z) return std::nullopt;
  return unit_m * Vec3(*x, *y, *z);
}

std::optional<math::Pose> motive_pose(const Cells& cells, const std::array<int, 7>& at,
                                      double unit_m) {
  std::array<double, 7> v{};
  for (std::size_t k = 0; k < 7; ++k) {
    const auto value = cell_at(cells, at[k]);
    if (!value) return std::nullopt;
    v[k] = *value;
  }
  const math::Quat q(v[3], v[0], v[1], v[2]);
  if (std::abs(q.norm() - 1.0) > 0.01) return std::nullopt;
  return math::Pose{unit_m * Vec3(v[4], v[5], v[6]), q.normalized()};
}

/// Metres of a Motive export's unit.
std::optional<double> motive_unit_m(std::string_view name) {
  if (name.starts_with("Milli")) return 1e-3;
  if (name.starts_with("Centi")) return 1e-2;
  if (name.starts_with("Meter")) return 1.0;
  return std::nullopt;
}

/// What stands above a Motive export's numbers.
struct MotiveHeader {
  double rate_Hz = 0.0, unit_m = 1.0;
  MotiveColumns columns;
};

core::Result<MotiveHeader> motive_header(CsvReader& lines, const Cells& first) {
  MotiveHeader out;
  bool quaternions = false;
  for (std::size_t k = 0; k + 1 < first.size(); ++k) {
    if (first[k] == "Export Frame Rate") out.rate_Hz = number(first[k + 1]).value_or(0.0);
    if (first[k] == "Length Units") {
      const auto unit = motive_unit_m(first[k + 1]);
      if (!unit)
        return lines.wrong(
            fmt::format("Length Units '{}': Meters, Centimeters or Millimeters are "
                        "expected",
                        core::one_line(first[k + 1], 64)));
      out.unit_m = *unit;
    }
    if (first[k] == "Rotation Type") quaternions = first[k + 1] == "Quaternion";
  }
  std::vector<std::vector<std::string>> head;
  Cells cells;
  while (TRY(lines.next(cells))) {
    if (std::ranges::all_of(cells, [](auto cell) { return cell.empty(); })) continue;
    head.emplace_back(cells.begin(), cells.end());
    if (cells[0] == "Frame") break;
    if (head.size() > 8) return lines.wrong("no row that begins with Frame in the header");
  }
  if (head.size() < 4) return lines.wrong("types, names, kinds and axes are expected above Frame");
  out.columns = motive_columns(head);
  if (out.columns.time < 0 || out.columns.bodies.size() + out.columns.markers.size() == 0)
    return lines.wrong(
        "a Time column, and a Rigid Body with rotation and position or a Marker are expected");
  if (!quaternions && !out.columns.bodies.empty())
    return lines.wrong("Rotation Type Quaternion is expected: export anew with it");
  return out;
}
}  // namespace

core::Result<Motion> read_motive(const fs::path& path) {
  auto lines = TRY(CsvReader::open(path, kMaxLine));
  Cells cells;
  if (!TRY(lines.next(cells)))
    return Error{Errc::bad_input, fmt::format("{}: is empty", path.string())};
  const auto header = TRY(motive_header(lines, cells));
  const MotiveColumns& columns = header.columns;
  Motion out;
  out.rate_Hz = header.rate_Hz;
  double last_s = -1e300;
  for (std::size_t frame = 0; TRY(lines.next(cells)); ++frame) {
    if (frame == kMaxFrames) return too_many(path);
    if (cells.size() <= std::size_t(columns.time)) continue;
    const auto t_s = number(cells[std::size_t(columns.time)]);
    if (!t_s || *t_s <= last_s) return lines.wrong("a time that runs forward is expected");
    last_s = *t_s;
    for (const auto& [name, at] : columns.bodies)
      if (const auto pose = motive_pose(cells, at, header.unit_m))
        add(out.bodies[name], *t_s, *pose);
    for (const auto& [name, at] : columns.markers)
      if (const auto point = motive_point(cells, at, header.unit_m)) {
        out.markers[name].t_s.push_back(*t_s);
        out.markers[name].p_C_m.push_back(*point);
      }
  }
  return out;
}

namespace {
/// Bodies of our own CSV, by the header's NAME.px_m.
std::vector<std::string> plain_bodies(const std::vector<std::string>& header) {
  std::vector<std::string> out;
  for (const std::string& name : header)
    if (name.ends_with(".px_m")) out.push_back(name.substr(0, name.size() - 5));
  return out;
}
}  // namespace

core::Result<Motion> read_plain(const fs::path& path) {
  const auto header = TRY(trial::csv_header(path));
  const std::vector<std::string> bodies = plain_bodies(header);
  std::vector<std::string> columns{"t_s"};
  if (bodies.empty())
    return Error{
        Errc::bad_input,
        fmt::format("{}:1: a body's columns (NAME.px_m … NAME.qz) are expected", path.string())};
  for (const std::string& body : bodies)
    for (const char* what : {"px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz"})
      columns.push_back(body + "." + what);
  const bool stamped = std::ranges::find(header, "arrived_s") != header.end();
  if (stamped) columns.emplace_back("arrived_s");
  const std::vector<std::string_view> views(columns.begin(), columns.end());
  Motion out;
  double last_s = -1e300;
  std::vector<double> times_s, arrived_s;
  TRY(trial::read_csv(path, views, [&](std::size_t, std::span<const double> v) {
    if (!(v[0] > last_s)) return std::string("time does not run forward");
    last_s = v[0];
    if (stamped) times_s.push_back(v[0]), arrived_s.push_back(v.back());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const double* at = &v[1 + 7 * b];
      const math::Quat q(at[3], at[4], at[5], at[6]);
      if (q.norm() == 0.0) continue;  // not seen
      if (std::abs(q.norm() - 1.0) > 0.01)
        return fmt::format("the quaternion of '{}' is not of unit length", bodies[b]);
      add(out.bodies[bodies[b]], v[0], {Vec3(at[0], at[1], at[2]), q.normalized()});
    }
    return std::string();
  }));
  const auto rate = device_rate(times_s, arrived_s);
  if (!rate)
    return Error{rate.error().code, fmt::format("{}: {}", path.string(), rate.error().what)};
  for (auto& [name, track] : out.bodies)
    for (double& t : track.t_s) t *= *rate;
  return out;
}

}  // namespace capture::detail
}  // namespace tractus
