#include "station/check/threshold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "station/check/driver.hpp"

namespace tractus {
namespace check {
namespace {
using math::Vec3;
using math::Wrench;

constexpr const char* kObserverFormat = "tractus-observer/1";
constexpr double kPauseBefore_s = 0.4, kPush_s = 1.0, kPushRamp_s = 0.15, kStroke_s = 3.0;
constexpr double kPatience_s = 120.0;
constexpr double kToWall_m = 0.005;     // to the right of where the handle is
constexpr double kGapWithin_m = 0.010;  // of its height
constexpr double kMostOfWall_N = 3.0;

struct LevelRange {
  double least, greatest;
};
LevelRange range_of(Stimulus stimulus) {
  switch (stimulus) {
    case Stimulus::detection:
      return {0.004, 0.4};
    case Stimulus::difference:
      return {0.01, 1.0};
    case Stimulus::gap:
      return {0.00005, 0.004};
  }
  return {};
}

/// 0 … 1 … 0, with cosine flanks.
double envelope_at(double t_s, double length_s) {
  const double flank = std::clamp(std::min(t_s, length_s - t_s) / kPushRamp_s, 0.0, 1.0);
  return 0.5 * (1.0 - std::cos(std::numbers::pi * flank));
}

/// A wall to the right, along z, with a recess; its force is the gradient of ½ k depth², so that it
/// gives back no more energy than it got.
struct GappedWall {
  double surface_y_m, gap_z_m, gap_m;

  Wrench at(const Vec3& p) const {
    const double phase = 2.0 * std::numbers::pi * (p.z() - gap_z_m) / kGapWidth_m;
    const bool in_gap = std::abs(phase) < std::numbers::pi;
    const double recess_m = in_gap ? 0.5 * gap_m * (1.0 + std::cos(phase)) : 0.0;
    const double slope = in_gap ? -gap_m * std::numbers::pi / kGapWidth_m * std::sin(phase) : 0.0;
    const double into_m = std::max(0.0, p.y() - surface_y_m - recess_m);
    const double force_N = std::min(kMostOfWall_N, kWallStiffness_N_per_m * into_m);
    return {Vec3(0.0, -force_N, force_N * slope), Vec3::Zero()};
  }
};

/// Questions over a driver that ticks.
class Questions {
 public:
  Questions(Driver& driver, const Bench& bench, Stimulus stimulus, const Asked& asked)
      : driver_(driver), bench_(bench), stimulus_(stimulus), asked_(asked) {}

  /// Errors: unavailable, cancelled.
  core::Result<int> ask(double level, int with_more, double gap_at) {
    const GappedWall wall{0.0, gap_at * kGapWithin_m, level};
    for (const int interval : {1, 2}) {
      TRY(pause());
      asked_.begins(stimulus_, interval == 1 ? Moment::first : Moment::second);
      TRY(present(interval == with_more ? level : 0.0, wall));
    }
    asked_.begins(stimulus_, Moment::answer);
    return answer();
  }
  double share_done = 0.0;

