#include "lab/identify/least_squares.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "lab/identify/parallel.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kSolver = kSettings.least_squares;

double step_inside(const Parameter& p, double u) {
  return u + p.step <= coordinate(p, p.high) ? p.step : -p.step;
}

std::vector<double> moved(const Solution& at, std::size_t column, double by) {
  std::vector<double> values = at.values;
  const Parameter& p = at.parameters[column];
  values[column] = value_at(p, coordinate(p, values[column]) + by);
  return values;
}

void differentiate(const Residual& residual, Solution& at,
                   const std::vector<std::size_t>& columns) {
  std::vector<std::vector<double>> points;
  std::vector<double> steps;
  for (const std::size_t c : columns) {
    const Parameter& p = at.parameters[c];
    steps.push_back(step_inside(p, coordinate(p, at.values[c])));
    points.push_back(moved(at, c, steps.back()));
  }
  const Eigen::MatrixXd there = residual.near(at.structure, at.values, points);
  at.jacobian.resize(residual.size(), Eigen::Index(at.parameters.size()));
  for (std::size_t k = 0; k < columns.size(); ++k)
    at.jacobian.col(Eigen::Index(columns[k])) =
        (there.col(Eigen::Index(k)) - at.residual) / steps[k];
}

double prior_of(const std::vector<Parameter>& parameters, std::span<const double> values) {
  double sum = 0.0;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const Parameter& p = parameters[k];
    if (!std::isfinite(p.prior_sd)) continue;
    const double off = (coordinate(p, values[k]) - coordinate(p, p.start)) / p.prior_sd;
    sum += off * off;
  }
  return sum;
}

void judge(Solution& at, double scale) {
  at.scale = scale;
  at.prior = prior_of(at.parameters, at.values);
  at.judged = double((at.residual.array() != 0.0).count());
  at.loss = robust_loss(at.residual, scale) + at.prior;
}

/// One search's state between its steps.
class Search {
 public:
  Search(const Residual& residual, Solution start, const SearchOptions& options)
      : residual_(residual), options_(options), at_(std::move(start)) {
    options_.fresh_jacobian = options_.fresh_jacobian || residual.problem().differs_cheaply();
  }

  Solution run(const std::vector<std::size_t>& to_differentiate, bool stale) {
    differentiate(residual_, at_, to_differentiate);
    for (std::size_t k = 0; k < at_.parameters.size(); ++k)
      if (!at_.parameters[k].pointer.starts_with('/')) every_.push_back(k);
    stale_ = stale;
    double damping = 1e-6;
    for (int k = 0; k < options_.max_iterations; ++k) {
      judge(at_, robust_scale(at_.residual));
      const Gram equations = all();
      Solution next;
      double promised = 0.0;
      int tries = 0;
      bool better = false;
      for (; tries < kSolver.most_tries && !better; ++tries) {
        next = stepped(equations, damping, promised);
        if (!(promised > 0.0)) {  // the step was cut at a bound and leads nowhere: a shorter one
          damping = std::max(damping * 10.0, 1e-4);
          continue;
        }
        if (promised < 0.1 * options_.tolerance * at_.loss) break;
        judge(next, at_.scale);
        better = next.loss < at_.loss;
        if (!better) {
          if (stale_) break;
          damping = std::max(damping * 10.0, 1e-4);
        }
      }
      if (!better) {
        if (stale_) {
          refresh();
          continue;
        }
        at_.converged = true;
        break;
      }
      const double gained = at_.loss - next.loss;
      const bool poor = gained < 0.3 * promised;
      next.jacobian = std::move(at_.jacobian);
      if (!options_.fresh_jacobian) secant(next);
      const double before = at_.loss;
      at_ = std::move(next);
      if (tries == 1) damping = std::max(damping * 0.2, 1e-9);
      if (gained < options_.tolerance * before) {
        at_.converged = true;
        break;
      }
      if (poor || options_.fresh_jacobian) {
        refresh();
      } else {
        differentiate(residual_, at_, every_);
        stale_ = every_.size() < at_.parameters.size();
      }
    }
    judge(at_, robust_scale(at_.residual));
    return std::move(at_);
  }

