#include "capture/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace capture {
namespace {
using core::Errc;
using core::Error;
using math::Vec3;

constexpr double kBesideTaps_s = 0.5, kShown_s = 0.4;
constexpr double kLongestGap_s = 0.05;  // of the capture: beyond it a body was not seen

core::Result<BodyTrack> track_of(const Motion& motion, const Carrier& carrier,
                                 const std::string& file) {
  if (!carrier.shape.empty()) {
    auto fitted = fit_body(motion, carrier.shape);
    if (!fitted)
      return Error{fitted.error().code,
                   fmt::format("{}: {}: {}", file, carrier.body, fitted.error().what)};
    return fitted;
  }
  const auto found = motion.bodies.find(carrier.body);
  if (found == motion.bodies.end() || found->second.t_s.empty()) {
    std::string known;
    for (const auto& [name, track] : motion.bodies) known += (known.empty() ? "" : ", ") + name;
    return Error{Errc::bad_input, fmt::format("{}: no body '{}'; there is {}", file, carrier.body,
                                              known.empty() ? "none" : known)};
  }
  return found->second;
}

/// A body's pose at a time, between its frames; nothing where it was not seen.
std::optional<math::Pose> pose_at(const BodyTrack& track, double t_s) {
  const auto after = std::ranges::lower_bound(track.t_s, t_s);
  if (after == track.t_s.end()) return std::nullopt;
  const auto k = std::size_t(after - track.t_s.begin());
  if (track.t_s[k] == t_s) return track.X_CB[k];
  if (k == 0 || track.t_s[k] - track.t_s[k - 1] > kLongestGap_s) return std::nullopt;
  const double share = (t_s - track.t_s[k - 1]) / (track.t_s[k] - track.t_s[k - 1]);
  const math::Pose &a = track.X_CB[k - 1], &b = track.X_CB[k];
  return math::Pose{a.p + share * (b.p - a.p), a.q.slerp(share, b.q)};
}

/// X_VH over time, eq. (1).
struct Probe {
  std::vector<double> t_s;
  std::vector<math::Pose> X_VH;
};

Probe probe_of(const Recipe& recipe, const BodyTrack& tool, const BodyTrack* bone, double rate_Hz) {
  Probe out;
  std::vector<double> times = tool.t_s;
  if (rate_Hz > 0.0) {
    times.clear();
    for (double t = tool.t_s.front(); t <= tool.t_s.back(); t += 1.0 / rate_Hz) times.push_back(t);
  }
  for (const double t : times) {
    const auto X_CT = pose_at(tool, t);
    const auto X_CB = bone ? pose_at(*bone, t) : std::optional(math::Pose{});
    if (!X_CT || !X_CB) continue;
    const math::Pose X_CV = bone ? *X_CB * recipe.bone->X_BF : math::Pose{};
    out.t_s.push_back(t);
    out.X_VH.push_back(X_CV.inverse() * (*X_CT * recipe.tool.X_BF));
  }
  return out;
}

/// Mean wrench over t ± half; nothing where the recording has no sample there.
std::optional<math::Wrench> mean_about(const ForceTrack& force, double t_s, double half_s) {
  const auto from = std::ranges::lower_bound(force.t_s, t_s - half_s);
  const auto to = std::ranges::upper_bound(force.t_s, t_s + half_s);
  if (from == force.t_s.end() || to == force.t_s.begin()) return std::nullopt;
  math::Wrench sum;
  const auto first = from - force.t_s.begin(), last = to - force.t_s.begin();
  if (first < last) {
    for (auto k = first; k < last; ++k) {
      sum.force_N += force.wrench_S[std::size_t(k)].force_N;
      sum.torque_Nm += force.wrench_S[std::size_t(k)].torque_Nm;
    }
    const double n = double(last - first);
    return math::Wrench{sum.force_N / n, sum.torque_Nm / n};
  }
  const auto k = std::size_t(first);  // slower than the motion: between its samples
  if (k == 0 || force.t_s[k] - force.t_s[k - 1] > kLongestGap_s) return std::nullopt;
  const double share = (t_s - force.t_s[k - 1]) / (force.t_s[k] - force.t_s[k - 1]);
  const auto mix = [&](const Vec3& a, const Vec3& b) { return Vec3(a + share * (b - a)); };
  return math::Wrench{mix(force.wrench_S[k - 1].force_N, force.wrench_S[k].force_N),
                      mix(force.wrench_S[k - 1].torque_Nm, force.wrench_S[k].torque_Nm)};
}

/// The sensor's zero: the mean over `tare_s`, a little before the first tap (or at the start).
core::Result<math::Wrench> zero_of(const ForceTrack& force, double before_s, double tare_s) {
  const double mid_s = std::max(force.t_s.front() + 0.5 * tare_s, before_s - 0.15 - 0.5 * tare_s);
  auto mean = mean_about(force, mid_s, 0.5 * tare_s);
  if (!mean) return Error{Errc::bad_input, "no force is recorded before the first tap: no zero"};
  return *mean;
}

std::vector<double> norms(const ForceTrack& force, const math::Wrench& zero) {
  std::vector<double> out(force.t_s.size());
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = (force.wrench_S[k].force_N - zero.force_N).norm();
  return out;
}

std::vector<Vec3> tips(const Recipe& recipe, const Probe& probe) {
  std::vector<Vec3> out;
  for (const math::Pose& X : probe.X_VH) out.push_back(X * Vec3(0, 0, recipe.tip_z_m));
  return out;
}

TapView view_of(const TapPair& run, const ClockFit& clock, const Tapped& tapped) {
  TapView out;
  const double from_s = run.taps_s.front() - kShown_s, to_s = run.taps_s.back() + kShown_s;
  const auto shown = [&](double t) { return t >= from_s && t <= to_s; };
  for (std::size_t k = 0; k < tapped.force_t_s.size(); ++k)
    if (const double t = clock.motion_time(tapped.force_t_s[k]); shown(t)) {
      out.force_t_s.push_back(t);
      out.force_N.push_back(tapped.force_N[k]);
    }
  for (std::size_t k = 0; k < tapped.motion_t_s.size(); ++k)
    if (shown(tapped.motion_t_s[k])) {
      out.way_t_s.push_back(tapped.motion_t_s[k]);
      out.way_m.push_back(run.inward.dot(tapped.tip_m[k]));
    }
  const double deepest = out.way_m.empty() ? 0.0 : *std::ranges::max_element(out.way_m);
  for (double& w : out.way_m) w -= deepest;
  return out;
}

/// The clocks, and the runs of taps for a person to see.
core::Result<ClockFit> clock_of(const Recipe& recipe, const Recording& recording,
                                const ForceTrack& force, const Probe& probe, Assembled& out) {
  ClockFit stated;
  stated.offset_s = recording.offset_s.value_or(0.0);
  if (recording.offset_s || recording.motion == recording.force) return stated;
  // A first zero from the start is good enough to see the taps.
  const auto zero = TRY(zero_of(force, force.t_s.front(), recipe.tare_s));
  const auto tip = tips(recipe, probe);
  const auto pull = norms(force, zero);
  const Tapped tapped{force.t_s, pull, probe.t_s, tip};
  auto clock = align(tapped, recipe.taps);
  if (!clock) return clock;
  for (const TapPair& run : clock->runs) out.taps.push_back(view_of(run, *clock, tapped));
  return clock;
}

/// Eq. (2).
math::Wrench at_handle(const Sensor& sensor, const math::Wrench& in_S, const math::Wrench& zero) {
  const double sign = sensor.by_probe ? -1.0 : 1.0;
  const Vec3 f = sensor.X_HS.q * (sign * (in_S.force_N - zero.force_N));
  const Vec3 t = sensor.X_HS.q * (sign * (in_S.torque_Nm - zero.torque_Nm));
  return {f, t + sensor.X_HS.p.cross(f)};
}

/// Angle between the push of the taps' peaks and the way out of the surface, rad, 0 … π; nothing
/// where no tap has both a force and a pose.
std::optional<double> push_off(const Recipe& recipe, const ForceTrack& force, const Probe& probe,
                               const ClockFit& clock, const math::Wrench& zero) {
  Vec3 push = Vec3::Zero(), out_of_it = Vec3::Zero();
  for (const TapPair& run : clock.runs)
    for (const double t : run.taps_s) {
      const auto mean = mean_about(force, clock.force_time(t), 0.005);
      const auto at = std::ranges::lower_bound(probe.t_s, t);
      if (!mean || at == probe.t_s.end()) continue;
      const math::Pose& X_VH = probe.X_VH[std::size_t(at - probe.t_s.begin())];
      push += X_VH.q * at_handle(recipe.sensor, *mean, zero).force_N;
      out_of_it -= run.inward;
    }
  const double size = push.norm() * out_of_it.norm();
  if (!(size > 0.0)) return std::nullopt;
  return std::acos(std::clamp(push.dot(out_of_it) / size, -1.0, 1.0));
}

void keep_rows(const Recipe& recipe, const Recording& recording, const ForceTrack& force,
               const Probe& probe, Assembled& out) {
  const auto& runs = out.clock.runs;
  out.trial.id = recording.id;
  out.trial.file = recording.id + ".csv";
  out.trial.operator_name = recording.operator_name;
  out.trial.notes = recording.notes;
  double from_s = runs.empty() ? -1e300 : runs.front().taps_s.back() + kBesideTaps_s, to_s = 1e300;
  if (runs.size() > 1) to_s = runs.back().taps_s.front() - kBesideTaps_s;
  from_s = recording.from_s.value_or(from_s), to_s = recording.to_s.value_or(to_s);
  const double half_s = 0.5 / out.rate_Hz;
  for (std::size_t k = 0; k < probe.t_s.size(); ++k) {
    if (probe.t_s[k] < from_s || probe.t_s[k] > to_s) continue;
    const auto mean = mean_about(force, out.clock.force_time(probe.t_s[k]), half_s);
    if (!mean) continue;
    out.trial.t_s.push_back(probe.t_s[k]);
    out.trial.X_VH.push_back(probe.X_VH[k]);
    out.trial.wrench_H.push_back(at_handle(recipe.sensor, *mean, out.zero_S));
  }
  if (out.trial.t_s.size() < 2) return;
  const double first_s = out.trial.t_s.front();
  const double expected = (out.trial.t_s.back() - first_s) * out.rate_Hz + 1.0;
  out.unseen = std::max(0.0, 1.0 - double(out.trial.t_s.size()) / expected);
  for (double& t : out.trial.t_s) t -= first_s;
}

double rate_of(const std::vector<double>& t_s) {
  std::vector<double> gaps;
  for (std::size_t k = 1; k < t_s.size(); ++k) gaps.push_back(t_s[k] - t_s[k - 1]);
  std::ranges::nth_element(gaps, gaps.begin() + std::ptrdiff_t(gaps.size() / 2));
  return 1.0 / gaps[gaps.size() / 2];
}
}  // namespace

