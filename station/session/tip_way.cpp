#include "station/session/tip_way.hpp"

namespace tractus::session {

void TipWay::add(std::span<const trial::Sample> samples) {
  const std::lock_guard held(mutex_);
  for (const trial::Sample& sample : samples) {
    last_m_ = trial::tip_m(sample, probe_);
    const double depth_m = tract_.depth_of(last_m_);
    if (!seen_.deepest || depth_m > deepest_m_) {
      deepest_m_ = depth_m;
      seen_.deepest = sample;
    }
    if (!seen_.withdrawn || depth_m > -kClear_m) seen_.withdrawn = sample;
    add_point(last_m_);
  }
}

void TipWay::add_point(const math::Vec3& tip_m) {
  auto& points = seen_.points_m;
  if (!points.empty() && (tip_m - points.back()).norm() < step_m_) return;
  points.push_back(tip_m);
  if (points.size() < kPoints) return;
  for (std::size_t i = 0; 2 * i < points.size(); ++i) points[i] = points[2 * i];
  points.resize((points.size() + 1) / 2);
  step_m_ *= 2.0;
}

void TipWay::show(Snapshot& seen) const {
  const std::unique_lock held(mutex_, std::try_to_lock);
  if (!held) return;
  seen = seen_;
  if (!seen.points_m.empty()) seen.points_m.push_back(last_m_);
}

}  // namespace tractus::session
