#include "lab/identify/residual_dependence.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kDependence = kSettings.dependence;

/// One state of all trials, thinned, with the error at the same moments.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<std::vector<double>>> states;  // [state][trial][row]
  std::vector<std::vector<double>> errors;               // [trial][row]
};

Columns columns(const Problem& problem, const Solution& at) {
  Columns out;
  for (int k = 0; k < problem.trials(); ++k) {
    const Residuals r = problem.full_rate(at.structure, at.values, k);
    const States states = problem.states(k);
    if (out.names.empty()) out.names = states.names, out.states.resize(states.names.size());
    out.errors.emplace_back();
    for (auto& state : out.states) state.emplace_back();
    const std::size_t stride = 1 + r.t_s.size() / kDependence.rows_per_trial;
    for (std::size_t i = 0; i < r.t_s.size(); i += stride) {
      if (r.judgement[i] != Judgement::judged) continue;
      out.errors.back().push_back(r.channels[0][i]);
      for (std::size_t s = 0; s < out.states.size() && s < states.values.size(); ++s)
        out.states[s].back().push_back(states.values[s][i]);
    }
  }
  return out;
}

std::vector<double> quantiles(const std::vector<std::vector<double>>& trials) {
  std::vector<double> all;
  for (const auto& t : trials) all.insert(all.end(), t.begin(), t.end());
  std::ranges::sort(all);
  std::vector<double> out;
  if (all.empty()) return out;
  for (int k = 0; k < kDependence.knots; ++k) {
    const double v = all[std::size_t(double(all.size() - 1) * k / (kDependence.knots - 1))];
    if (out.empty() || v > out.back()) out.push_back(v);
  }
  return out;
}

/// Where a value lies between the knots: the first of the two, and the weight of the second.
std::pair<Eigen::Index, double> between(const std::vector<double>& knots, double v) {
  const auto above = std::ranges::upper_bound(knots, v) - knots.begin();
  const auto at = std::clamp<std::ptrdiff_t>(above - 1, 0, std::ptrdiff_t(knots.size()) - 2);
  const double low = knots[std::size_t(at)], high = knots[std::size_t(at) + 1];
  return {at, std::clamp((v - low) / (high - low), 0.0, 1.0)};
}

/// Share of the errors' squares that a function of one state predicts on held-out halves.
double predicted_share(const std::vector<std::vector<double>>& state,
                       const std::vector<std::vector<double>>& errors) {
  const auto knots = quantiles(state);
  if (knots.size() < 3) return 0.0;
  const auto n = Eigen::Index(knots.size());
  const auto half_of = [&](std::size_t trial, std::size_t row) {
    return errors.size() > 1 ? trial % 2
                             : (row * 8 / std::max<std::size_t>(1, errors[0].size())) % 2;
  };
  double left = 0.0, all = 0.0;
  for (std::size_t half = 0; half < 2; ++half) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n) * kDependence.ridge;
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    for (std::size_t t = 0; t < errors.size(); ++t)
      for (std::size_t i = 0; i < errors[t].size(); ++i) {
        if (half_of(t, i) == half) continue;
        const auto [at, w] = between(knots, state[t][i]);
        a(at, at) += (1 - w) * (1 - w), a(at + 1, at + 1) += w * w;
        a(at, at + 1) += w * (1 - w), a(at + 1, at) += w * (1 - w);
        b(at) += (1 - w) * errors[t][i], b(at + 1) += w * errors[t][i];
      }
    const Eigen::VectorXd f = a.ldlt().solve(b);
    for (std::size_t t = 0; t < errors.size(); ++t)
      for (std::size_t i = 0; i < errors[t].size(); ++i) {
        if (half_of(t, i) != half) continue;
        const auto [at, w] = between(knots, state[t][i]);
        const double rest = errors[t][i] - (1 - w) * f(at) - w * f(at + 1);
        left += rest * rest, all += errors[t][i] * errors[t][i];
      }
  }
  return all > 0.0 ? std::max(0.0, 1.0 - left / all) : 0.0;
}

/// "velocity_m_s" → "velocity".
std::string readable(std::string name) {
  for (const char* unit : {"_rad_s", "_m_s2", "_m_s", "_rad", "_Nm", "_N", "_m", "_s"})
    if (name.ends_with(unit)) {
      name.resize(name.size() - std::string_view(unit).size());
      break;
    }
  std::ranges::replace(name, '_', ' ');
  return name;
}

}  // namespace

ResidualDependence residual_dependence(const Residual& residual, const Solution& solution) {
  const Columns all = columns(residual.problem(), solution);
  std::vector<std::pair<double, std::string>> shares;
  for (std::size_t s = 0; s < all.names.size(); ++s)
    shares.emplace_back(predicted_share(all.states[s], all.errors), readable(all.names[s]));
  std::ranges::stable_sort(shares, std::greater<>(), &std::pair<double, std::string>::first);
  ResidualDependence out;
  if (shares.size() > kDependence.named) shares.resize(kDependence.named);
  for (const auto& [share, name] : shares) {
    if (share < kDependence.worth_naming) break;
    out.explained = std::max(out.explained, share);
    out.words += fmt::format("{}{} ({:.0f} %)", out.words.empty() ? "" : ", ", name, 100.0 * share);
  }
  if (out.words.empty())
    out.words =
        "no recorded signal by itself predicts it: an influence that was not measured, or a "
        "combination";
  return out;
}

}  // namespace lab
}  // namespace tractus
