#include "lab/identify/drift_on_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
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

/// What a slow law along the way may follow: memories of the speed, the position and its square, and the direction of the
/// last motion.
std::vector<std::vector<double>> signals_of_way(std::span<const double> t_s,
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

/// What a slow law may follow in one of the drift's components. Of a force in space, memories of the contact force's own
/// component, as of bone that creeps. Empty where these are not among the states.
std::vector<std::vector<double>> signals_of(const States& states, std::span<const double> t_s,
                                            std::size_t components, std::size_t component) {
  if (components == 1) {
    const auto *x_m = state(states, "depth_m"), *v_m_s = state(states, "velocity_m_s");
    if (x_m == nullptr || v_m_s == nullptr) return {};
    return signals_of_way(t_s, *x_m, *v_m_s);
  }
  constexpr std::array<std::string_view, 3> kForces{"force_x_N", "force_y_N", "force_z_N"};
  const auto* force_N = state(states, kForces.at(component));
  std::vector<std::vector<double>> out;
  for (const double time_s : kDrift.memories_s)
    if (force_N != nullptr) out.push_back(fading_memory(t_s, *force_N, time_s));
  return out;
}

/// One trial's trend in one component, and the trends of those signals, at some moments.
struct Trends {
  Eigen::VectorXd fitted;
  Eigen::MatrixXd of_motion;  // [row][signal]
};

Trends trends_of(const Residuals& with, const Residuals& without, std::size_t channel,
                 const std::vector<std::vector<double>>& signals) {
  const std::size_t stride = 1 + with.t_s.size() / kDrift.rows_per_trial;
  std::vector<double> t_s;
  for (std::size_t k = 0; k < with.t_s.size(); k += stride) t_s.push_back(with.t_s[k]);
  const std::vector<double> even(t_s.size(), 1.0);
  const Drift trends(t_s, even);
  const auto thinned = [&](const auto& value) {
    Eigen::VectorXd out(Eigen::Index(t_s.size()));
    for (std::size_t r = 0; r < t_s.size(); ++r) out(Eigen::Index(r)) = value(r * stride);
    return out;
  };
  Trends out{thinned([&](std::size_t k) {
               return without.channels[channel][k] - with.channels[channel][k];
             }),
             Eigen::MatrixXd(Eigen::Index(t_s.size()), Eigen::Index(signals.size()))};
  for (std::size_t s = 0; s < signals.size(); ++s)
    out.of_motion.col(Eigen::Index(s)) =
        trends.at(t_s, trends.fit(thinned([&](std::size_t k) { return signals[s][k]; })));
  return out;
}

/// Normal equations of the fitted trends on those of the signals, and a constant for each component.
struct Equations {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
  double squares = 0.0;
  Eigen::Index signals = 0;

  void add(const Trends& trends, std::size_t component, std::size_t components) {
    signals = trends.of_motion.cols();
    Eigen::MatrixXd rows =
        Eigen::MatrixXd::Zero(trends.fitted.size(), signals + Eigen::Index(components));
    rows.leftCols(signals) = trends.of_motion;
    rows.col(signals + Eigen::Index(component)).setOnes();
    if (a.size() == 0) {
      a = Eigen::MatrixXd::Zero(rows.cols(), rows.cols());
      b = Eigen::VectorXd::Zero(rows.cols());
    }
    a += rows.transpose() * rows;
    b += rows.transpose() * trends.fitted;
    squares += trends.fitted.squaredNorm();
  }
  double about_means() const {
    double out = squares;
    for (Eigen::Index c = signals; c < b.size(); ++c) out -= b(c) * b(c) / a(c, c);
    return out;
  }
};

}  // namespace

double drift_r2_on_motion(const Residual& residual, const Solution& at, std::string_view effect) {
  const Problem& problem = residual.problem();
  if (!contains(at.structure, effect)) return 0.0;
  const std::size_t of_norm = problem.channels().front().components,
                    components = std::max<std::size_t>(1, of_norm);
  Equations equations;
  for (int k = 0; k < problem.trials(); ++k) {
    const States states = problem.states(k);
    const Residuals with = problem.full_rate(at.structure, at.values, k),
                    without = problem.full_rate(minus(at.structure, effect), at.values, k);
    for (std::size_t c = 0; c < components; ++c) {
      const auto signals = signals_of(states, with.t_s, components, c);
      if (signals.empty()) return 0.0;
      equations.add(trends_of(with, without, of_norm > 0 ? c + 1 : c, signals), c, components);
    }
  }
  const double about_means = equations.about_means();
  const double left = equations.squares - equations.b.dot(solve(equations.a, equations.b));
  const double numbers = double(Drift::kOrders * problem.trials() - 1) * double(components),
               signals = double(equations.signals);
  if (about_means <= 0.0 || numbers <= signals) return 0.0;
  return std::clamp(1.0 - left / about_means * numbers / (numbers - signals), 0.0, 1.0);
}

}  // namespace lab
}  // namespace tractus
