/// C3D: markers of a motion capture system, in the layout that www.c3d.org documents: a header
/// block, parameters by group, frames of integers or floats; little-endian (Intel) files.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "capture/motion.hpp"
#include "core/file.hpp"

namespace capture::detail {
namespace {
using core::Errc;
using core::Error;

constexpr std::size_t kBlock = 512;

/// The file's bytes, read with their ends in view.
class Reader {
 public:
  explicit Reader(core::Bytes bytes) : bytes_(std::move(bytes)) {}
  std::size_t size() const { return bytes_.size(); }
  bool has(std::size_t at, std::size_t count) const { return at <= size() && count <= size() - at; }
  std::uint8_t byte(std::size_t at) const { return has(at, 1) ? std::uint8_t(bytes_[at]) : 0; }
  template <class T>
  T value(std::size_t at) const {
    T out{};
    if (has(at, sizeof(T))) std::memcpy(&out, &bytes_[at], sizeof(T));
    return out;
  }
  std::string text(std::size_t at, std::size_t count) const {
    std::string out;
    for (std::size_t k = 0; k < count && has(at + k, 1); ++k) out += char(bytes_[at + k]);
    return out;
  }

 private:
  static_assert(std::endian::native == std::endian::little);
  core::Bytes bytes_;
};

struct Parameter {
  int type = 0;  ///< −1 characters, 1 bytes, 2 integers, 4 floats
  std::vector<std::size_t> dims;
  std::size_t at = 0;  ///< of its data in the file
};

std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text;
}

/// The parameters by "GROUP:NAME"; groups come with negative numbers, parameters with theirs.
std::map<std::string, Parameter> parameters_of(const Reader& file, std::size_t start) {
  std::map<int, std::string> groups;
  std::vector<std::pair<int, std::pair<std::string, Parameter>>> found;
  std::size_t at = start + 4;
  for (int guard = 0; guard < 10'000 && file.has(at, 4); ++guard) {
    const int length = std::abs(int(std::int8_t(file.byte(at))));
    const int group = std::int8_t(file.byte(at + 1));
    if (length == 0 || group == 0) break;
    std::string name = file.text(at + 2, std::size_t(length));
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return char(std::toupper(c)); });
    const std::size_t next_at = at + 2 + std::size_t(length);
    const auto next = file.value<std::int16_t>(next_at);
    if (group < 0) {
      groups[-group] = name;
    } else {
      Parameter p{.type = std::int8_t(file.byte(next_at + 2)), .dims = {}, .at = 0};
      const std::size_t count = file.byte(next_at + 3);
      for (std::size_t d = 0; d < count; ++d) p.dims.push_back(file.byte(next_at + 4 + d));
      p.at = next_at + 4 + count;
      found.emplace_back(group, std::pair(name, p));
    }
    if (next <= 0) break;
    at = next_at + std::size_t(next);
  }
  std::map<std::string, Parameter> out;
  for (const auto& [group, named] : found) out[groups[group] + ":" + named.first] = named.second;
  return out;
}

std::vector<std::string> labels(const Reader& file, const std::map<std::string, Parameter>& all,
                                std::size_t points) {
  std::vector<std::string> out;
  for (int part = 1; out.size() < points && part < 20; ++part) {
    const auto p = all.find(part == 1 ? "POINT:LABELS" : fmt::format("POINT:LABELS{}", part));
    if (p == all.end() || p->second.dims.size() != 2) break;
    const std::size_t length = p->second.dims[0];
    for (std::size_t k = 0; k < p->second.dims[1] && out.size() < points; ++k)
      out.push_back(trimmed(file.text(p->second.at + k * length, length)));
  }
  for (std::size_t k = out.size(); k < points; ++k) out.push_back(fmt::format("point{}", k + 1));
  return out;
}

/// Metres of one unit of the file's.
std::optional<double> unit_m(const Reader& file, const std::map<std::string, Parameter>& all) {
  const auto p = all.find("POINT:UNITS");
  if (p == all.end() || p->second.dims.empty()) return 1e-3;
  const std::string unit = trimmed(file.text(p->second.at, p->second.dims[0]));
  if (unit == "mm" || unit.empty()) return 1e-3;
  if (unit == "cm") return 1e-2;
  if (unit == "m") return 1.0;
  return std::nullopt;
}

struct Layout {
  std::size_t points = 0, analog = 0, frames = 0, data = 0;
  float scale = 0.0f;  ///< below 0: floats
  double rate_Hz = 0.0, unit_m = 1e-3;
  std::size_t word() const { return scale < 0.0f ? 4 : 2; }
  std::size_t frame_bytes() const { return word() * (4 * points + analog); }
};
}  // namespace

core::Result<Motion> read_c3d(const std::filesystem::path& path) {
  auto bytes = core::read_file(path);
  if (!bytes) return bytes.error();
  const auto wrong = [&](const std::string& what) {
    return Error{Errc::bad_input, fmt::format("{}: {}", path.string(), what)};
  };
  const Reader file(std::move(*bytes));
  if (!file.has(0, kBlock)) return wrong("too short for a C3D file");
  const std::size_t first = file.byte(0);
  if (first == 0 || !file.has((first - 1) * kBlock, 4))
    return wrong("its parameters lie beyond its end");
  const std::size_t start = (first - 1) * kBlock;
  if (const int processor = file.byte(start + 3); processor != 84)
    return wrong(fmt::format("written for processor {}: 84 (Intel) is expected", processor));
  const auto all = parameters_of(file, start);
  Layout at{.points = file.value<std::uint16_t>(2),
            .analog = file.value<std::uint16_t>(4),
            .data = (std::size_t(file.value<std::uint16_t>(16)) - 1) * kBlock,
            .scale = file.value<float>(12),
            .rate_Hz = double(file.value<float>(20))};
  const auto unit = unit_m(file, all);
  if (!unit) return wrong("POINT:UNITS: mm, cm or m is expected");
  at.unit_m = *unit;
  const int begin = file.value<std::uint16_t>(6), end = file.value<std::uint16_t>(8);
  if (at.points == 0 || at.scale == 0.0f || !(at.rate_Hz > 0.0) || !std::isfinite(at.rate_Hz))
    return wrong("no points, no scale or no rate in its header");
  // Long recordings do not fit the header's 16 bits: what is there is read.
  if (!file.has(at.data, at.frame_bytes())) return wrong("no frame of it is there");
  at.frames = (file.size() - at.data) / at.frame_bytes();
  if (end >= begin && end < 65535) at.frames = std::min(at.frames, std::size_t(end - begin + 1));
  Motion out;
  out.rate_Hz = at.rate_Hz;
  const std::vector<std::string> names = labels(file, all, at.points);
  for (std::size_t f = 0; f < at.frames; ++f)
    for (std::size_t p = 0; p < at.points; ++p) {
      const std::size_t from = at.data + f * at.frame_bytes() + p * 4 * at.word();
      math::Vec3 seen;
      double fourth = 0.0;
      for (std::size_t a = 0; a < 4; ++a) {
        const double v = at.scale < 0.0f ? double(file.value<float>(from + 4 * a))
                                         : double(file.value<std::int16_t>(from + 2 * a)) *
                                               (a < 3 ? double(at.scale) : 1.0);
        (a < 3 ? seen[Eigen::Index(a)] : fourth) = v;
      }
      if (fourth < 0.0 || !seen.allFinite()) continue;  // not seen
      out.markers[names[p]].t_s.push_back(double(f) / at.rate_Hz);
      out.markers[names[p]].p_C_m.push_back(at.unit_m * seen);
    }
  return out;
}

}  // namespace capture::detail
