#include "trial/signals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace tractus {
namespace trial {
namespace {
constexpr double kMaxLength_m = 1.0;
enum Channel : std::size_t { force_xy, force_z, torque_xy, torque_z, depth, offset, angle };
static_assert(kChannels.size() == kProbingChannels.size());
enum Probing : std::size_t { push, x, speed, theta, twist, mode, round_trip };

std::optional<double> finite_number(const core::Json& json) {
  if (!json.is_number()) return std::nullopt;
  const double value = json.get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::span<const std::string_view> names_of(Rig rig) {
  if (rig == Rig::probing) return kProbingChannels;
  return kChannels;
}

struct Extremes {
  float low, high;
};

/// Eight at a time, each lane on its own, so that the compiler may use one instruction for all.
Extremes extremes_of(std::span<const float> values) {
  constexpr std::size_t kLanes = 8;
  std::array<float, kLanes> low, high;
  low.fill(values[0]);
  high.fill(values[0]);
  const std::size_t whole = values.size() - values.size() % kLanes;
  for (std::size_t at = 0; at < whole; at += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const float v = values[at + lane];
      low[lane] = v < low[lane] ? v : low[lane];
      high[lane] = v > high[lane] ? v : high[lane];
    }
  for (const float v : values.subspan(whole)) {
    low[0] = std::min(low[0], v);
    high[0] = std::max(high[0], v);
  }
  return {*std::ranges::min_element(low), *std::ranges::max_element(high)};
}

Envelope envelope_of(std::span<const float> values, std::size_t per_point) {
  Envelope out;
  const std::size_t points = (values.size() + per_point - 1) / per_point;
  out.min.reserve(points);
  out.max.reserve(points);
  for (std::size_t at = 0; at < values.size(); at += per_point) {
    const auto [low, high] =
        extremes_of(values.subspan(at, std::min(per_point, values.size() - at)));
    out.min.push_back(low);
    out.max.push_back(high);
  }
  return out;
}

float transverse(const std::array<float, 3>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1]); }
}  // namespace

std::optional<ProbeShape> probe_shape(const Header& header) {
  ProbeShape shape;
  const auto length = header.probe.find("length_m");
  if (length == header.probe.end()) return std::nullopt;
  const auto length_m = finite_number(*length);
  if (!length_m || *length_m <= 0.0 || *length_m > kMaxLength_m) return std::nullopt;
  shape.length_m = *length_m;
  const auto offset_m = header.probe.find("pose_offset_m");
  if (offset_m == header.probe.end() || offset_m->is_null()) return shape;
  if (!offset_m->is_array() || offset_m->size() != 3) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = finite_number((*offset_m)[i]);
    if (!value) return std::nullopt;
    shape.pose_offset_m[Eigen::Index(i)] = *value;
  }
  return shape;
}

math::Vec3 tip_m(const Sample& s, const ProbeShape& probe) {
  return s.pose() * math::Vec3(s.deflection_m[0], s.deflection_m[1], probe.length_m) +
         probe.pose_offset_m;
}

Signals::Signals(const Header& header, std::optional<TractLine> tract)
    : rig_(header.rig), probe_(probe_shape(header)), tract_(tract) {}

void Signals::add(const Block& block) {
  block.each([this](const auto& sample) { add(sample); });
}

void Signals::add(const Sample& s) {
  t_s_.push_back(s.t_s);
  values_[force_xy].push_back(transverse(s.force_N));
  values_[force_z].push_back(s.force_N[2]);
  values_[torque_xy].push_back(transverse(s.torque_Nm));
  values_[torque_z].push_back(s.torque_Nm[2]);
  const float along = s.force_N[2];
  const float across = values_[force_xy].back();
  force_N_.push_back(std::sqrt(across * across + along * along));
  if (!probe_) return;
  const math::Vec3 tip = tip_m(s, *probe_);
  tip_m_.push_back({float(tip.x()), float(tip.y()), float(tip.z())});
  if (!tract_) return;
  const math::Vec3 from_entry = tip - tract_->entry_m;
  const math::Vec3 shank = s.pose().q * math::Vec3::UnitZ();
  values_[depth].push_back(float(from_entry.dot(tract_->axis)));
  values_[offset].push_back(float(from_entry.cross(tract_->axis).norm()));
  values_[angle].push_back(
      float(std::atan2(shank.cross(tract_->axis).norm(), shank.dot(tract_->axis))));
}

void Signals::add(const ProbingSample& s) {
  t_s_.push_back(s.t_s);
  values_[push].push_back(s.fz_N);
  values_[x].push_back(float(s.x_m));
  values_[speed].push_back(s.speed_m_s);
  values_[theta].push_back(float(s.theta_rad));
  values_[twist].push_back(s.tz_Nm);
  values_[mode].push_back(float(s.mode));
  values_[round_trip].push_back(s.round_trip_s);
}

