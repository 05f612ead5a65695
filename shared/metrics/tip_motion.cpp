#include "metrics/tip_motion.hpp"

#include <algorithm>

#include "metrics/probing_sections.hpp"
#include "trial/signals.hpp"

namespace tractus {
namespace metrics {
namespace {

constexpr double kEdge = 1e-6;  // of a step: a sample this near to the grid's end still reaches it
constexpr double kLongest_s = 7200.0;

/// Lays samples on the grid: `point` and `force` of each, straight between neighbours.
template <class Samples, class Point, class Force>
TipMotion even(const Samples& samples, const Point& point, const Force& force) {
  TipMotion out;
  if (samples.size() < 2) return {{}, {}, "the trial is shorter than 0.2 s"};
  const double start_s = samples.front().t_s;
  if (samples.back().t_s - start_s > kLongest_s)
    return {{}, {}, "the trial is longer than two hours"};
  const auto steps = std::size_t((samples.back().t_s - start_s) * kMotionRate_Hz + kEdge);
  std::size_t next = 1;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double t_s = start_s + double(i) / kMotionRate_Hz;
    while (next + 1 < samples.size() && samples[next].t_s < t_s) ++next;
    const auto& before = samples[next - 1];
    const auto& after = samples[next];
    const double span_s = after.t_s - before.t_s;
    const double share = span_s > 0.0 ? std::clamp((t_s - before.t_s) / span_s, 0.0, 1.0) : 1.0;
    out.points_m.push_back((1.0 - share) * point(before) + share * point(after));
    out.force_N.push_back((1.0 - share) * force(before) + share * force(after));
  }
  return out;
}

TipMotion computed_motion(const Subject& subject) {
  if (subject.trial.header.rig == trial::Rig::probing) {
    const auto motion = probing_motion(subject.trial);
    if (motion.empty()) return {{}, {}, "the probe never turned fast enough to move"};
    return even(
        motion, [](const auto& s) { return math::Vec3(s.x_m, 0.0, 0.0); },
        [](const auto& s) { return double(s.fz_N); });
  }
  const auto probe = trial::probe_shape(subject.trial.header);
  if (!probe) return {{}, {}, "the trial does not say how long the probe is"};
  return even(
      subject.trial.samples, [&](const auto& s) { return trial::tip_m(s, *probe); },
      [](const auto& s) {
        return double(math::Vec3(s.force_N[0], s.force_N[1], s.force_N[2]).norm());
      });
}

}  // namespace

const TipMotion& tip_motion(const Subject& subject) {
  auto& kept = subject.derived.tip_motion;
  if (!kept) kept = std::make_shared<const TipMotion>(computed_motion(subject));
  return *kept;
}

Score score_of_kinematics(
    const Subject& subject,
    const std::function<std::optional<double>(const TipMotion&, const Kinematics&)>& score) {
  const TipMotion& motion = tip_motion(subject);
  if (!motion.why_not.empty()) return {{}, motion.why_not};
  auto& kept = subject.derived.kinematics;
  if (!kept)
    kept = std::make_shared<const std::optional<Kinematics>>(
        kinematics(motion.points_m, 1.0 / kMotionRate_Hz));
  const std::optional<Kinematics>& k = *kept;
  if (!k) return {{}, "the trial is shorter than 0.2 s"};
  const auto value = score(motion, *k);
  return {value, value ? "" : "the tip did not move, or not for long enough"};
}

}  // namespace metrics
}  // namespace tractus
