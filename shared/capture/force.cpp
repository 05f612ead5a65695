#include "capture/force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>

#include "capture/c3d.hpp"
#include "core/try.hpp"
#include "trial/csv.hpp"

namespace tractus {
namespace capture {
namespace {
namespace fs = std::filesystem;
using core::Errc;
using core::Error;

constexpr std::size_t kStretches = 64;
constexpr double kLeast_s = 2.0, kFarthest = 0.05;

/// What one of a channel's unit is in N or N·m.
std::optional<double> si_of(const std::string& unit, bool torque) {
  if (!torque && unit == "N") return 1.0;
  if (torque && (unit == "Nm" || unit == "N.m" || unit == "N-m" || unit == "N*m")) return 1.0;
  if (torque && (unit == "Nmm" || unit == "N.mm" || unit == "N-mm" || unit == "N*mm")) return 1e-3;
  return std::nullopt;
}

core::Result<ForceTrack> from_c3d(const fs::path& path, const ForceChannels& names) {
  const auto file = TRY(read_c3d_file(path));
  const auto wrong = [&](const std::string& what) {
    return Error{Errc::bad_input, fmt::format("{}: {}", path.string(), what)};
  };
  std::array<const AnalogChannel*, 6> at{};
  std::array<double, 6> si{};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto found = std::ranges::find(file.analog, names[k], &AnalogChannel::name);
    if (found == file.analog.end()) {
      std::string known;
      for (const auto& channel : file.analog) known += fmt::format(" '{}'", channel.name);
      return wrong(fmt::format("no analog channel '{}'; there {}", names[k],
                               known.empty() ? "is none" : "are" + known));
    }
    at[k] = &*found;
    const auto unit = si_of(found->unit, k >= 3);
    if (!unit)
      return wrong(fmt::format("channel '{}' is in '{}': {} is expected", names[k], found->unit,
                               k < 3 ? "N" : "Nm or Nmm"));
    si[k] = *unit;
  }
  ForceTrack out;
  for (std::size_t s = 0; s < at[0]->values.size(); ++s) {
    std::array<double, 6> v{};
    for (std::size_t k = 0; k < 6; ++k) v[k] = si[k] * at[k]->values[s];
    if (!std::ranges::all_of(v, [](double x) { return std::isfinite(x); }))
      return wrong(fmt::format("analog sample {} is not finite", s + 1));
    out.t_s.push_back(double(s) / file.analog_rate_Hz);
    out.wrench_S.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
  }
  return out;
}

core::Result<ForceTrack> from_csv(const fs::path& path) {
  const auto header = TRY(trial::csv_header(path));
  std::vector<std::string_view> columns{"t_s", "fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"};
  const bool stamped = std::ranges::find(header, "arrived_s") != header.end();
  if (stamped) columns.emplace_back("arrived_s");
  ForceTrack out;
  std::vector<double> arrived_s;
  TRY(trial::read_csv(path, columns, [&](std::size_t, std::span<const double> v) {
    if (!out.t_s.empty() && v[0] <= out.t_s.back()) return std::string("time does not run forward");
    out.t_s.push_back(v[0]);
    out.wrench_S.push_back({{v[1], v[2], v[3]}, {v[4], v[5], v[6]}});
    if (stamped) arrived_s.push_back(v[7]);
    return std::string();
  }));
  if (stamped) {
    const auto rate = device_rate(out.t_s, arrived_s);
    if (!rate)
      return Error{rate.error().code, fmt::format("{}: {}", path.string(), rate.error().what)};
    for (double& t : out.t_s) t *= *rate;
  }
  return out;
}
}  // namespace

core::Result<ForceTrack> read_force(const fs::path& path, const ForceChannels& channels) {
  core::require(channels.size() == 6, "a wrench has six channels");
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{Errc::not_found, fmt::format("{}: cannot be read", path.string())};
  file.get();
  const bool c3d = file.get() == 0x50 && path.extension() != ".csv";
  file.close();
  auto out = c3d ? from_c3d(path, channels) : from_csv(path);
  if (out && out->t_s.size() < 2)
    return Error{Errc::bad_input, fmt::format("{}: two rows at least are expected", path.string())};
  return out;
}

core::Result<double> device_rate(std::span<const double> t_s, std::span<const double> arrived_s) {
  if (t_s.size() < 2 || t_s.back() - t_s.front() < kLeast_s) return 1.0;
  // The least late sample of each stretch.
  struct Least {
    double t_s, arrived_s;
  };
  std::vector<Least> least;
  const std::size_t each = std::max<std::size_t>(1, t_s.size() / kStretches);
  for (std::size_t from = 0; from < t_s.size(); from += each) {
    std::size_t best = from;
    for (std::size_t k = from; k < std::min(t_s.size(), from + each); ++k)
      if (arrived_s[k] - t_s[k] < arrived_s[best] - t_s[best]) best = k;
    least.push_back({t_s[best], arrived_s[best]});
  }
  std::vector<double> slopes;
  const double apart_s = 0.25 * (t_s.back() - t_s.front());  // close ones tell little
  for (std::size_t a = 0; a < least.size(); ++a)
    for (std::size_t b = a + 1; b < least.size(); ++b)
      if (least[b].t_s - least[a].t_s > apart_s)
        slopes.push_back((least[b].arrived_s - least[a].arrived_s) / (least[b].t_s - least[a].t_s));
  if (slopes.empty()) return 1.0;
  const auto middle = slopes.begin() + std::ptrdiff_t(slopes.size() / 2);
  std::nth_element(slopes.begin(), middle, slopes.end());
  if (!(std::abs(*middle - 1.0) < kFarthest))
    return Error{Errc::bad_input,
                 fmt::format("t_s and arrived_s run apart: a second of one is {:.3f} s of the "
                             "other",
                             *middle)};
  return *middle;
}

}  // namespace capture
}  // namespace tractus
