#include "lab/identify/drift_on_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <span>

#include "lab/identify/effect_screen.hpp"
#include "lab/settings.hpp"
#include "lab/signal/drift.hpp"
#include "lab/signal/fading_memory.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kDrift = kSettings.drift_on_motion;
constexpr auto kSignals = Eigen::Index(kDrift.memories_s.size() + 2 + kDrift.play_shares.size());

/// How far a position has run ahead of a play that follows it, −1 … 1: the direction of the last motion.
std::vector<double> direction_of_last_motion(std::span<const double> x_m, double play_m) {
  std::vector<double> out;
  double follows_m = x_m.front();
  for (const double x : x_m) {
    follows_m = std::clamp(follows_m, x - 0.5 * play_m, x + 0.5 * play_m);
    out.push_back(play_m > 0.0 ? 2.0 * (x - follows_m) / play_m : 0.0);
  }
  return out;
}

/// What a slow law may follow: memories of the speed, the position and its square, and the direction of the last motion.
std::vector<std::vector<double>> signals_of(std::span<const double> t_s,
                                            std::span<const double> x_m,
                                            std::span<const double> v_m_s) {
  std::vector<std::vector<double>> out;
  for (const double time_s : kDrift.memories_s) out.push_back(fading_memory(t_s, v_m_s, time_s));
  out.emplace_back(x_m.begin(), x_m.end());
  out.push_back(out.back());
  for (double& square : out.back()) square *= square;
  const auto [least, most] = std::ranges::minmax(x_m);
  for (const double share : kDrift.play_shares)
    out.push_back(direction_of_last_motion(x_m, share * (most - least)));
  return out;
}

const std::vector<double>* state(const States& states, std::string_view name) {
  const auto found = std::ranges::find(states.names, name);
  return found == states.names.end() ? nullptr
                                     : &states.values[std::size_t(found - states.names.begin())];
}

/// One trial's trend, and the trends of those signals, at some moments.
struct Trends {
  Eigen::VectorXd fitted;
  Eigen::MatrixXd of_motion;  // [row][signal], the last column 1
};

Trends trends_of(const Problem& problem, const Solution& at, std::string_view effect,
                 std::span<const double> x_m, std::span<const double> v_m_s, int trial) {
  const Structure less = minus(at.structure, effect);
  const Residuals with = problem.full_rate(at.structure, at.values, trial),
                  without = problem.full_rate(less, at.values, trial);
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
  Trends out{thinned([&](std::size_t k) { return without.channels[0][k] - with.channels[0][k]; }),
             Eigen::MatrixXd::Ones(rows, kSignals + 1)};
  Eigen::Index column = 0;
  for (const auto& signal : signals_of(with.t_s, x_m, v_m_s)) {
    const Eigen::VectorXd raw = thinned([&](std::size_t k) { return signal[k]; });
    out.of_motion.col(column++) = trends.at(t_s, trends.fit(raw));
  }
  return out;
}

}  // namespace

double drift_r2_on_motion(const Residual& residual, const Solution& at, std::string_view effect) {
  const Problem& problem = residual.problem();
  if (!contains(at.structure, effect)) return 0.0;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(kSignals + 1, kSignals + 1);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(kSignals + 1);
  double squares = 0.0;
  for (int k = 0; k < problem.trials(); ++k) {
    const States states = problem.states(k);
    const auto *x_m = state(states, "depth_m"), *v_m_s = state(states, "velocity_m_s");
    if (x_m == nullptr || v_m_s == nullptr) return 0.0;
    const Trends trends = trends_of(problem, at, effect, *x_m, *v_m_s, k);
    a += trends.of_motion.transpose() * trends.of_motion;
    b += trends.of_motion.transpose() * trends.fitted;
    squares += trends.fitted.squaredNorm();
  }
  const double about_mean = squares - b(kSignals) * b(kSignals) / a(kSignals, kSignals);
  const double left = squares - b.dot(solve(a, b));
  const double numbers = double(Drift::kOrders) * problem.trials() - 1.0;
  if (about_mean <= 0.0 || numbers <= double(kSignals)) return 0.0;
  return std::clamp(1.0 - left / about_mean * numbers / (numbers - double(kSignals)), 0.0, 1.0);
}

}  // namespace lab
}  // namespace tractus
