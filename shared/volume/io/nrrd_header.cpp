#include "volume/io/nrrd_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
using volume::Mat3;
using volume::Vec3;
namespace {

/// Fields a CT may carry; others are refused, since teem would act on them.
constexpr std::array kKnown = {"type",
                               "dimension",
                               "sizes",
                               "encoding",
                               "endian",
                               "space",
                               "space directions",
                               "space origin",
                               "space units",
                               "kinds",
                               "data file",
                               "byte skip",
                               "line skip",
                               "content",
                               "labels",
                               "centers",
                               "centerings",
                               "thicknesses",
                               "measurement frame",
                               "spacings",
                               "units",
                               "sample units",
                               "min",
                               "max",
                               "old min",
                               "old max",
                               "number"};

struct Lines {
  std::map<std::string, std::string> fields;
  std::size_t end = 0;  ///< where the voxels begin when they are in the same file
};

std::string trimmed_text(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())))
    text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())))
    text.remove_suffix(1);
  return std::string(text);
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The name a field is known by: lower case, and the one-word spellings spelt out.
std::string field_name(std::string_view raw) {
  const std::string name = lower(trimmed_text(raw));
  if (name == "datafile") return "data file";
  if (name == "byteskip") return "byte skip";
  if (name == "lineskip") return "line skip";
  if (name == "oldmin") return "old min";
  if (name == "oldmax") return "old max";
  if (name == "sampleunits") return "sample units";
  return name;
}

/// A field goes to `fields`; comments and key/value pairs ("key:=value") are passed over. What teem
/// takes for a field is one here, whatever else the line holds.
core::Result<void> take_line(const std::string& line, int number, const fs::path& path,
                             std::map<std::string, std::string>& fields) {
  if (line[0] == '#') return {};
  const std::size_t colon = line.find(": ");
  const std::string name = colon == std::string::npos ? "" : field_name(line.substr(0, colon));
  if (std::ranges::find(kKnown, name) == kKnown.end()) {
    if (line.find(":=") != std::string::npos) return {};
    return bad(
        path, colon == std::string::npos
                  ? fmt::format("line {}: \"{}\", a field and its value are expected", number,
                                printable(line))
                  : fmt::format("line {}: the field \"{}\" is not known", number, printable(name)));
  }
  if (!fields.emplace(name, trimmed_text(line.substr(colon + 2))).second)
    return bad(path, fmt::format("line {}: a second \"{}\"", number, name));
  return {};
}

core::Result<Lines> lines_of(std::string_view text, const fs::path& path) {
  Lines out;
  std::size_t at = 0;
  for (int number = 1;; ++number) {
    const std::size_t end = text.find('\n', at);
    const bool last = end == std::string_view::npos;
    const std::string line =
        trimmed_text(text.substr(at, last ? std::string_view::npos : end - at));
    at = last ? text.size() : end + 1;
    if (number > 1 && line.empty()) break;
    if (last && number > 1 && text.size() >= (1u << 16))
      return bad(path, "no blank line ends its header within 64 KiB");
    if (number > 1) TRY(take_line(line, number, path, out.fields));
    if (last) break;
  }
  out.end = at;
  return out;
}

std::optional<std::vector<double>> numbers_of(std::string text) {
  std::ranges::replace(text, ',', ' ');
  std::vector<double> out;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    while (at != end && *at == ' ') ++at;
    if (at == end) return out;
    double value = 0.0;
    const auto [stop, code] = std::from_chars(at, end, value);
    if (code != std::errc() || (stop != end && *stop != ' ')) return {};
    out.push_back(value);
    at = stop;
  }
}