core::Result<Assembled> assemble(const Recipe& recipe, const Recording& recording) {
  const auto motion_file = recipe.folder / recording.motion;
  const auto motion = TRY(read_motion(motion_file));
  const auto force = TRY(read_force(recipe.folder / recording.force, recipe.sensor.channels));
  const auto tool = TRY(track_of(motion, recipe.tool, motion_file.string()));
  std::optional<BodyTrack> bone;
  if (recipe.bone) {
    auto found = TRY(track_of(motion, *recipe.bone, motion_file.string()));
    bone = std::move(found);
  }
  const Probe probe = probe_of(recipe, tool, bone ? &*bone : nullptr, recording.rate_Hz);
  const auto named = [&](const Error& error) {
    return Error{error.code, fmt::format("{}: {}", recording.id, error.what)};
  };
  if (probe.t_s.size() < 2)
    return named({Errc::bad_input, "tool and bone are never seen together"});
  Assembled out;
  out.rate_Hz = recording.rate_Hz > 0.0 ? recording.rate_Hz : rate_of(probe.t_s);
  auto clock = clock_of(recipe, recording, force, probe, out);
  if (!clock) return named(clock.error());
  out.clock = std::move(*clock);
  const auto& runs = out.clock.runs;
  const double first_tap_s =
      runs.empty() ? force.t_s.front() : out.clock.force_time(runs.front().taps_s.front());
  const auto zero = zero_of(force, first_tap_s, recipe.tare_s);
  if (!zero) return named(zero.error());
  out.zero_S = *zero;
  out.push_off_rad = push_off(recipe, force, probe, out.clock, *zero);
  keep_rows(recipe, recording, force, probe, out);
  if (out.trial.t_s.size() < 2)
    return named({Errc::bad_input,
                  "nothing is left after the taps where force and motion are both "
                  "recorded"});
  return out;
}

}  // namespace capture
}  // namespace tractus
