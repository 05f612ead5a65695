#include "capture/taps.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace tractus {
namespace capture {
namespace {
using math::Vec3;

constexpr double kSoonest_s = 0.12, kLatest_s = 1.5;
constexpr double kBetween = 1.0 / 3.0, kLeastHeight = 0.5;
constexpr double kLevels = 0.8;  // each is the next one's share
constexpr double kLeastForce_N = 0.5, kLeastWay_m = 0.002;

struct Peak {
  double t_s = 0.0, height = 0.0;
  std::size_t at = 0;
};

/// The peak of the parabola through three samples: between the samples.
Peak refined(std::span<const double> t_s, std::span<const double> y, std::size_t k) {
  Peak out{t_s[k], y[k], k};
  if (k == 0 || k + 1 >= y.size()) return out;
  const double bend = y[k - 1] - 2.0 * y[k] + y[k + 1];
  if (bend >= 0.0) return out;
  const double shift = std::clamp(0.5 * (y[k - 1] - y[k + 1]) / bend, -0.5, 0.5);
  out.t_s += shift * 0.5 * (t_s[k + 1] - t_s[k - 1]);
  out.height -= 0.25 * (y[k - 1] - y[k + 1]) * shift;
  return out;
}

/// Samples that are the highest within kSoonest_s either way and above `least`.
std::vector<Peak> peaks_of(std::span<const double> t_s, std::span<const double> y, double least) {
  std::vector<Peak> out;
  std::size_t from = 0;
  for (std::size_t k = 0; k < y.size(); ++k) {
    while (t_s[k] - t_s[from] > kSoonest_s) ++from;
    if (y[k] < least) continue;
    bool highest = true;
    for (std::size_t j = from; j < y.size() && t_s[j] - t_s[k] <= kSoonest_s && highest; ++j)
      highest = j == k || y[j] < y[k] || (y[j] == y[k] && j > k);
    if (highest) out.push_back(refined(t_s, y, k));
  }
  return out;
}

/// Runs of `count` peaks in a row that look like taps; `low` gives the least value between two.
template <class Low>
void add_runs(std::span<const Peak> peaks, std::size_t n, const Low& low,
              std::vector<TapRun>& out) {
  for (std::size_t first = 0; first + n <= peaks.size(); ++first) {
    const auto run = peaks.subspan(first, n);
    const double highest = std::ranges::max(run, {}, &Peak::height).height;
    bool fits = true;
    for (std::size_t k = 0; k < n && fits; ++k) {
      fits = run[k].height >= kLeastHeight * highest;
      if (k == 0 || !fits) continue;
      const double apart = run[k].t_s - run[k - 1].t_s;
      const double weaker = std::min(run[k].height, run[k - 1].height);
      fits = apart >= kSoonest_s && apart <= kLatest_s &&
             low(run[k - 1].at, run[k].at) <= kBetween * weaker;
    }
    if (!fits) continue;
    TapRun found;
    for (const Peak& p : run) found.at_s.push_back(p.t_s), found.height.push_back(p.height);
    if (std::ranges::find(out, found.at_s, &TapRun::at_s) == out.end())
      out.push_back(std::move(found));
  }
}

/// The same among all peaks over a level, for each level: small bumps between taps, and noise, do
/// not break a run.
template <class Low>
std::vector<TapRun> runs_of(std::vector<Peak> peaks, int count, const Low& low) {
  std::vector<TapRun> out;
  double level = 0.0;
  while (peaks.size() >= std::size_t(count)) {
    add_runs(peaks, std::size_t(count), low, out);
    const double lowest = std::ranges::min(peaks, {}, &Peak::height).height;
    level = std::max(level / kLevels, lowest / kLevels);
    std::erase_if(peaks, [&](const Peak& p) { return p.height < level; });
  }
  std::ranges::sort(out, {}, [](const TapRun& run) { return run.at_s.front(); });
  return out;
}

double least_between(std::span<const double> y, std::size_t a, std::size_t b) {
  return *std::min_element(y.begin() + std::ptrdiff_t(a), y.begin() + std::ptrdiff_t(b) + 1);
}

/// The axis along which points spread most.
Vec3 principal_axis(std::span<const Vec3> points) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : points) centre += p / double(points.size());
  math::Mat3 spread = math::Mat3::Zero();
  for (const Vec3& p : points) spread += (p - centre) * (p - centre).transpose();
  return Eigen::SelfAdjointEigenSolver<math::Mat3>(spread).eigenvectors().col(2);
}

