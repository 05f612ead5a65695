#include "lab/discover/unknown_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "lab/identify/parallel.hpp"
#include "lab/settings.hpp"
#include "lab/signal/knots.hpp"

namespace tractus {
namespace lab {
namespace {

/// One signal over all trials.
struct SignalCourse {
  std::string name, unit;
  std::vector<std::vector<double>> trials;
};

std::vector<SignalCourse> courses_of(const FormulaScreen& screen) {
  std::vector<std::pair<const char*, const char*>> wanted{
      {"x_m", "m"}, {"v_m_s", "m/s"}, {"a_m_s2", "m/s^2"},        {"since_reversal(x_m)", "m"},
      {"t_s", "s"}, {"base_N", "N"},  {"since_stop(v_m_s)", "s"}, {"work(base_N, x_m)", "N*m"}};
  const bool turns = std::ranges::all_of(screen.signals(), [](const FormulaSignals& s) {
    return std::ranges::any_of(s.states[4], [](double w) { return std::abs(w) > 1e-3; });
  });
  if (turns) wanted.insert(wanted.end(), {{"omega_rad_s", "rad/s"}, {"theta_rad", "rad"}});
  std::vector<SignalCourse> out;
  for (const auto& [text, unit] : wanted) {
    out.push_back({text, unit, {}});
    for (const FormulaSignals& signals : screen.signals())
      out.back().trials.push_back(evaluated(text, {}, signals));
  }
  return out;
}

/// Quantiles of what was recorded, each once; either side of 0 for a signal that changes its sign,
/// so that a jump there can be told.
std::vector<double> knots_of(const SignalCourse& course, int count) {
  std::vector<double> all;
  for (const auto& trial : course.trials)
    for (std::size_t i = 0; i < trial.size(); i += 7)
      if (trial[i] != 0.0) all.push_back(trial[i]);
  if (all.size() < 10) return {};
  std::ranges::sort(all);
  std::vector<double> out;
  for (int k = 0; k < count; ++k) {
    const double share = 0.005 + 0.99 * k / (count - 1);
    const double v = all[std::size_t(share * double(all.size() - 1))];
    if (out.empty() || v > out.back()) out.push_back(v);
  }
  const double size = std::max(std::abs(out.front()), std::abs(out.back()));
  if (course.name == "v_m_s" && out.front() < 0.0 && out.back() > 0.0) {
    out.insert(out.end(), {-1e-3 * size, 1e-3 * size});
    std::ranges::sort(out);
  }
  std::vector<double> apart;
  for (const double v : out)
    if (apart.empty() || v - apart.back() > 1e-4 * size) apart.push_back(v);
  out = std::move(apart);
  return out.size() < 3 ? std::vector<double>() : out;
}

using SignalCourses = std::vector<const SignalCourse*>;

/// What 1 N at each knot alone does to the residual of a trial.
Eigen::MatrixXd hats(const FormulaScreen& screen, const SignalCourses& of, const UnknownFunction& f,
                     int trial) {
  const auto k = std::size_t(trial);
  const std::size_t samples = screen.signals()[k].steps.size(), n = f.force_N.size();
  std::vector<std::vector<double>> added(n, std::vector<double>(samples, 0.0));
  const std::size_t stride = of.size() == 2 ? f.knots[1].size() : 1;
  for (std::size_t i = 0; i < samples; ++i) {
    const auto [a, share] = place_between(f.knots[0], of[0]->trials[k][i]);
    if (of.size() == 1) {
      added[a][i] += 1.0 - share, added[a + 1][i] += share;
      continue;
    }
    const auto [b, other] = place_between(f.knots[1], of[1]->trials[k][i]);
    added[a * stride + b][i] += (1.0 - share) * (1.0 - other);
    added[a * stride + b + 1][i] += (1.0 - share) * other;
    added[(a + 1) * stride + b][i] += share * (1.0 - other);
    added[(a + 1) * stride + b + 1][i] += share * other;
  }
  Eigen::MatrixXd out;
  for (std::size_t j = 0; j < n; ++j) {
    const Eigen::VectorXd column = screen.response(added[j], trial);
    if (j == 0) out.resize(column.size(), Eigen::Index(n));
    out.col(Eigen::Index(j)) = column;
  }
  return out;
}

/// Neighbouring knots differ by about the function's size over half its length.
Eigen::MatrixXd smoothness(const UnknownFunction& f, double size_N) {
  const auto n = Eigen::Index(f.force_N.size());
  Eigen::MatrixXd out = 0.2 * Eigen::MatrixXd::Identity(n, n);
  const auto join = [&](std::size_t a, std::size_t b, std::size_t knots) {
    const auto i = Eigen::Index(a), j = Eigen::Index(b);
    const double weight = 0.25 * double(knots);
    out(i, i) += weight, out(j, j) += weight;
    out(i, j) -= weight, out(j, i) -= weight;
  };
  const std::size_t rows = f.knots[0].size(), columns = f.knots.size() == 2 ? f.knots[1].size() : 1;
  for (std::size_t a = 0; a < rows; ++a)
    for (std::size_t b = 0; b < columns; ++b) {
      if (a + 1 < rows) join(a * columns + b, (a + 1) * columns + b, rows);
      if (b + 1 < columns) join(a * columns + b, a * columns + b + 1, columns);
    }
  return out / (size_N * size_N);
}

}  // namespace

std::vector<UnknownFunction> unknown_functions(const Residual& residual, const Solution& at,
                                               const FormulaScreen& screen, double correlation) {
  const std::vector<SignalCourse> all = courses_of(screen);
  std::vector<SignalCourses> sets;
  const auto named = [&](std::string_view name) {
    const auto found = std::ranges::find(all, name, &SignalCourse::name);
    return found == all.end() ? nullptr : &*found;
  };
  for (const SignalCourse& one : all) sets.push_back({&one});
  for (const auto& [a, b] : {std::pair{"x_m", "v_m_s"},
                             {"v_m_s", "base_N"},
                             {"v_m_s", "since_reversal(x_m)"},
                             {"v_m_s", "since_stop(v_m_s)"},
                             {"base_N", "work(base_N, x_m)"},
                             {"v_m_s", "omega_rad_s"},
                             {"x_m", "since_reversal(x_m)"},
                             {"v_m_s", "a_m_s2"},
                             {"base_N", "omega_rad_s"},
                             {"v_m_s", "t_s"}})
    if (named(a) && named(b)) sets.push_back({named(a), named(b)});
  const auto left = screen.residuals_of(residual, at);
  double squares = 0.0, rows = 0.0, ones = 0.0;
  for (std::size_t t = 0; t < left.size(); ++t) {
    squares += left[t].squaredNorm(), rows += double(left[t].size());
    ones += screen.response(std::vector<double>(screen.signals()[t].steps.size(), 1.0), int(t))
                .squaredNorm();
  }
  const double size_N = std::sqrt(squares / std::max(ones, 1e-300));
  std::vector<UnknownFunction> out(sets.size());
  for (std::size_t s = 0; s < sets.size(); ++s) {
    UnknownFunction& f = out[s];
    std::size_t count = 1;
    for (const SignalCourse* one : sets[s]) {
      f.signals.push_back(one->name);
      f.units.push_back(one->unit);
      f.knots.push_back(
          knots_of(*one, sets[s].size() == 1 ? kDiscovery.knots_of_one : kDiscovery.knots_of_two));
      count *= f.knots.back().size();
    }
    if (count == 0) continue;
    f.force_N.assign(count, 0.0);
    std::vector<Eigen::MatrixXd> columns(left.size());
    parallel(residual.trials(), residual.threads(),
             [&](int k) { columns[std::size_t(k)] = hats(screen, sets[s], f, k); });
    f.evidence = screen.evidence_with(residual, at, correlation, columns, smoothness(f, size_N));
    const Eigen::VectorXd found = f.evidence.change.tail(Eigen::Index(count));
    f.force_N.assign(found.begin(), found.end());
  }
  std::erase_if(out, [](const UnknownFunction& f) { return f.force_N.empty(); });
  std::ranges::stable_sort(out, std::greater<>(),
                           [](const UnknownFunction& f) { return f.evidence.total; });
  return out;
}

}  // namespace lab
}  // namespace tractus
