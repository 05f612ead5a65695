#include "cases/observer.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <ranges>

#include "core/try.hpp"

namespace tractus {
namespace cases {
namespace {

using math::Vec3;
using models::PalpationRuntime;
using volume::Tract;
using volume::Wall;

constexpr double kDepthStep_m = 0.0005;
constexpr double kShortOfEnd_m = 0.0015;  // places this near to the end feel the end
constexpr double kMostTilt_rad = 0.35;
constexpr double kTipFirst_rad = 0.07;  // beyond the bend's 3δ/2L
struct MotionGrid {
  double step_m;
  int leans;
};
constexpr std::array<MotionGrid, kMotions> kGrids{{{0.00025, 49}, {0.0005, 61}, {0.0005, 61}}};
constexpr double kFirstPush_m = -0.003, kPushStep_m = 0.00025;
constexpr int kPushes = 69;                                  // up to 14 mm beyond the end
constexpr double kNearAlong_m = 0.004, kFarAlong_m = 0.007;  // what Contrast::along compares with
constexpr double kAtBreach_m = 0.0015,
                 kBreachReach_m = 0.009;  // told at; changed by a breach within
constexpr double kHardest_N = 0.6, kHardestTap_N = 3.0;
constexpr double kNoTwin_m = 0.007;
constexpr double kOverFalse = 2.0;  // a worst whole place counts as B − FA + 2
constexpr std::array kAnyBears{Motion::tilt, Motion::parallel};
constexpr std::array kTipBears{Motion::tip_first};
constexpr double kLooks = 6.0, kAskedOfEnd_N = 0.3, kWithinTap_m = 0.003;  // of `foretold`
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// The handle whose straight probe has its tip at `tip_m` and lies along `along`.
math::Pose handle_at(const Tract& tract, const Vec3& tip_m, const Vec3& along, double length_m) {
  math::Mat3 rotation;
  rotation.col(2) = along;
  rotation.col(0) = (tract.medial - tract.medial.dot(along) * along).normalized();
  rotation.col(1) = along.cross(rotation.col(0));
  return {tip_m - length_m * along, math::Quat(rotation)};
}

/// The handle that presses so far towards a wall; none beyond a motion's reach.
std::optional<math::Pose> pressing(const Tract& tract, Motion motion, double depth_m, double lean_m,
                                   const Vec3& outward, double length_m) {
  double turn = 0.0, along_m = depth_m, aside_m = lean_m;
  if (motion == Motion::tilt) {
    turn = std::atan2(lean_m, depth_m);
    if (turn > kMostTilt_rad) return std::nullopt;
    along_m = depth_m * std::cos(turn), aside_m = depth_m * std::sin(turn);
  } else if (motion == Motion::tip_first) {
    turn = 1.5 * lean_m / length_m + kTipFirst_rad;
    along_m = depth_m - lean_m * std::sin(turn);
    aside_m = tract.radius_m + lean_m * std::cos(turn);
  }
  const Vec3 along = std::cos(turn) * tract.axis + std::sin(turn) * outward;
  return handle_at(tract, tract.entry_m + along_m * tract.axis + aside_m * outward, along,
                   length_m);
}

Vec3 outwards_of(const Tract& tract, std::size_t wall) {
  const Vec3& axis = wall < 2 ? tract.medial : tract.superior;
  return wall % 2 == 0 ? axis : Vec3(-axis);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double squared(double x) { return x * x; }

/// Weighted mean and variance of `from` about each entry of a grid of rows; weights of a Gaussian
/// of so many steps.
Observer::Felt::Grid blurred(const Palpated::Grid& from, int rows, int columns, double row_sigma,
                             double column_sigma) {
  const int row_reach = int(std::ceil(2.5 * row_sigma)),
            column_reach = int(std::ceil(2.5 * column_sigma));
  std::vector<float> weights;
  for (int a = -row_reach; a <= row_reach; ++a)
    for (int b = -column_reach; b <= column_reach; ++b)
      weights.push_back(float(
          std::exp(-0.5 * (squared(a / std::max(row_sigma, 1e-9)) + squared(b / column_sigma)))));
  Observer::Felt::Grid out{Palpated::Grid(from.size(), kNone), Palpated::Grid(from.size(), kNone)};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const auto at = std::size_t(row * columns + column);
      if (std::isnan(from[at])) continue;
      double sum = 0.0, sum1 = 0.0, sum2 = 0.0;
      std::size_t w = 0;
      for (int a = -row_reach; a <= row_reach; ++a)
        for (int b = -column_reach; b <= column_reach; ++b, ++w) {
          const int r = row + a, c = column + b;
          if (r < 0 || r >= rows || c < 0 || c >= columns) continue;
          const double value = from[std::size_t(r * columns + c)];
          if (std::isnan(value)) continue;
          sum += weights[w], sum1 += weights[w] * value, sum2 += weights[w] * value * value;
        }
      out.mean_N[at] = float(sum1 / sum);
      out.variance_N2[at] = float(std::max(0.0, sum2 / sum - squared(sum1 / sum)));
    }
  return out;
}

/// The noise of a comparison, without the spread of either side.
double noise_N2(double mean_N, const Perception& p) {
  return 1.5 * squared(p.force_threshold_N) + squared(p.force_weber * mean_N);
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// Observer::foretold's integral.
double share_of_the_greatest(double d, const std::array<double, 5>& rivals) {
  constexpr double kStep = 0.05, kReach = 6.0;
  double sum = 0.0;
  for (double z = -kReach; z <= kReach; z += kStep) {
    double p = kStep * std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
    for (const double rival : rivals) p *= normal_cdf(d + z - rival);
    sum += p;
  }
  return sum;
}

}  // namespace

Observer::Observer(const models::PalpationModel& model, const Tract& tract, double from_m)
    : model_(model),
      tract_(tract),
      from_m_(from_m),
      depths_(
          std::max(0, 1 + int((tract.length_m - kShortOfEnd_m - from_m) / kDepthStep_m + 1e-9))) {}

double Observer::depth_m(int i) const noexcept { return from_m_ + i * kDepthStep_m; }

void Observer::press(const PalpationRuntime& probe, std::size_t wall, int first, int last,
                     Palpated& out) const {
  const Vec3 outward = outwards_of(tract_, wall);
  const double length_m = model_.base.length_m;
  for (std::size_t motion = 0; motion < kMotions; ++motion) {
    const MotionGrid& grid = kGrids[motion];
    auto& into = out.side_N[motion][wall];
    into.resize(std::size_t(depths_ * grid.leans), kNone);
    tbb::parallel_for(first, last, [&](int i) {
      laws::PalpationState state;
      for (int j = 0; j < grid.leans; ++j) {
        const double lean_m = j * grid.step_m, depth = depth_m(i);
        const auto X_VH = pressing(tract_, Motion(motion), depth, lean_m, outward, length_m);
        if (!X_VH) break;
        const auto step = probe.step(*X_VH, state);
        into[std::size_t(i * grid.leans + j)] =
            float(-(X_VH->q * step.wrench_H.force_N).dot(outward));
      }
    });
  }
}

void Observer::tap(const PalpationRuntime& probe, Palpated& out) const {
  const double aside = 0.5 * tract_.radius_m;
  tbb::parallel_for(std::size_t(0), out.tap_N.size(), [&](std::size_t place) {
    const Vec3 offset = place == 0 ? Vec3::Zero() : Vec3(aside * outwards_of(tract_, place - 1));
    out.tap_N[place].assign(kPushes, kNone);
    laws::PalpationState state;
    for (int j = 0; j < kPushes; ++j) {
      const Vec3 tip = tract_.end_m() + (kFirstPush_m + j * kPushStep_m) * tract_.axis + offset;
      const auto X_VH = handle_at(tract_, tip, tract_.axis, model_.base.length_m);
      const auto step = probe.step(X_VH, state);
      out.tap_N[place][std::size_t(j)] = float(-(X_VH.q * step.wrench_H.force_N).dot(tract_.axis));
    }
  });
}

core::Result<Palpated> Observer::palpate(const volume::ForceField& field) const {
  const auto probe = TRY(PalpationRuntime::make(model_, field));
  Palpated out;
  for (std::size_t wall = 0; wall < kSideWalls; ++wall) press(probe, wall, 0, depths_, out);
  tap(probe, out);
  return out;
}

core::Result<Palpated> Observer::palpate_near(const volume::ForceField& field,
                                              const Palpated& whole, Wall wall, double at_m) const {
  const auto probe = TRY(PalpationRuntime::make(model_, field));
  Palpated out = whole;
  if (wall == Wall::anterior) {
    tap(probe, out);
    return out;
  }
  const auto index = [&](double depth) {
    return std::clamp(int(std::lround((depth - from_m_) / kDepthStep_m)), 0, depths_);
  };
  for (std::size_t w = 0; w < kSideWalls; ++w) {
    const double reach = w == std::size_t(wall) ? kBreachReach_m : kAtBreach_m + 0.001;
    press(probe, w, index(at_m - reach), index(at_m + reach), out);
  }
  return out;
}

Observer::Felt Observer::felt(const Palpated& palpated, const Perception& perception) const {
  Felt out;
  tbb::parallel_for(std::size_t(0), kMotions * kSideWalls, [&](std::size_t n) {
    const std::size_t motion = n / kSideWalls, wall = n % kSideWalls;
    out.side[motion][wall] =
        blurred(palpated.side_N[motion][wall], depths_, kGrids[motion].leans,
                perception.wander_m / kDepthStep_m, perception.wander_m / kGrids[motion].step_m);
  });
  Palpated::Grid all;
  for (const auto& place : palpated.tap_N) all.insert(all.end(), place.begin(), place.end());
  // Five places as rows, blurred along the push alone; then the mean over places and its spread.
  const auto each =
      blurred(all, int(palpated.tap_N.size()), kPushes, 0.0, perception.wander_m / kPushStep_m);
  for (int j = 0; j < kPushes; ++j) {
    double mean = 0.0, square = 0.0;
    for (std::size_t place = 0; place < palpated.tap_N.size(); ++place) {
      const auto at = place * std::size_t(kPushes) + std::size_t(j);
      mean += each.mean_N[at] / double(palpated.tap_N.size());
      square += (squared(each.mean_N[at]) + each.variance_N2[at]) / double(palpated.tap_N.size());
    }
    out.tap.mean_N.push_back(float(mean));
    out.tap.variance_N2.push_back(float(std::max(0.0, square - mean * mean)));
  }
  return out;
}

double Observer::feature(const Felt& felt, std::size_t motion, Contrast contrast, std::size_t wall,
                         int i, int j) const {
  const int leans = kGrids[motion].leans;
  const auto at = std::size_t(i * leans + j);
  const double here = felt.side[motion][wall].mean_N[at];
  if (contrast == Contrast::around) {
    std::array<double, kSideWalls> all{};
    for (std::size_t w = 0; w < kSideWalls; ++w) all[w] = felt.side[motion][w].mean_N[at];
    std::ranges::sort(all);
    return here - 0.5 * (all[1] + all[2]);
  }
  const int near = int(std::lround(kNearAlong_m / kDepthStep_m)),
            far = int(std::lround(kFarAlong_m / kDepthStep_m));
  double sum = 0.0, count = 0.0;
  for (int away = near; away <= far; ++away)
    for (const int other : {i - away, i + away}) {
      if (other < 0 || other >= depths_) continue;
      const double there = felt.side[motion][wall].mean_N[std::size_t(other * leans + j)];
      if (!std::isnan(there)) sum += there, count += 1.0;
    }
  return count > 0.0 ? here - sum / count : std::numeric_limits<double>::quiet_NaN();
}

Detectability Observer::of_side(const Felt& whole, const Felt& breached, std::size_t wall,
                                double at_m, const Perception& perception,
                                std::span<const Motion> motions) const {
  struct Place {
    double f, mean_N, variance_N2;
    std::size_t wall;
    int depth;
  };
  const bool twin = &whole != &breached;
  Detectability best;
  double best_score = -1e300;
  std::vector<Place> places;
  std::vector<double> means;
  for (const std::size_t motion :
       motions | std::views::transform([](Motion m) { return std::size_t(m); }))
    for (const Contrast contrast : core::values<Contrast>())
      for (int j = 1; j < kGrids[motion].leans; ++j) {
        places.clear(), means.clear();
        for (std::size_t w = 0; w < kSideWalls; ++w)
          for (int i = 0; i < depths_; ++i) {
            if (!twin && w == wall && std::abs(depth_m(i) - at_m) <= kNoTwin_m) continue;
            const auto at = std::size_t(i * kGrids[motion].leans + j);
            const auto& grid = whole.side[motion][w];
            const double f = feature(whole, motion, contrast, w, i, j);
            if (std::isnan(f)) continue;
            places.push_back({f, grid.mean_N[at], grid.variance_N2[at], w, i});
            means.push_back(grid.mean_N[at]);
          }
        if (places.size() < 20 || median(means) > kHardest_N) continue;
        double mean = 0.0, variance = 0.0;
        for (const Place& p : places) mean += p.f / double(places.size());
        for (const Place& p : places) variance += squared(p.f - mean) / double(places.size());
        const auto dip = [&](const Place& p) {
          return (mean - p.f) /
                 std::sqrt(variance + noise_N2(p.mean_N, perception) + p.variance_N2);
        };
        const Place& worst = *std::ranges::max_element(places, {}, dip);
        const double fa = dip(worst);
        std::array<double, kSideWalls> fa_of_wall{};
        for (const Place& p : places) fa_of_wall[p.wall] = std::max(fa_of_wall[p.wall], dip(p));
        for (int i = 0; i < depths_; ++i) {
          if (std::abs(depth_m(i) - at_m) > kAtBreach_m + 1e-9) continue;
          const auto at = std::size_t(i * kGrids[motion].leans + j);
          const double f_whole = feature(whole, motion, contrast, wall, i, j),
                       f_breached = feature(breached, motion, contrast, wall, i, j);
          if (std::isnan(f_whole) || std::isnan(f_breached)) continue;
          const auto &grid = whole.side[motion][wall], &holed = breached.side[motion][wall];
          const double sigma2 = noise_N2(grid.mean_N[at], perception) +
                                0.5 * (grid.variance_N2[at] + holed.variance_N2[at]);
          const double k = (f_whole - f_breached) / std::sqrt(sigma2),
                       b = (mean - f_breached) / std::sqrt(variance + sigma2);
          const double score = std::min({twin ? k : b, b, b - fa + kOverFalse});
          if (score <= best_score) continue;
          best_score = score;
          best = {.k = twin ? std::optional(k) : std::nullopt,
                  .b = b,
                  .fa = fa,
                  .fa_wall = Wall(worst.wall),
                  .fa_at_m = depth_m(worst.depth),
                  .fa_of_wall = fa_of_wall,
                  .motion = Motion(motion),
                  .contrast = contrast,
                  .lean_m = j * kGrids[motion].step_m,
                  .force_N = grid.mean_N[at]};
        }
      }
  return best;
}

Detectability Observer::of_end(const Felt& whole, const Felt& breached,
                               const Perception& perception) const {
  Detectability best{.k = 0.0, .b = {}, .fa = {}};
  for (std::size_t j = 0; j < std::size_t(kPushes); ++j) {
    const double force_N = whole.tap.mean_N[j];
    if (force_N > kHardestTap_N) continue;
    const double k = (force_N - breached.tap.mean_N[j]) /
                     std::sqrt(noise_N2(force_N, perception) +
                               0.5 * (whole.tap.variance_N2[j] + breached.tap.variance_N2[j]));
    if (k <= *best.k) continue;
    best.k = k, best.lean_m = kFirstPush_m + double(j) * kPushStep_m, best.force_N = force_N;
  }
  return best;
}

Detectability Observer::detect(const Felt& whole, const Felt& breached, Wall wall, double at_m,
                               const Perception& perception) const {
  if (wall != Wall::anterior)
    return of_side(whole, breached, std::size_t(wall), at_m, perception, kAnyBears);
  return &whole == &breached ? Detectability{} : of_end(whole, breached, perception);
}

double Observer::foretold(const Felt& whole, const Felt& breached, Wall wall, double at_m,
                          const Perception& once) const {
  Perception perception = once;
  perception.force_weber /= std::sqrt(kLooks), perception.force_threshold_N /= std::sqrt(kLooks);
  const double lacking_N = std::max(0.0, kAskedOfEnd_N - end_force_N(whole, kWithinTap_m)),
               open = lacking_N / std::sqrt(noise_N2(kAskedOfEnd_N, perception));
  if (wall == Wall::anterior)
    return share_of_the_greatest(open + *of_end(whole, breached, perception).k, {});
  const auto told = of_side(whole, breached, std::size_t(wall), at_m, perception, kTipBears);
  if (!told.b) return 0.0;
  std::array<double, 5> rivals{open};
  for (std::size_t w = 0; w < kSideWalls; ++w)
    if (Wall(w) != wall) rivals[1 + w] = told.fa_of_wall[w];
  return share_of_the_greatest(*told.b, rivals);
}

double Observer::end_force_N(const Felt& whole, double within_m) const {
  double most = 0.0;
  for (std::size_t j = 0; j < std::size_t(kPushes); ++j)
    if (kFirstPush_m + double(j) * kPushStep_m <= within_m)
      most = std::max(most, double(whole.tap.mean_N[j]));
  return most;
}

}  // namespace cases
}  // namespace tractus