/// "(a,b,c)" vectors, exactly `count` of them.
std::optional<std::vector<Vec3>> vectors_of(std::string_view text, std::size_t count) {
  std::vector<Vec3> out;
  while (true) {
    const std::string rest = trimmed_text(text);
    if (rest.empty()) break;
    const std::size_t close = rest.find(')');
    if (rest[0] != '(' || close == std::string::npos) return {};
    const auto numbers = numbers_of(rest.substr(1, close - 1));
    if (!numbers || numbers->size() != 3) return {};
    out.emplace_back((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    text = text.substr(text.find(')') + 1);
  }
  if (out.size() != count) return {};
  return out;
}

int bytes_of_type(const std::string& type) {
  static const std::map<std::string, int> kBytes = {{"signed char", 1},
                                                    {"int8", 1},
                                                    {"int8_t", 1},
                                                    {"uchar", 1},
                                                    {"unsigned char", 1},
                                                    {"uint8", 1},
                                                    {"uint8_t", 1},
                                                    {"short", 2},
                                                    {"short int", 2},
                                                    {"signed short", 2},
                                                    {"signed short int", 2},
                                                    {"int16", 2},
                                                    {"int16_t", 2},
                                                    {"ushort", 2},
                                                    {"unsigned short", 2},
                                                    {"unsigned short int", 2},
                                                    {"uint16", 2},
                                                    {"uint16_t", 2},
                                                    {"int", 4},
                                                    {"signed int", 4},
                                                    {"int32", 4},
                                                    {"int32_t", 4},
                                                    {"uint", 4},
                                                    {"unsigned int", 4},
                                                    {"uint32", 4},
                                                    {"uint32_t", 4},
                                                    {"float", 4},
                                                    {"double", 8}};
  const auto found = kBytes.find(lower(type));
  return found == kBytes.end() ? 0 : found->second;
}

std::string field(const Lines& lines, const std::string& name) {
  const auto found = lines.fields.find(name);
  return found == lines.fields.end() ? std::string() : found->second;
}

/// From the named space to LPS, or why not.
core::Result<Vec3> to_lps(const Lines& lines, const fs::path& path,
                          std::vector<std::string>& notes) {
  const std::string space = lower(field(lines, "space"));
  if (space == "left-posterior-superior" || space == "lps") return Vec3(1, 1, 1);
  if (space == "right-anterior-superior" || space == "ras") return Vec3(-1, -1, 1);
  if (space == "left-anterior-superior" || space == "las") return Vec3(1, -1, 1);
  if (space == "scanner-xyz") {
    notes.push_back("space is scanner-xyz; the patient was assumed to lie head first and supine");
    return Vec3(1, 1, 1);
  }
  return bad(path,
             space.empty()
                 ? "no \"space\": nothing says how the volume lies in the patient"
                 : fmt::format("space \"{}\": left-posterior-superior, right-anterior-superior, "
                               "left-anterior-superior or scanner-xyz is expected",
                               printable(space)));
}

core::Result<double> unit_m(const Lines& lines, const fs::path& path) {
  const std::string units = field(lines, "space units");
  if (units.empty() || units == "\"mm\" \"mm\" \"mm\"") return 1e-3;
  if (units == "\"m\" \"m\" \"m\"") return 1.0;
  if (units == "\"um\" \"um\" \"um\"") return 1e-6;
  return bad(path, fmt::format("space units {}: \"mm\", \"m\" or \"um\" thrice is expected",
                               printable(units)));
}

core::Result<void> place(NrrdHeader& out, const Lines& lines, const fs::path& path) {
  const auto lps = TRY(to_lps(lines, path, out.notes));
  const auto unit = TRY(unit_m(lines, path));
  const auto steps = vectors_of(field(lines, "space directions"), 3);
  const auto origin = vectors_of(field(lines, "space origin"), 1);
  if (!steps) return bad(path, "space directions: three vectors (x,y,z) are expected");
  if (!origin) return bad(path, "space origin: one vector (x,y,z) is expected");
  Mat3 columns;
  for (int a = 0; a < 3; ++a) {
    const Vec3& step = (*steps)[static_cast<std::size_t>(a)];
    const double length = step.norm();
    if (!std::isfinite(length) || !(length > 0.0) || !origin->front().allFinite())
      return bad(
          path,
          fmt::format(
              "space directions or origin of axis {}: finite numbers and a length greater than "
              "0 are expected",
              a + 1));
    out.geometry.spacing_m[a] = length * unit;
    columns.col(a) = lps.cwiseProduct(step) / length;
  }
  out.geometry.origin_m = lps.cwiseProduct(origin->front()) * unit;
  auto axes = TRY(straightened(columns, path, "space directions"));
  out.geometry.directions = axes;
  return volume::check_geometry(out.geometry, path.string() + ": space directions");
}

/// The file beside the header that holds the voxels; nothing above or outside the header's folder.
core::Result<fs::path> data_file(const std::string& name, const fs::path& path) {
  const fs::path relative = name;
  const auto refuse = [&](const char* why) {
    return bad(path, fmt::format("data file \"{}\": {}", printable(name), why));
  };
  if (name.starts_with("LIST") || name.find('%') != std::string::npos)
    return refuse("voxels spread over several files are not read; join them into one");
  if (relative.is_absolute() || std::ranges::find(relative, fs::path("..")) != relative.end())
    return refuse("a name within the header's own folder is expected");
  std::error_code failure;
  const fs::path folder = fs::weakly_canonical(path, failure).parent_path();
  const fs::path target = fs::weakly_canonical(folder / relative, failure);
  if (failure || !fs::exists(target, failure)) return refuse("there is no such file");
  const auto [end, _] = std::ranges::mismatch(folder, target);
  if (end != folder.end()) return refuse("it leads out of the header's own folder");
  return target;
}

core::Result<void> find_data(NrrdHeader& out, const Lines& lines, const fs::path& path) {
  const std::string encoding = lower(field(lines, "encoding"));
  out.gzip = encoding == "gzip" || encoding == "gz";
  if (!out.gzip && encoding != "raw")
    return bad(path, fmt::format("encoding \"{}\": raw or gzip is expected", printable(encoding)));
  for (const char* skip : {"byte skip", "line skip"})
    if (const auto value = field(lines, skip); !value.empty() && value != "0")
      return bad(path, fmt::format("{} {}: 0 is expected", skip, printable(value)));
  if (const auto endian = lower(field(lines, "endian"));
      out.sample_bytes > 1 && endian != "little" && endian != "big")
    return bad(path, fmt::format("endian \"{}\": little or big is expected", printable(endian)));
  const std::string name = field(lines, "data file");
  if (name.empty()) {
    out.data = path;
    out.data_at = lines.end;
    return {};
  }
  auto target = TRY(data_file(name, path));
  out.data = std::move(target);
  return {};
}

}  // namespace

core::Result<NrrdHeader> parse_nrrd(std::string_view text, const fs::path& path) {
  auto lines = TRY(lines_of(text, path));
  if (const auto dimension = field(lines, "dimension"); dimension != "3")
    return bad(path, fmt::format("dimension \"{}\": 3 is expected", printable(dimension)));
  const auto sizes = numbers_of(field(lines, "sizes"));
  if (!sizes || sizes->size() != 3) return bad(path, "sizes: three whole numbers are expected");
  std::array<std::int64_t, 3> claimed{};
  for (std::size_t a = 0; a < 3; ++a) {
    claimed[a] = static_cast<std::int64_t>(std::clamp((*sizes)[a], -1e15, 1e15));
    if (static_cast<double>(claimed[a]) != (*sizes)[a])
      return bad(path, "sizes: three whole numbers are expected");
  }
  const auto dims = TRY(checked_dims(claimed, path, "sizes"));
  NrrdHeader out;
  out.geometry.dims = dims;
  out.sample_bytes = bytes_of_type(field(lines, "type"));
  if (out.sample_bytes == 0)
    return bad(path,
               fmt::format("type \"{}\": not a number of a CT", printable(field(lines, "type"))));
  TRY(place(out, lines, path));
  TRY(find_data(out, lines, path));
  return out;
}

}  // namespace volume_io
}  // namespace tractus
