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
constexpr double kBeforeBone_m = 0.012;  // Where the first feed begins: bone may reach so far out.
constexpr double kMouth_m = -0.002;
constexpr double kClear_m = -0.025;  // out of the bone and of what lies beside the mouth
constexpr double kShortOfEnd_m = 0.001;
constexpr double kBack_m = 0.004;
constexpr int kFeeds = 8;
constexpr double kTipFirst_rad = 0.07;    // beyond 3δ/2L
constexpr double kShallowest_m = 0.0045;  // beyond where bone begins all round
constexpr double kRecheck_m = 0.005;      // to both sides of a suspect
constexpr double kTremor_m = 0.00010;     // amplitude of each of three waves per axis
constexpr double kTremor_rad = 0.0008;

double minimum_jerk(double s) { return s * s * s * (10.0 + s * (-15.0 + 6.0 * s)); }
}  // namespace

PalpationPlan::PalpationPlan(const DeviceOptions& options)
    : channel_(options.channel),
      probe_length_m_(options.probe_length_m),
      deepest_m_(options.channel.length_m - kShortOfEnd_m - options.channel.radius_m),
      shallowest_m_(std::min(options.channel.enclosed_from_m + kShallowest_m, 0.5 * deepest_m_)),
      random_(options.seed) {
  keys_.push_back({.depth_m = -kOutside_m});
  add(0.6, {.depth_m = -kOutside_m});
  options.tool == Tool::burr ? plan_drilling() : plan_palpation();
  add(1.5, {.depth_m = -kOutside_m, .act = Act::withdraw});
  const double scale = options.duration_s / keys_.back().t_s;
  for (Key& key : keys_) key.t_s *= scale;
  rechecks_from_s_ *= scale;
  // Three waves of one amplitude a: their sum has the standard deviation a √1.5.
  const double wander_m = options.sense.wander_m / std::sqrt(1.5);
  for (std::size_t axis = 0; axis < waves_.size(); ++axis)
    for (std::size_t n = 0; n < waves_[axis].size(); ++n) {
      const bool slow = n >= 3;
      const double amplitude = axis >= 3 ? (slow ? 0.0 : kTremor_rad) : slow ? wander_m : kTremor_m;
      const double hertz = slow ? 0.2 + 1.8 * uniform() : 8.0 + 4.0 * uniform();
      waves_[axis][n] = {slow ? amplitude : amplitude * (0.5 + uniform()), 2.0 * kPi * hertz,
                         2.0 * kPi * uniform()};
    }
}

void PalpationPlan::plan_palpation() {
  add(1.2, {.depth_m = kMouth_m, .act = Act::approach});
  for (int wall = 0; wall < 4; ++wall) {
    Key key{.depth_m = deepest_m_, .act = Act::approach, .wall = wall};
    add(0.6, key);
    key.press = 1.0;
    add(0.6, key);
    key.act = Act::stroke;
    for (key.look = 0; key.look < kFirstLooks; ++key.look) {
      key.depth_m = key.look % 2 == 0 ? shallowest_m_ : deepest_m_;
      add(1.8, key);
    }
    key.act = Act::approach, key.press = 0.0, key.look = -1;
    add(0.3, key);
    key.depth_m = kMouth_m;
    add(0.5, key);
  }
  add(1.6, {.depth_m = deepest_m_, .act = Act::approach});
  for (int tap = 0; tap < 3; ++tap) {
    add(0.5, {.depth_m = channel_.length_m + kTapBeyond_m, .act = Act::tap});
    add(0.4, {.depth_m = deepest_m_, .act = Act::approach});
  }
  rechecks_from_s_ = keys_.back().t_s;
  for (int suspect = 0; suspect < kSuspects; ++suspect) plan_recheck(suspect);
}

void PalpationPlan::plan_recheck(int suspect) {
  Key key{.depth_m = kRecheck_m, .act = Act::approach, .suspect = suspect};
  add(0.4, key);
  key.press = 1.0;
  add(0.4, key);
  key.act = Act::stroke;
  for (key.look = kFirstLooks; key.look < kLooks; ++key.look) {
    key.depth_m = -key.depth_m;
    add(0.6, key);
  }
  key.act = Act::approach, key.press = 0.0, key.look = -1;
  add(0.3, key);
}

