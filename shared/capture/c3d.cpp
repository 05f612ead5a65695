#include "capture/c3d.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "capture/c3d_bytes.hpp"
#include "capture/motion.hpp"
#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace capture {
namespace {
using core::Errc;
using core::Error;
using detail::C3dBytes;
using detail::C3dParameters;

constexpr std::size_t kBlock = 512, kMostBytes = 256u << 20;

/// Metres of one unit of the file's.
std::optional<double> unit_m(const C3dParameters& all) {
  const std::string unit = all.text("POINT:UNITS").value_or("mm");
  if (unit == "mm" || unit.empty()) return 1e-3;
  if (unit == "cm") return 1e-2;
  if (unit == "m") return 1.0;
  return std::nullopt;
}

/// Where everything is; word and block numbers of the header count from 1.
struct Layout {
  std::size_t points = 0, channels = 0, per_frame = 0, frames = 0, data = 0;
  double scale = 0.0;  ///< below 0: floats
  double rate_Hz = 0.0, unit = 1e-3;
  std::size_t each() const { return scale < 0.0 ? 4 : 2; }
  std::size_t frame_bytes() const { return each() * (4 * points + channels * per_frame); }
  double value(const C3dBytes& file, std::size_t at) const {
    return scale < 0.0 ? file.real(at) : file.integer(at);
  }
};

/// How many frames the file says it has; 0 when it does not. Long recordings do not fit the
/// header's 16 bits, and writers have put their number in three other places.
std::size_t frames_said(const C3dBytes& file, const C3dParameters& all) {
  // An integer of 16 bits without a sign, or a float.
  const auto whole = [&](const char* name, std::size_t index = 0) {
    const double value = all.number(name, index).value_or(0.0);
    const double count = value < 0.0 && value >= -32768.0 ? value + 65536.0 : value;
    return count >= 1.0 && count < 4e9 ? std::size_t(count) : std::size_t{0};
  };
  if (const std::size_t frames = whole("POINT:LONG_FRAMES"); frames > 0) return frames;
  // Two words each, the low one first.
  const auto field = [&](const char* name) {
    return whole(name, 0) + (std::size_t{whole(name, 1)} << 16);
  };
  const std::size_t first = field("TRIAL:ACTUAL_START_FIELD"),
                    last = field("TRIAL:ACTUAL_END_FIELD");
  if (first > 0 && last >= first) return last - first + 1;
  const std::size_t frames = whole("POINT:FRAMES"), begin = file.word(6), end = file.word(8);
  if (frames > 65535) return frames;  // a float
  const bool full = end == 65535 || end < begin || frames == 65535 || frames == 32767;
  return full ? 0 : end - begin + 1;
}

std::string layout_of(const C3dBytes& file, const C3dParameters& all, Layout& at) {
  const std::size_t data_block = file.word(16);
  at.points = file.word(2);
  at.per_frame = file.word(18);
  at.channels = at.per_frame > 0 ? file.word(4) / at.per_frame : 0;
  at.scale = file.real(12);
  at.rate_Hz = file.real(20);
  const auto unit = unit_m(all);
  if (!unit) return "POINT:UNITS: mm, cm or m is expected";
  at.unit = *unit;
  if (data_block == 0) return "where its data begin is not said";
  at.data = (data_block - 1) * kBlock;
  if (at.points + at.channels == 0 || at.scale == 0.0 || !std::isfinite(at.scale))
    return "no points and no channels, or no scale in its header";
  if (!(at.rate_Hz > 0.0) || !std::isfinite(at.rate_Hz)) return "no rate in its header";
  if (!file.has(at.data, at.frame_bytes())) return "no frame of it is there";
  // What stands behind the last frame fills a block: a file's size alone would give frames too
  // many.
  at.frames = (file.size() - at.data) / at.frame_bytes();
  if (const std::size_t said = frames_said(file, all); said > 0)
    at.frames = std::min(at.frames, said);
  return "";
}

void read_points(const C3dBytes& file, const Layout& at, C3d& out) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double scale = at.unit * (at.scale < 0.0 ? 1.0 : at.scale);
  out.p_C_m.reserve(at.frames * at.points);
  for (std::size_t f = 0; f < at.frames; ++f)
    for (std::size_t p = 0; p < at.points; ++p) {
      const std::size_t from = at.data + f * at.frame_bytes() + p * 4 * at.each();
      math::Vec3 seen;
      for (int a = 0; a < 3; ++a)
        seen[a] = scale * at.value(file, from + std::size_t(a) * at.each());
      // The fourth is a residual with the cameras' mask: −1 where nothing was seen.
      const bool blind = at.value(file, from + 3 * at.each()) < 0.0 || !seen.allFinite();
      out.p_C_m.push_back(blind ? math::Vec3(kNone, kNone, kNone) : seen);
    }
}