/// The axis of a run itself, the way that `rough` points: its window may hold other motion.
Vec3 axis_of_run(std::span<const double> t_s, std::span<const Vec3> tip_m, const TapRun& run,
                 const Vec3& rough) {
  const auto from = std::ranges::lower_bound(t_s, run.at_s.front() - kSoonest_s);
  const auto to = std::ranges::upper_bound(t_s, run.at_s.back() + kSoonest_s);
  const Vec3 axis =
      principal_axis(tip_m.subspan(std::size_t(from - t_s.begin()), std::size_t(to - from)));
  return axis.dot(rough) < 0.0 ? Vec3(-axis) : axis;
}

/// Is it one of those that were found already? Windows overlap.
bool is_known(const std::vector<TapRun>& known, const TapRun& run) {
  return std::ranges::any_of(known, [&](const TapRun& other) {
    return std::abs(other.at_s.front() - run.at_s.front()) < 0.5 * kSoonest_s &&
           std::abs(other.at_s.back() - run.at_s.back()) < 0.5 * kSoonest_s &&
           other.inward.dot(run.inward) > 0.0;
  });
}

/// Taps along one direction within samples begin … end: the way measured from its own low line.
std::vector<TapRun> along(std::span<const double> t_s, std::span<const Vec3> tip_m,
                          const Vec3& axis, int count) {
  std::vector<double> way(t_s.size());
  for (std::size_t k = 0; k < way.size(); ++k) way[k] = axis.dot(tip_m[k]);
  const double floor = *std::ranges::min_element(way);
  for (double& w : way) w -= floor;
  auto runs = runs_of(peaks_of(t_s, way, kLeastWay_m), count,
                      [&](std::size_t a, std::size_t b) { return least_between(way, a, b); });
  for (TapRun& run : runs) run.inward = axis_of_run(t_s, tip_m, run, axis);
  return runs;
}

}  // namespace

std::vector<TapRun> force_taps(std::span<const double> t_s, std::span<const double> force_N,
                               int count) {
  return runs_of(peaks_of(t_s, force_N, kLeastForce_N), count,
                 [&](std::size_t a, std::size_t b) { return least_between(force_N, a, b); });
}

std::vector<TapRun> motion_taps(std::span<const double> t_s, std::span<const Vec3> tip_m,
                                int count) {
  // Windows as long as a run may last, half overlapping; in each the axis of most motion, both
  // ways.
  std::vector<TapRun> out;
  const double window_s = double(count) * 1.0 + 1.0;
  for (std::size_t from = 0; from < t_s.size();) {
    std::size_t to = from, half = from;
    while (to < t_s.size() && t_s[to] - t_s[from] < window_s) {
      if (t_s[to] - t_s[from] < 0.5 * window_s) half = to;
      ++to;
    }
    if (to - from > 20) {
      const auto times = t_s.subspan(from, to - from);
      const auto points = tip_m.subspan(from, to - from);
      const Vec3 axis = principal_axis(points);
      for (const Vec3& way : {axis, Vec3(-axis)})
        for (TapRun& run : along(times, points, way, count))
          if (!is_known(out, run)) out.push_back(std::move(run));
    }
    from = half + 1;
  }
  return out;
}

}  // namespace capture
}  // namespace tractus