std::optional<std::size_t> Signals::index_of(std::string_view channel) const {
  const auto names = names_of(rig_);
  const auto found = std::ranges::find(names, channel);
  if (found == names.end()) return std::nullopt;
  return std::size_t(found - names.begin());
}

bool Signals::has(std::string_view channel) const {
  const auto index = index_of(channel);
  return index && (rig_ == Rig::probing || *index < depth || (probe_ && tract_));
}

std::vector<std::string> Signals::channels() const {
  std::vector<std::string> out;
  for (const auto name : names_of(rig_))
    if (has(name)) out.emplace_back(name);
  return out;
}

core::Result<View> Signals::view(std::span<const std::string> channels, double from_s, double to_s,
                                 std::size_t points) const {
  using core::Errc;
  if (points == 0) return core::Error{Errc::bad_input, "points: at least 1 is expected"};
  if (!(from_s <= to_s))
    return core::Error{Errc::bad_input,
                       fmt::format("from_s {} … to_s {} is not a range", from_s, to_s)};
  for (const auto& name : channels) {
    const bool known = index_of(name).has_value();
    if (!known || !has(name))
      return core::Error{
          Errc::bad_input,
          fmt::format("channel \"{}\": {}", name.substr(0, 40),
                      known ? "this trial's probe or tract is not known"
                            : fmt::format("expected {}", fmt::join(names_of(rig_), ", ")))};
  }
  const auto begin = std::size_t(std::ranges::lower_bound(t_s_, from_s) - t_s_.begin());
  const auto end = std::size_t(std::ranges::upper_bound(t_s_, to_s) - t_s_.begin());
  const std::size_t count = end - begin;
  View view;
  view.samples_per_point = std::max<std::size_t>(1, count / points + (count % points != 0));
  if (count > 0) {
    view.from_s = t_s_[begin];
    view.to_s = t_s_[end - 1];
  }
  for (std::size_t at = begin; at < end; at += view.samples_per_point)
    view.t_s.push_back(0.5 * (t_s_[at] + t_s_[std::min(at + view.samples_per_point, end) - 1]));
  for (const auto& name : channels) {
    const std::span<const float> values(values_[*index_of(name)]);
    view.channels.emplace_back(name,
                               envelope_of(values.subspan(begin, count), view.samples_per_point));
  }
  return view;
}

Path Signals::path(std::size_t points) const {
  Path path;
  if (tip_m_.empty() || points == 0) return path;
  const double start_s = t_s_.front(), span_s = t_s_.back() - start_s;
  const auto stretch_of = [&](std::size_t i) {
    if (span_s <= 0.0) return std::size_t{0};
    const double share = (t_s_[i] - start_s) / span_s;
    return std::min(points - 1, std::size_t(share * double(points)));
  };
  std::size_t at = 0;
  while (at < t_s_.size()) {
    const std::size_t stretch = stretch_of(at);
    std::size_t strongest = at;
    for (; at < t_s_.size() && stretch_of(at) == stretch; ++at)
      if (force_N_[at] > force_N_[strongest]) strongest = at;
    const auto& tip = tip_m_[strongest];
    path.t_s.push_back(t_s_[strongest]);
    path.tip_m.emplace_back(tip[0], tip[1], tip[2]);
    path.force_N.push_back(force_N_[strongest]);
  }
  return path;
}

DepthCurve Signals::force_against_depth(std::size_t points) const {
  DepthCurve curve;
  const std::size_t stretches = points / 2, count = t_s_.size();
  if (rig_ != Rig::probing || stretches == 0) return curve;
  const std::size_t length = std::max<std::size_t>(1, (count + stretches - 1) / stretches);
  const auto& force = values_[push];
  const auto take = [&](std::size_t i) {
    curve.t_s.push_back(t_s_[i]);
    curve.depth_m.push_back(values_[x][i]);
    curve.force_N.push_back(force[i]);
    curve.mode.push_back(ProbingMode(int(values_[mode][i])));
  };
  for (std::size_t at = 0; at < count; at += length) {
    const auto begin = force.begin() + std::ptrdiff_t(at);
    const auto end = force.begin() + std::ptrdiff_t(std::min(at + length, count));
    const auto [least, most] = std::minmax_element(begin, end);
    const auto first = std::size_t(std::min(least, most) - force.begin());
    const auto second = std::size_t(std::max(least, most) - force.begin());
    take(first);
    if (second != first) take(second);
  }
  return curve;
}

}  // namespace trial
}  // namespace tractus