void read_analog(const C3dBytes& file, const C3dParameters& all, const Layout& at, C3d& out) {
  const auto names = all.labels("ANALOG:LABELS", at.channels, "channel");
  const auto units = all.labels("ANALOG:UNITS", at.channels, "unit?");
  const double general = all.number("ANALOG:GEN_SCALE").value_or(1.0);
  const bool from_zero = all.text("ANALOG:FORMAT").value_or("SIGNED") == "UNSIGNED";
  const std::size_t first = at.data + at.each() * 4 * at.points;
  for (std::size_t c = 0; c < at.channels; ++c) {
    AnalogChannel channel{.name = names[c], .unit = units[c], .values = {}};
    const double scale = general * all.number("ANALOG:SCALE", c).value_or(1.0);
    double offset = all.number("ANALOG:OFFSET", c).value_or(0.0);
    if (from_zero && offset < 0.0) offset += 65536.0;
    channel.values.reserve(at.frames * at.per_frame);
    for (std::size_t f = 0; f < at.frames; ++f)
      for (std::size_t s = 0; s < at.per_frame; ++s) {
        const std::size_t from = first + f * at.frame_bytes() + (s * at.channels + c) * at.each();
        double raw = at.value(file, from);
        if (from_zero && at.scale > 0.0 && raw < 0.0) raw += 65536.0;
        channel.values.push_back((raw - offset) * scale);
      }
    out.analog.push_back(std::move(channel));
  }
}
}  // namespace

core::Result<C3d> read_c3d_file(const std::filesystem::path& path) {
  auto bytes = TRY(core::read_file(path, kMostBytes));
  const auto wrong = [&](const std::string& what) {
    return Error{Errc::bad_input, fmt::format("{}: {}", path.string(), what)};
  };
  C3dBytes file(std::move(bytes));
  if (!file.has(0, kBlock)) return wrong("too short for a C3D file");
  const std::size_t first = file.byte(0);
  if (first == 0 || !file.has((first - 1) * kBlock, 4))
    return wrong("its parameters lie beyond its end");
  const std::size_t start = (first - 1) * kBlock;
  const int processor = file.byte(start + 3);
  if (processor < 84 || processor > 86)
    return wrong(
        fmt::format("written for processor {}: 84 (Intel), 85 (DEC) or 86 (MIPS) is "
                    "expected",
                    processor));
  file.written_by(C3dBytes::Processor(processor));
  const C3dParameters all(file, start);
  Layout at;
  if (const auto why = layout_of(file, all, at); !why.empty()) return wrong(why);
  C3d out;
  out.rate_Hz = at.rate_Hz;
  out.analog_rate_Hz = at.rate_Hz * double(at.per_frame);
  out.frames = at.frames;
  out.points = all.labels("POINT:LABELS", at.points, "point");
  read_points(file, at, out);
  read_analog(file, all, at, out);
  return out;
}

core::Result<Motion> detail::read_c3d(const std::filesystem::path& path) {
  const auto file = TRY(read_c3d_file(path));
  if (file.points.empty())
    return Error{Errc::bad_input, fmt::format("{}: no points in it", path.string())};
  Motion out;
  out.rate_Hz = file.rate_Hz;
  for (std::size_t f = 0; f < file.frames; ++f)
    for (std::size_t p = 0; p < file.points.size(); ++p) {
      const math::Vec3& seen = file.p_C_m[f * file.points.size() + p];
      if (!seen.allFinite()) continue;
      MarkerTrack& track = out.markers[file.points[p]];
      const double t_s = double(f) / file.rate_Hz;
      if (!track.t_s.empty() && track.t_s.back() >= t_s) continue;  // two of one name: the first
      track.t_s.push_back(t_s);
      track.p_C_m.push_back(seen);
    }
  return out;
}

}  // namespace capture
}  // namespace tractus