void PalpationPlan::plan_drilling() {
  const double end_m = channel_.length_m - kShortOfEnd_m;
  const double feed_m = (end_m + kBeforeBone_m) / kFeeds;
  add(1.0, {.depth_m = -kBeforeBone_m, .act = Act::approach});
  for (int feed = 1; feed <= kFeeds; ++feed) {
    const double bottom_m = -kBeforeBone_m + feed * feed_m;
    add(3.0, {.depth_m = bottom_m, .act = Act::drill});
    add(0.5, {.depth_m = bottom_m, .act = Act::drill});
    if (feed == kFeeds) break;
    add(0.5, {.depth_m = bottom_m - kBack_m, .act = Act::withdraw});
    add(0.5, {.depth_m = bottom_m - 0.0005, .act = Act::approach});
  }
}

void PalpationPlan::add(double weight_s, Key key) {
  key.t_s = keys_.back().t_s + weight_s * (0.85 + 0.3 * uniform());
  keys_.push_back(key);
}

PalpationPlan::Key PalpationPlan::resolved(Key key) const noexcept {
  if (key.suspect < 0) return key;
  const Suspect& suspect = suspects_[std::size_t(key.suspect)];
  key.wall = suspect.wall;
  key.depth_m = std::clamp(suspect.depth_m + key.depth_m, shallowest_m_, deepest_m_);
  return key;
}

// SplitMix64 [Steele2014]: the same bits with every library, unlike the standard's distributions.
double PalpationPlan::uniform() noexcept {
  std::uint64_t z = (random_ += 0x9e3779b97f4a7c15ull);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

double PalpationPlan::unsteadiness(int axis, double t_s) const noexcept {
  double sum = 0.0;
  for (const Wave& wave : waves_[std::size_t(axis)])
    if (wave.amplitude > 0.0)
      sum += wave.amplitude * std::sin(wave.frequency_rad_s * t_s + wave.phase_rad);
  return sum;
}

Intent PalpationPlan::at(double t_s, const Grip& grip) const noexcept {
  const double t = std::clamp(t_s, 0.0, duration_s());
  std::size_t next = 1;
  while (next + 1 < keys_.size() && keys_[next].t_s < t) ++next;
  const Key from = resolved(keys_[next - 1]), to = resolved(keys_[next]);
  const double s = minimum_jerk((t - from.t_s) / (to.t_s - from.t_s));
  Intent out;
  out.act = to.act, out.wall = to.wall, out.look = to.look;
  out.button = to.act == Act::drill;
  const double planned_m = from.depth_m + s * (to.depth_m - from.depth_m);
  out.depth_m = kClear_m + grip.reach * (planned_m - kClear_m);
  out.press = grip.firmness * (from.press + s * (to.press - from.press));
  const double angle = std::max(to.wall, 0) * kPi / 2.0;
  out.towards = std::cos(angle) * channel_.medial + std::sin(angle) * channel_.superior;

  const double bend = out.press * grip.bend_m;
  const double turn = 1.5 * bend / probe_length_m_ + out.press * kTipFirst_rad;
  const double aside_m = out.press * channel_.radius_m + bend * std::cos(turn);
  const math::Vec3 along = std::cos(turn) * channel_.axis + std::sin(turn) * out.towards +
                           unsteadiness(3, t) * channel_.medial +
                           unsteadiness(4, t) * channel_.superior;
  const math::Vec3 z = along.normalized();
  math::Mat3 rotation;
  rotation.col(2) = z;
  rotation.col(0) = (channel_.medial - channel_.medial.dot(z) * z).normalized();
  rotation.col(1) = z.cross(rotation.col(0));
  const math::Vec3 shake = unsteadiness(0, t) * channel_.axis +
                           unsteadiness(1, t) * channel_.medial +
                           unsteadiness(2, t) * channel_.superior;
  // Of the straight probe; the bend takes the tip back across it, and so deeper.
  const math::Vec3 tip = channel_.entry_m + (out.depth_m - bend * std::sin(turn)) * channel_.axis +
                         aside_m * out.towards + shake;
  out.X_DH = {tip - probe_length_m_ * z, math::Quat(rotation)};
  return out;
}

}  // namespace devices
}  // namespace tractus
