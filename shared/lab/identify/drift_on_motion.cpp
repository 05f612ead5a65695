#include "lab/identify/drift_on_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lab/identify/effect_screen.hpp"
#include "lab/settings.hpp"
#include "lab/signal/drift.hpp"
#include "lab/signal/fading_memory.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kDrift = kSettings.drift_on_motion;

/// A signal whose memory may be what a trend of a channel is.
struct Driver {
  std::string_view signal;
  std::size_t channel;  // of the residuals
};

/// Of a probing the speed, of a palpation each component of the force by bone.
std::vector<Driver> drivers(const Problem& problem) {
  if (problem.channels().front().components == 0) return {{"velocity_m_s", 0}};
  return {{"force_x_N", 1}, {"force_y_N", 2}, {"force_z_N", 3}};
}

/// One trial's trend in one channel, and what the signal makes as slow as a trend may be.
struct Slow {
  Eigen::VectorXd trend;
  Eigen::VectorXd now;       // the signal itself
  Eigen::MatrixXd memories;  // [row][memory], the last column 1
};

Slow slow_of(const Residuals& with, const Residuals& without, const std::vector<double>& signal,
             std::size_t channel) {
  const std::size_t stride = 1 + with.t_s.size() / kDrift.rows_per_trial;
  std::vector<double> t_s;
  for (std::size_t k = 0; k < with.t_s.size(); k += stride) t_s.push_back(with.t_s[k]);
  const auto rows = Eigen::Index(t_s.size());
  const std::vector<double> even(t_s.size(), 1.0);
  const Drift trends(t_s, even);
  const auto thinned = [&](const auto& value) {
    Eigen::VectorXd out(rows);
    for (Eigen::Index r = 0; r < rows; ++r) out(r) = value(std::size_t(r) * stride);
    return out;
  };
  const auto slow = [&](const std::vector<double>& values) {
    return Eigen::VectorXd(
        trends.at(t_s, trends.fit(thinned([&](std::size_t k) { return values[k]; }))));
  };
  Slow out{thinned([&](std::size_t k) {
             return without.channels[channel][k] - with.channels[channel][k];
           }),
           slow(signal), Eigen::MatrixXd::Ones(rows, Eigen::Index(kDrift.memories_s.size()) + 1)};
  for (std::size_t m = 0; m < kDrift.memories_s.size(); ++m)
    out.memories.col(Eigen::Index(m)) = slow(fading_memory(with.t_s, signal, kDrift.memories_s[m]));
  return out;
}

/// One trial's trends in all channels that a signal drives, one under another.
std::vector<Slow> slow_of(const Problem& problem, const Solution& at, std::string_view effect,
                          int trial) {
  const States states = problem.states(trial);
  const Residuals with = problem.full_rate(at.structure, at.values, trial),
                  without = problem.full_rate(minus(at.structure, effect), at.values, trial);
  std::vector<Slow> out;
  for (const Driver& driver : drivers(problem)) {
    const auto signal = std::ranges::find(states.names, driver.signal);
    if (signal != states.names.end())
      out.push_back(slow_of(with, without,
                            states.values[std::size_t(signal - states.names.begin())],
                            driver.channel));
  }
  return out;
}

/// Sums of squares and products over trials.
struct Products {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
  double squares = 0.0;

  explicit Products(Eigen::Index columns)
      : a(Eigen::MatrixXd::Zero(columns, columns)), b(Eigen::VectorXd::Zero(columns)) {}
  void add(const Eigen::MatrixXd& x, const Eigen::VectorXd& y) {
    a += x.transpose() * x;
    b += x.transpose() * y;
    squares += y.squaredNorm();
  }
  double left() const { return squares - b.dot(solve(a, b)); }
};

constexpr auto kColumns = Eigen::Index(kDrift.memories_s.size()) + 1;

Products products_of(const std::vector<Slow>& channels) {
  Products out(kColumns);
  for (const Slow& slow : channels) out.add(slow.memories, slow.trend);
  return out;
}

/// Squares of a trial's trends that are left by memories which were fitted to the other trials.
double left_by_others(const Products& all, const Products& trial) {
  const Eigen::VectorXd c = solve(all.a - trial.a, all.b - trial.b);
  return trial.squares - 2.0 * c.dot(trial.b) + c.dot(trial.a * c);
}

/// Squares of a trial's trends that are left by a factor times the signal, fitted to the other channels of the trial.
double left_by_factor(const std::vector<Slow>& channels) {
  double left = 0.0;
  for (const Slow& judged : channels) {
    double square = 0.0, product = 0.0;
    for (const Slow& other : channels) {
      if (&other == &judged) continue;
      square += other.now.squaredNorm();
      product += other.now.dot(other.trend);
    }
    const double factor = square > 0.0 ? product / square : 0.0;
    left += (judged.trend - factor * judged.now).squaredNorm();
  }
  return left;
}

}  // namespace

double drift_r2_on_motion(const Residual& residual, const Solution& at, std::string_view effect) {
  const Problem& problem = residual.problem();
  if (!contains(at.structure, effect)) return 0.0;
  std::vector<Products> trials;
  Products all(kColumns), mean(1);
  double by_factor = 0.0;
  for (int k = 0; k < problem.trials(); ++k) {
    const std::vector<Slow> channels = slow_of(problem, at, effect, k);
    if (channels.empty()) return 0.0;
    for (const Slow& slow : channels) mean.add(slow.memories.rightCols(1), slow.trend);
    by_factor += left_by_factor(channels);
    trials.push_back(products_of(channels));
    all.a += trials.back().a;
    all.b += trials.back().b;
    all.squares += trials.back().squares;
  }
  double left = all.left();
  if (problem.channels().front().components >
      0) {  // left out, as a drift has few numbers to tell chance by
    left = 0.0;
    for (const Products& trial : trials) left += left_by_others(all, trial);
    left = std::min(left, by_factor);
  }
  const double trends = mean.left();
  return trends > 0.0 ? std::clamp(1.0 - left / trends, 0.0, 1.0) : 0.0;
}

}  // namespace lab
}  // namespace tractus