 private:
  void refresh() {
    lab::differentiate(residual_, at_);
    stale_ = false;
  }

  /// J ← J + (Δr − J Δu) Δuᵀ / ΔuᵀΔu [Broyden1965]: the jacobian that would have predicted the last
  /// step, with u in units of the parameters' steps.
  void secant(Solution& next) const {
    Eigen::VectorXd step(Eigen::Index(at_.values.size()));
    for (Eigen::Index k = 0; k < step.size(); ++k) {
      const auto i = std::size_t(k);
      step(k) = (coordinate(at_.parameters[i], next.values[i]) -
                 coordinate(at_.parameters[i], at_.values[i])) /
                at_.parameters[i].step;  // in comparable units
    }
    const double length = step.squaredNorm();
    if (!(length > 0.0)) return;
    Eigen::VectorXd scaled = step;
    for (Eigen::Index k = 0; k < step.size(); ++k) scaled(k) *= at_.parameters[std::size_t(k)].step;
    const Eigen::VectorXd missed = next.residual - at_.residual - next.jacobian * scaled;
    for (Eigen::Index k = 0; k < step.size(); ++k)
      next.jacobian.col(k) += missed * (step(k) / length / at_.parameters[std::size_t(k)].step);
  }

  Gram all() const {
    Gram g = gram(at_, robust_weights(at_.residual, at_.scale), 0, at_.residual.size());
    add_prior(at_, g);
    return g;
  }

  /// The step that solves (A + λ diag A) Δu = −b, A = JᵀWJ, b = JᵀWr [Marquardt1963], cut at the
  /// bounds; parameters at a bound that the step would push out stay. `promised` is the decrease of
  /// the loss by its quadratic model.
  Solution stepped(const Gram& g, double damping, double& promised) const {
    const Eigen::Index n = g.b.size();
    std::vector<bool> held(std::size_t(n), false);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
    for (int round = 0; round < 4; ++round) {
      Eigen::MatrixXd a = g.a;
      Eigen::VectorXd b = g.b;
      for (Eigen::Index k = 0; k < n; ++k) {
        const double d = a(k, k);
        a(k, k) += damping * d;
        if (!held[std::size_t(k)]) continue;
        a.row(k).setZero();
        a.col(k).setZero();
        b(k) = 0.0;
      }
      step = -solve(a, b);
      bool more = false;
      for (Eigen::Index k = 0; k < n; ++k) {
        const Parameter& p = at_.parameters[std::size_t(k)];
        const double u = coordinate(p, at_.values[std::size_t(k)]);
        const double low = coordinate(p, p.low), high = coordinate(p, p.high);
        const double near = 1e-9 * (high - low);
        if (!held[std::size_t(k)] &&
            ((u <= low + near && step(k) < 0.0) || (u >= high - near && step(k) > 0.0)))
          held[std::size_t(k)] = more = true;
        else
          step(k) = std::clamp(step(k), low - u, high - u);
      }
      if (!more) break;
    }
    for (Eigen::Index k = 0; k < n; ++k)
      if (held[std::size_t(k)]) step(k) = 0.0;
    promised = -(2.0 * g.b.dot(step) + step.dot(g.a * step));
    Solution next;
    next.structure = at_.structure;
    next.parameters = at_.parameters;
    next.values = at_.values;
    for (Eigen::Index k = 0; k < n; ++k) {
      const Parameter& p = at_.parameters[std::size_t(k)];
      double& v = next.values[std::size_t(k)];
      v = std::clamp(value_at(p, coordinate(p, v) + step(k)), p.low, p.high);
    }
    if (promised > 0.0) next.residual = residual_(next.structure, next.values);
    return next;
  }

  const Residual& residual_;
  SearchOptions options_;
  Solution at_;
  std::vector<std::size_t> every_;  // columns that are differentiated at every point
  bool stale_ = false;              // some columns are of another point
};

}  // namespace