 private:
  core::Result<void> pause() {
    asked_.begins(stimulus_, Moment::pause);
    return run(kPauseBefore_s, [](double) { return Wrench{}; });
  }
  core::Result<void> present(double level, GappedWall wall) {
    if (stimulus_ != Stimulus::gap)
      return run(kPush_s, [&](double t_s) {
        const double least_N = stimulus_ == Stimulus::difference ? kReference_N : 0.0;
        return Wrench{Vec3(0.0, (least_N + level) * envelope_at(t_s, kPush_s), 0.0), Vec3::Zero()};
      });
    wall.surface_y_m = last_.y() + kToWall_m;
    wall.gap_z_m += last_.z();
    wall.gap_m = level;
    return run(kStroke_s, [&](double) { return wall.at(last_); });
  }
  template <class Wanted>
  core::Result<void> run(double for_s, const Wanted& wanted) {
    const int ticks = int(for_s * bench_.rate_Hz);
    for (int k = 0; k < ticks; ++k) TRY(tick(wanted(double(k) / bench_.rate_Hz)));
    return {};
  }
  core::Result<void> tick(const Wrench& wanted) {
    last_ = TRY(driver_.tick(wanted)).X_DH.p;
    if (ticks_++ % std::max(1, int(bench_.rate_Hz / 30.0)) == 0 && bench_.progress &&
        !bench_.progress(share_done))
      return core::Error{core::Errc::cancelled, "stopped"};
    return {};
  }
  core::Result<int> answer() {
    for (int k = 0; k < int(kPatience_s * bench_.rate_Hz); ++k) {
      if (const int said = asked_.answer(); said == 1 || said == 2) return said;
      TRY(tick({}));
    }
    return core::Error{core::Errc::unavailable, "nobody answered for two minutes: begin again"};
  }

  Driver& driver_;
  const Bench& bench_;
  Stimulus stimulus_;
  const Asked& asked_;
  Vec3 last_ = Vec3::Zero();
  long ticks_ = 0;
};

const MeasuredThreshold* found(const std::vector<MeasuredThreshold>& all, Stimulus stimulus) {
  const auto at = std::ranges::find(all, stimulus, &MeasuredThreshold::stimulus);
  return at == all.end() ? nullptr : &*at;
}
}  // namespace

core::Result<MeasuredThreshold> measure_threshold(Bench bench, Stimulus stimulus, int questions,
                                                  std::uint64_t seed, const Asked& asked) {
  Driver driver(bench);
  TRY(driver.run(bench.limiter.limits().ramp_s + kPauseBefore_s, {}));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  const LevelRange range = range_of(stimulus);
  statistics::Psi psi(range.least, range.greatest);
  Questions question(driver, bench, stimulus, asked);
  MeasuredThreshold out{.stimulus = stimulus};
  for (; out.questions < questions; ++out.questions) {
    question.share_done = double(out.questions) / questions;
    const double level = psi.level();
    const int with_more = random() % 2 == 0 ? 1 : 2;
    const bool right = TRY(question.ask(level, with_more, place(random))) == with_more;
    psi.answered(level, right);
    out.right += right;
  }
  out.threshold = psi.threshold();
  return out;
}

core::Json MeasuredThreshold::to_json() const {
  const char* unit = stimulus == Stimulus::gap ? "m" : "N";
  const auto key = [&](const char* what) { return fmt::format("{}_{}", what, unit); };
  core::Json out = {{"questions", questions},
                    {"right", right},
                    {"slope", threshold.slope},
                    {key("median"), threshold.median},
                    {key("low"), threshold.interval_95.low},
                    {key("high"), threshold.interval_95.high}};
  if (stimulus == Stimulus::difference) out["reference_N"] = kReference_N;
  if (stimulus == Stimulus::gap) {
    out["stiffness_N_per_m"] = kWallStiffness_N_per_m;
    out["width_m"] = kGapWidth_m;
  }
  return out;
}

core::Json ObserverRecord::to_json() const {
  const auto* detection = found(measured, Stimulus::detection);
  const auto* difference = found(measured, Stimulus::difference);
  core::require(detection && difference, "both were measured");
  const double t = detection->threshold.median, j = difference->threshold.median;
  core::Json out = {{"format", kObserverFormat},
                    {"at_utc_us", at_utc_us},
                    {"device", device},
                    {"who", who},
                    {"simulated", simulated},
                    {"thresholds", core::Json::object()},
                    {"perception",
                     {{"force_threshold_N", t},
                      {"force_weber", std::sqrt(std::max(0.0, j * j - t * t)) / kReference_N}}}};
  for (const MeasuredThreshold& one : measured)
    out["thresholds"][std::string(name(one.stimulus))] = one.to_json();
  return out;
}

}  // namespace check
}  // namespace tractus
