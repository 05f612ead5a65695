#include "lab/identify/drift_on_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "lab/identify/effect_screen.hpp"
#include "lab/settings.hpp"
#include "lab/signal/drift.hpp"
#include "lab/signal/fading_memory.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kDrift = kSettings.drift_on_motion;

/// One trial's trend, and the memories of its speed as slow as a trend may be.
struct Slow {
  Eigen::VectorXd trend;
  Eigen::MatrixXd memories;  // [row][memory], the last column 1
};

Slow slow_of(const Problem& problem, const Solution& at, std::string_view effect,
             const std::vector<double>& v_m_s, int trial) {
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
  Slow out{thinned([&](std::size_t k) { return without.channels[0][k] - with.channels[0][k]; }),
           Eigen::MatrixXd::Ones(rows, Eigen::Index(kDrift.memories_s.size()) + 1)};
  for (std::size_t m = 0; m < kDrift.memories_s.size(); ++m) {
    const auto left = fading_memory(with.t_s, v_m_s, kDrift.memories_s[m]);
    const Eigen::VectorXd raw = thinned([&](std::size_t k) { return left[k]; });
    out.memories.col(Eigen::Index(m)) = trends.at(t_s, trends.fit(raw));
  }
  return out;
}

}  // namespace

double drift_r2_on_motion(const Residual& residual, const Solution& at, std::string_view effect) {
  const Problem& problem = residual.problem();
  if (!contains(at.structure, effect)) return 0.0;
  constexpr auto kColumns = Eigen::Index(kDrift.memories_s.size()) + 1;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(kColumns, kColumns);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(kColumns);
  double squares = 0.0;
  for (int k = 0; k < problem.trials(); ++k) {
    const States states = problem.states(k);
    const auto speed = std::ranges::find(states.names, "velocity_m_s");
    if (speed == states.names.end()) return 0.0;
    const Slow slow =
        slow_of(problem, at, effect, states.values[std::size_t(speed - states.names.begin())], k);
    a += slow.memories.transpose() * slow.memories;
    b += slow.memories.transpose() * slow.trend;
    squares += slow.trend.squaredNorm();
  }
  const double mean = b(kColumns - 1) / a(kColumns - 1, kColumns - 1);
  const double about_mean = squares - mean * b(kColumns - 1);
  const double left = squares - b.dot(solve(a, b));
  return about_mean > 0.0 ? std::clamp(1.0 - left / about_mean, 0.0, 1.0) : 0.0;
}

}  // namespace lab
}  // namespace tractus