Residual::Residual(const Problem& problem, int threads)
    : problem_(problem), threads_(std::max(1, threads)), offsets_{0} {
  for (int k = 0; k < problem.trials(); ++k)
    offsets_.push_back(offsets_.back() + problem.residual_size(k));
}

Eigen::VectorXd Residual::operator()(const Structure& structure,
                                     std::span<const double> values) const {
  Eigen::VectorXd out(size());
  parallel(trials(), threads_, [&](int k) {
    problem_.residuals(structure, values, k, out.segment(offset(k), offset(k + 1) - offset(k)));
  });
  return out;
}

Eigen::MatrixXd Residual::operator()(const Structure& structure,
                                     const std::vector<std::vector<double>>& points) const {
  Eigen::MatrixXd out(size(), Eigen::Index(points.size()));
  parallel(trials() * int(points.size()), threads_, [&](int item) {
    const int k = item % trials();
    const auto column = std::size_t(item / trials());
    problem_.residuals(structure, points[column], k,
                       out.col(Eigen::Index(column)).segment(offset(k), offset(k + 1) - offset(k)));
  });
  return out;
}

Eigen::MatrixXd Residual::near(const Structure& structure, std::span<const double> values,
                               const std::vector<std::vector<double>>& points) const {
  if (!problem_.differs_cheaply()) return (*this)(structure, points);
  Eigen::MatrixXd out(size(), Eigen::Index(points.size()));
  parallel(trials(), threads_, [&](int k) {
    problem_.residuals_near(structure, values, points, k,
                            out.middleRows(offset(k), offset(k + 1) - offset(k)));
  });
  return out;
}

double coordinate(const Parameter& p, double value) {
  return p.logarithmic ? std::log(value) : value;
}
double value_at(const Parameter& p, double coordinate) {
  return p.logarithmic ? std::exp(coordinate) : coordinate;
}

double robust_scale(const Eigen::VectorXd& residual) {
  if (residual.size() == 0) return 1.0;
  std::vector<double> all(residual.data(), residual.data() + residual.size());
  for (double& v : all) v = std::abs(v);
  const auto at = all.begin() + std::ptrdiff_t(kSolver.scale_quantile * double(all.size() - 1));
  std::ranges::nth_element(all, at);
  return std::max(1.0, *at / kSolver.scale_of_normal);
}

Eigen::VectorXd robust_weights(const Eigen::VectorXd& residual, double scale) {
  const double most = kSolver.huber * scale;
  return residual.unaryExpr(
      [most](double r) { return std::abs(r) <= most ? 1.0 : most / std::abs(r); });
}

double robust_loss(const Eigen::Ref<const Eigen::VectorXd>& residual, double scale) {
  const double most = kSolver.huber * scale;
  double sum = 0.0;
  for (Eigen::Index k = 0; k < residual.size(); ++k) {
    const double r = std::abs(residual(k));
    sum += r <= most ? r * r : most * (2.0 * r - most);
  }
  return sum;
}

Gram gram(const Solution& at, const Eigen::VectorXd& weights, Eigen::Index from,
          Eigen::Index count) {
  const auto j = at.jacobian.middleRows(from, count);
  const Eigen::MatrixXd wj = weights.segment(from, count).asDiagonal() * j;
  return {wj.transpose() * j, wj.transpose() * at.residual.segment(from, count)};
}

void add_prior(const Solution& at, Gram& g) {
  for (std::size_t k = 0; k < at.parameters.size(); ++k) {
    const Parameter& p = at.parameters[k];
    if (!std::isfinite(p.prior_sd)) continue;
    const double weight = 1.0 / (p.prior_sd * p.prior_sd);
    g.a(Eigen::Index(k), Eigen::Index(k)) += weight;
    g.b(Eigen::Index(k)) += weight * (coordinate(p, at.values[k]) - coordinate(p, p.start));
  }
}

