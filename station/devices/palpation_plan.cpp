#include "station/devices/palpation_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tractus {
namespace devices {
namespace {
constexpr double kPi = std::numbers::pi;
constexpr double kOutside_m =
    0.030;  // How far beyond the wall the straight tip would be at the deepest point.
constexpr double kPress_m = 0.0105;
constexpr double kBeforeBone_m = 0.012;  // Where the first feed begins: bone may reach so far out.
constexpr double kShortOfEnd_m = 0.001;
constexpr double kBack_m = 0.004;
constexpr int kFeeds = 8;
constexpr double kMaxTilt_rad = 0.35;
constexpr double kSweep_rad = 0.35;  // to both sides of the wall's direction
constexpr double kSweep_Hz = 0.7;
constexpr double kTremor_m = 0.00010;  // amplitude of each of three waves per axis
constexpr double kTremor_rad = 0.0008;
constexpr double kDifference_s = 1e-4;  // for the intent's velocity

double minimum_jerk(double s) { return s * s * s * (10.0 + s * (-15.0 + 6.0 * s)); }
}  // namespace

PalpationPlan::PalpationPlan(const DeviceOptions& options)
    : channel_(options.channel),
      probe_length_m_(options.probe_length_m),
      deepest_m_(0.9 * options.channel.length_m),
      shallowest_m_(0.4 * options.channel.length_m),
      random_(options.seed) {
  keys_.push_back({0.0, -kOutside_m, 0.0, Act::rest, -1});
  add(0.6, -kOutside_m, 0.0, Act::rest);
  options.tool == Tool::burr ? plan_drilling() : plan_palpation();
  add(2.0, -kOutside_m, 0.0, Act::withdraw);
  const double scale = options.duration_s / keys_.back().t_s;
  for (Key& key : keys_) key.t_s *= scale;
  for (std::size_t axis = 0; axis < tremor_.size(); ++axis)
    for (Wave& wave : tremor_[axis]) {
      const double amplitude = axis < 3 ? kTremor_m : kTremor_rad;
      wave = {amplitude * (0.5 + uniform()), 2.0 * kPi * (8.0 + 4.0 * uniform()),
              2.0 * kPi * uniform()};
    }
  sweep_phase_rad_ = 2.0 * kPi * uniform();
}

void PalpationPlan::plan_palpation() {
  add(2.0, -0.002, 0.0, Act::approach);
  add(2.0, deepest_m_, 0.0, Act::approach);
  const double tilt = std::min(kMaxTilt_rad, std::atan2(channel_.radius_m + kPress_m, deepest_m_));
  for (int wall = 0; wall < 4; ++wall) {
    const double pressed = tilt * (0.97 + 0.06 * uniform());
    for (int stroke = 0; stroke < 2; ++stroke) {
      add(0.6, deepest_m_, pressed, Act::approach, wall);
      add(1.8, shallowest_m_ * (0.97 + 0.06 * uniform()), pressed, Act::stroke, wall);
      add(0.4, shallowest_m_, 0.0, Act::approach, wall);
      add(0.6, deepest_m_, 0.0, Act::approach, wall);
    }
  }
  for (int tap = 0; tap < 3; ++tap) {
    add(0.7, channel_.length_m + kTapBeyond_m, 0.0, Act::tap);
    add(0.5, deepest_m_, 0.0, Act::approach);
  }
}

void PalpationPlan::plan_drilling() {
  const double end_m = channel_.length_m - kShortOfEnd_m;
  const double feed_m = (end_m + kBeforeBone_m) / kFeeds;
  add(1.0, -kBeforeBone_m, 0.0, Act::approach);
  for (int feed = 1; feed <= kFeeds; ++feed) {
    const double bottom_m = -kBeforeBone_m + feed * feed_m;
    add(3.0, bottom_m, 0.0, Act::drill);
    add(0.5, bottom_m, 0.0, Act::drill);
    if (feed == kFeeds) break;
    add(0.5, bottom_m - kBack_m, 0.0, Act::withdraw);
    add(0.5, bottom_m - 0.0005, 0.0, Act::approach);
  }
}

void PalpationPlan::add(double weight_s, double depth_m, double tilt_rad, Act act, int wall) {
  const double length_s = weight_s * (0.85 + 0.3 * uniform());
  keys_.push_back({keys_.back().t_s + length_s, depth_m, tilt_rad, act, wall});
}

// SplitMix64 [Steele2014]: the same bits with every library, unlike the standard's distributions.
double PalpationPlan::uniform() noexcept {
  std::uint64_t z = (random_ += 0x9e3779b97f4a7c15ull);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

double PalpationPlan::tremor(int axis, double t_s) const noexcept {
  double sum = 0.0;
  for (const Wave& wave : tremor_[std::size_t(axis)])
    sum += wave.amplitude * std::sin(wave.frequency_rad_s * t_s + wave.phase_rad);
  return sum;
}

math::Pose PalpationPlan::pose_at(double t_s, double lean, Intent& intent) const noexcept {
  const double t = std::clamp(t_s, 0.0, duration_s());
  std::size_t next = 1;
  while (next + 1 < keys_.size() && keys_[next].t_s < t) ++next;
  const Key &from = keys_[next - 1], &to = keys_[next];
  const double s = minimum_jerk((t - from.t_s) / (to.t_s - from.t_s));
  intent.act = to.act;
  intent.button = to.act == Act::drill;
  intent.wall = to.act == Act::stroke ? to.wall : -1;
  intent.depth_m = from.depth_m + s * (to.depth_m - from.depth_m);
  const double tilt = lean * (from.tilt_rad + s * (to.tilt_rad - from.tilt_rad));
  const double angle = std::max(to.wall, 0) * kPi / 2.0 +
                       kSweep_rad * std::sin(2.0 * kPi * kSweep_Hz * t + sweep_phase_rad_);
  const math::Vec3 press = std::cos(angle) * channel_.medial + std::sin(angle) * channel_.superior;
  intent.press = press;

  const math::Vec3 along = std::cos(tilt) * channel_.axis + std::sin(tilt) * press +
                           tremor(3, t) * channel_.medial + tremor(4, t) * channel_.superior;
  const math::Vec3 z = along.normalized();
  math::Mat3 rotation;
  rotation.col(2) = z;
  rotation.col(0) = (channel_.medial - channel_.medial.dot(z) * z).normalized();
  rotation.col(1) = z.cross(rotation.col(0));
  const math::Vec3 shake = tremor(0, t) * channel_.axis + tremor(1, t) * channel_.medial +
                           tremor(2, t) * channel_.superior;
  const math::Vec3 tip = channel_.entry_m + intent.depth_m * z + shake;
  return {tip - probe_length_m_ * z, math::Quat(rotation)};
}

Intent PalpationPlan::at(double t_s, double lean) const noexcept {
  Intent intent;
  const math::Vec3 before = pose_at(t_s - kDifference_s, lean, intent).p;
  intent.X_DH = pose_at(t_s, lean, intent);
  Intent ignored;
  intent.velocity_m_s =
      (pose_at(t_s + kDifference_s, lean, ignored).p - before) / (2.0 * kDifference_s);
  return intent;
}

}  // namespace devices
}  // namespace tractus