Eigen::VectorXd solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  if (b.size() == 0) return b;
  Eigen::VectorXd unit = a.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (double& v : unit) v = v > 0.0 ? 1.0 / v : 0.0;
  const Eigen::MatrixXd scaled = unit.asDiagonal() * a * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const double least = kSolver.rank * std::max(eigen.eigenvalues().maxCoeff(), 1e-300);
  Eigen::VectorXd along = eigen.eigenvectors().transpose() * (unit.asDiagonal() * b);
  for (Eigen::Index k = 0; k < along.size(); ++k)
    along(k) = eigen.eigenvalues()(k) > least ? along(k) / eigen.eigenvalues()(k) : 0.0;
  return unit.asDiagonal() * (eigen.eigenvectors() * along);
}

void differentiate(const Residual& residual, Solution& solution) {
  std::vector<std::size_t> all(solution.parameters.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  differentiate(residual, solution, all);
}

namespace {

/// A place that the data do not tell from the given one is the given one: where a probe only passes it, the loss is flat over
/// some micrometres about a border, and yet a probe that rests there would be on its wrong side.
Solution at_given_places(const Residual& residual, Solution at) {
  for (std::size_t c = 0; c < at.parameters.size(); ++c) {
    const Parameter& p = at.parameters[c];
    if (!(p.rough > 0.0) || at.values[c] == p.start) continue;
    Solution given = at;
    given.values[c] = p.start;
    given.residual = residual(at.structure, given.values);
    judge(given, at.scale);
    if (given.loss <= at.loss + kSolver.given_place) at = std::move(given);
  }
  return at;
}

}  // namespace

Solution polish(const Residual& residual, Solution at, const SearchOptions& options) {
  bool any = false;
  for (int round = 0; round < kSolver.rough_rounds; ++round) {
    std::vector<double> values = at.values;
    double least = at.loss;
    bool moved_any = false;
    for (std::size_t c = 0; c < at.parameters.size(); ++c) {
      const Parameter& p = at.parameters[c];
      for (double step = p.rough; p.rough > 0.0 && step > kSolver.finest_rough * p.rough;
           step *= 0.5) {
        std::vector<std::vector<double>> points(2, values);
        points[0][c] = std::clamp(values[c] - step, p.low, p.high);
        points[1][c] = std::clamp(values[c] + step, p.low, p.high);
        const Eigen::MatrixXd there = residual(at.structure, points);
        for (int side = 0; side < 2; ++side) {
          const auto& point = points[std::size_t(side)];
          const double loss =
              robust_loss(there.col(side), at.scale) + prior_of(at.parameters, point);
          if (loss < least) least = loss, values = point, moved_any = any = true;
        }
      }
    }
    if (!moved_any) break;
    at = search(residual, at.structure, values, &at, options);
  }
  if (any) differentiate(residual, at);
  return at;
}

Solution search(const Residual& residual, const Structure& structure, std::vector<double> start,
                const Solution* warm, const SearchOptions& options) {
  Solution at;
  at.structure = structure;
  at.parameters = residual.problem().parameters(structure);
  at.values = std::move(start);
  for (std::size_t k = 0; k < at.values.size(); ++k)
    at.values[k] = std::clamp(at.values[k], at.parameters[k].low, at.parameters[k].high);
  at.residual = residual(structure, at.values);
  at.jacobian.resize(residual.size(), Eigen::Index(at.values.size()));
  std::map<std::string, Eigen::Index> known;
  if (warm && warm->jacobian.rows() == residual.size())
    for (std::size_t k = 0; k < warm->parameters.size(); ++k)
      known[warm->parameters[k].pointer] = Eigen::Index(k);
  std::vector<std::size_t> fresh;
  for (std::size_t k = 0; k < at.parameters.size(); ++k) {
    const auto found = known.find(at.parameters[k].pointer);
    if (found == known.end() || !at.parameters[k].pointer.starts_with('/') ||
        residual.problem().differs_cheaply())
      fresh.push_back(k);
    else
      at.jacobian.col(Eigen::Index(k)) = warm->jacobian.col(found->second);
  }
  if (at.parameters.empty()) {  // nothing to move
    judge(at, robust_scale(at.residual));
    at.converged = true;
    return at;
  }
  const bool stale = fresh.size() < at.parameters.size();
  return at_given_places(residual, Search(residual, std::move(at), options).run(fresh, stale));
}

}  // namespace lab
}  // namespace tractus
