#include "lab/identify/fit.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "lab/identify/effect_screen.hpp"
#include "lab/identify/fit_report.hpp"
#include "lab/identify/parallel.hpp"
#include "lab/settings.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr const auto& kValidation = kSettings.validation;

/// Which residuals a fold holds out.
struct Fold {
  int trial;
  double from_s, to_s;  // of the trial's time at the full rate
  Eigen::Index first, count;
};

std::vector<Fold> folds_of(const Residual& residual) {
  const Problem& problem = residual.problem();
  std::vector<Fold> out;
  const int pieces = residual.trials() >= kValidation.fewest_trials
                         ? 1
                         : kValidation.stretches / residual.trials();
  for (int k = 0; k < residual.trials(); ++k) {
    const Eigen::Index first = residual.offset(k), all = residual.offset(k + 1) - first;
    for (int p = 0; p < pieces; ++p) {
      const Eigen::Index from = all * p / pieces, to = all * (p + 1) / pieces;
      const double length = problem.seconds(k);
      out.push_back({k, length * p / pieces, length * (p + 1) / pieces, first + from, to - from});
    }
  }
  return out;
}

/// How far the coordinates of some numbers move when a fold is left out: one step of Newton's from the whole's, in the
/// directions that the rest informs too. (A number that one trial alone informs, as a layer that only it entered, cannot
/// be predicted from the others; it stays.)
Eigen::VectorXd step_without(const Gram& whole, const Gram& fold,
                             const std::vector<Eigen::Index>& moved) {
  const Eigen::MatrixXd all = whole.a(moved, moved), part = fold.a(moved, moved);
  const Eigen::VectorXd unit = all.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd a = unit.asDiagonal() * all * unit.asDiagonal();
  a.diagonal().array() += 1e-12;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      unit.asDiagonal() * part * unit.asDiagonal(), a);
  Eigen::VectorXd along = eigen.eigenvectors().transpose() * (unit.asDiagonal() * fold.b(moved));
  for (Eigen::Index k = 0; k < along.size(); ++k) {
    const double share = eigen.eigenvalues()(k);  // of what is known of this direction
    along(k) = share > kValidation.most_of_one_fold ? 0.0 : along(k) / (1.0 - share);
  }
  return unit.asDiagonal() * (eigen.eigenvectors() * along);
}

/// Values without a fold. The place of a border stays: the loss has no slope in it, and every trial that crosses it tells
/// it alike.
std::vector<double> without(const Solution& at, const Gram& whole, const Gram& fold) {
  std::vector<double> values = at.values;
  std::vector<Eigen::Index> moved;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!(at.parameters[k].rough > 0.0)) moved.push_back(Eigen::Index(k));
  if (moved.empty()) return values;
  const Eigen::VectorXd step = step_without(whole, fold, moved);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const auto k = std::size_t(moved[i]);
    const Parameter& p = at.parameters[k];
    values[k] =
        std::clamp(value_at(p, coordinate(p, values[k]) + step(Eigen::Index(i))), p.low, p.high);
  }
  return values;
}

struct Squares {
  double judged = 0.0, count = 0.0;
  std::vector<double> channels;
};

/// Sums of squares of the judged samples between two times of a trial.
Squares squares(const ResidualModel& model, const Structure& structure,
                std::span<const double> values, int trial, double from_s, double to_s) {
  const Residuals r = model.full_rate(structure, values, trial);
  Squares out;
  out.channels.assign(r.channels.size(), 0.0);
  for (std::size_t k = 0; k < r.t_s.size(); ++k) {
    const double t = r.t_s[k] - r.t_s.front();
    if (t < from_s || t > to_s || r.judgement[k] != Judgement::judged) continue;
    for (std::size_t c = 0; c < r.channels.size(); ++c)
      out.channels[c] += r.channels[c][k] * r.channels[c][k];
    out.judged += r.channels[0][k] * r.channels[0][k];
    out.count += 1.0;
  }
  return out;
}

/// NaN of nothing: an error that nobody could judge is not 0.
double root_mean(double sum, double count) {
  return count > 0.0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

/// Variances of the numbers' coordinates by the jackknife over the trials (or stretches of time) about what all of them
/// give, which counts what neighbouring residuals have in common and a trial that alone decides [Efron1981].
Eigen::VectorXd disagreement(const Residual& residual, const Solution& at,
                             const Eigen::VectorXd& weights, const Gram& whole) {
  const auto folds = folds_of(residual);
  const auto n = Eigen::Index(at.values.size()), k = Eigen::Index(folds.size());
  std::vector<Eigen::Index> all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  Eigen::MatrixXd steps(n, k);
  for (Eigen::Index f = 0; f < k; ++f) {
    const Fold& fold = folds[std::size_t(f)];
    steps.col(f) = step_without(whole, gram(at, weights, fold.first, fold.count), all);
  }
  return steps.rowwise().squaredNorm() * (double(k - 1) / double(k));
}

/// How well the numbers' coordinates are known.
struct Knowledge {
  Eigen::MatrixXd covariance;  ///< by the normal equations
  Eigen::VectorXd variances;   ///< theirs, or the trials' where these disagree more
};

Knowledge known_of(const Residual& residual, const Solution& at, const Eigen::VectorXd& weights,
                   const Gram& whole) {
  const auto n = Eigen::Index(at.values.size());
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index k = 0; k < n; ++k)
    covariance.col(k) = solve(whole.a, Eigen::VectorXd::Unit(n, k));
  Eigen::VectorXd variances = (covariance.diagonal() * std::max(1.0, at.mean_square()))
                                  .cwiseMax(disagreement(residual, at, weights, whole))
                                  .cwiseMax(0.0);
  return {std::move(covariance), std::move(variances)};
}

/// Standard errors, correlation and their words.
void inform(const Residual& residual, const Solution& at, const Eigen::VectorXd& weights,
            const Gram& whole, Fit& fit) {
  const auto n = Eigen::Index(at.values.size());
  const auto [covariance, variances] = known_of(residual, at, weights, whole);
  const double folds = double(folds_of(residual).size());
  const double widened = residual.problem().selection_thresholds().common_errors *
                         std::sqrt(1.0 + kValidation.few_clusters / folds);
  fit.correlation = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Parameter& p = at.parameters[std::size_t(k)];
    Estimate e{p.pointer, at.values[std::size_t(k)], 0.0, true, false};
    const double own =
        whole.a(k, k) - (std::isfinite(p.prior_sd) ? 1.0 / (p.prior_sd * p.prior_sd) : 0.0);
    const double sd = widened * std::sqrt(variances(k));
    e.informed = own > 0.0 && covariance(k, k) > 0.0 &&
                 !(std::sqrt(covariance(k, k)) > kValidation.uninformed * p.prior_sd);
    e.sd = !e.informed     ? std::numeric_limits<double>::infinity()
           : p.logarithmic ? sd * e.value
                           : sd;
    const double u = coordinate(p, e.value), low = coordinate(p, p.low),
                 high = coordinate(p, p.high);
    e.at_bound = u - low < 1e-6 * (high - low) || high - u < 1e-6 * (high - low);
    for (Eigen::Index j = 0; j < n; ++j)
      if (covariance(k, k) > 0.0 && covariance(j, j) > 0.0)
        fit.correlation(k, j) = covariance(k, j) / std::sqrt(covariance(k, k) * covariance(j, j));
    if (!e.informed)
      fit.remarks.push_back(fmt::format(
          "{}: these recordings say nothing of it; it stays near {:.4g}", e.pointer, p.start));
    else if (e.at_bound)
      fit.remarks.push_back(
          fmt::format("{}: ends at {:.4g}, the edge of its range", e.pointer, e.value));
    fit.estimates.push_back(std::move(e));
  }
  for (Eigen::Index k = 0; k < n; ++k)
    for (Eigen::Index j = k + 1; j < n; ++j)
      if (std::abs(fit.correlation(k, j)) > kValidation.known_together)
        fit.remarks.push_back(fmt::format("{} and {}: known only together (correlation {:.3f})",
                                          fit.estimates[std::size_t(k)].pointer,
                                          fit.estimates[std::size_t(j)].pointer,
                                          fit.correlation(k, j)));
}

/// A search may end a turn away from the angle that a reader expects, −π to π.
void within_a_period(Solution& at) {
  for (std::size_t k = 0; k < at.values.size(); ++k)
    if (const double period = at.parameters[k].period; period > 0.0)
      at.values[k] = std::remainder(at.values[k], period);
}

void hold_out(const Residual& residual, const Solution& at, const Gram& whole,
              const Eigen::VectorXd& weights, Fit& fit) {
  const Problem& problem = residual.problem();
  const auto folds = folds_of(residual);
  fit.folds = residual.trials() >= kValidation.fewest_trials ? "trials" : "stretches of time";
  fit.trial_score.resize(Eigen::Index(folds.size()));
  std::vector<Squares> held(folds.size());
  parallel(int(folds.size()), residual.threads(), [&](int f) {
    const Fold& fold = folds[std::size_t(f)];
    const auto values = without(at, whole, gram(at, weights, fold.first, fold.count));
    held[std::size_t(f)] =
        squares(problem, at.structure, values, fold.trial, fold.from_s, fold.to_s);
    Eigen::VectorXd r(problem.residual_size(fold.trial));
    problem.residuals(at.structure, values, fold.trial, r);
    fit.trial_score(f) =
        robust_loss(r.segment(fold.first - residual.offset(fold.trial), fold.count), at.scale) /
        double(std::max<Eigen::Index>(1, fold.count));
  });
  double sum = 0.0, count = 0.0;
  std::vector<double> by_trial(std::size_t(residual.trials()), 0.0), counts = by_trial;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    sum += held[f].judged, count += held[f].count;
    by_trial[std::size_t(folds[f].trial)] += held[f].judged;
    counts[std::size_t(folds[f].trial)] += held[f].count;
  }
  fit.held_out_rmse = root_mean(sum, count);
  for (std::size_t k = 0; k < by_trial.size(); ++k)
    fit.trials[k].held_out_rmse = root_mean(by_trial[k], counts[k]);
}

}  // namespace

Fit report(const Residual& residual, Solution& at, bool held_out) {
  const Problem& problem = residual.problem();
  within_a_period(at);
  differentiate(residual, at);
  Fit fit;
  fit.structure = at.structure;
  fit.values = at.values;
  fit.converged = at.converged;
  fit.whitened_rms = std::sqrt(at.mean_square());
  const Eigen::VectorXd weights = robust_weights(at.residual, at.scale);
  Gram whole = gram(at, weights, 0, residual.size());
  add_prior(at, whole);
  inform(residual, at, weights, whole, fit);
  std::vector<Squares> sums(std::size_t(residual.trials()));
  parallel(residual.trials(), residual.threads(), [&](int k) {
    sums[std::size_t(k)] = squares(problem, at.structure, at.values, k, -1.0, 1e18);
  });
  Squares total;
  total.channels.assign(problem.channels().size(), 0.0);
  for (int k = 0; k < residual.trials(); ++k) {
    const Squares& s = sums[std::size_t(k)];
    fit.trials.push_back({problem.trial_id(k), root_mean(s.judged, s.count),
                          std::numeric_limits<double>::quiet_NaN()});
    total.judged += s.judged, total.count += s.count;
    for (std::size_t c = 0; c < s.channels.size(); ++c) total.channels[c] += s.channels[c];
  }
  fit.rmse = root_mean(total.judged, total.count);
  // What is left holds the noise: less than it was thought to be shows that it is less.
  fit.noise_floor = std::min(problem.noise_floor(at.structure, at.values), fit.rmse);
  for (const double c : total.channels) fit.channel_rmse.push_back(root_mean(c, total.count));
  fit.held_out_rmse = std::numeric_limits<double>::quiet_NaN();
  if (held_out) hold_out(residual, at, whole, weights, fit);
  return fit;
}

bool told_from_zero(const Residual& residual, const Solution& solution) {
  if (solution.told_from_zero) return *solution.told_from_zero;
  Solution at = solution;
  differentiate(residual, at);
  const Eigen::VectorXd weights = robust_weights(at.residual, at.scale);
  Gram whole = gram(at, weights, 0, residual.size());
  add_prior(at, whole);
  const Eigen::VectorXd variances = known_of(residual, at, weights, whole).variances;
  const auto candidates =
      std::ranges::count_if(residual.problem().candidates(), &Candidate::possible);
  const double least = statistics::student_t_quantile(
      1.0 - 0.5 * kValidation.found_by_chance / double(std::max<std::ptrdiff_t>(1, candidates)),
      double(folds_of(residual).size()) - 1.0);
  const auto told = [&](const std::string& id) {
    bool any_strength = false;
    for (std::size_t k = 0; k < at.parameters.size(); ++k) {
      const Parameter& p = at.parameters[k];
      if (p.shape || !p.pointer.starts_with(id + "/")) continue;
      any_strength = true;
      const double away = p.logarithmic ? 1.0 : std::abs(at.values[k] - p.off);
      if (away > least * std::sqrt(variances(Eigen::Index(k)))) return true;
    }
    return !any_strength;
  };
  solution.told_from_zero = std::ranges::all_of(at.structure.effects, told);
  return *solution.told_from_zero;
}

double held_out_rmse(const Residual& residual, const Solution& at) {
  const Eigen::VectorXd weights = robust_weights(at.residual, at.scale);
  Gram whole = gram(at, weights, 0, residual.size());
  add_prior(at, whole);
  Fit fit;
  fit.trials.resize(std::size_t(residual.trials()));
  hold_out(residual, at, whole, weights, fit);
  return fit.held_out_rmse;
}

const Eigen::VectorXd& held_out_squares(const Residual& residual, const Solution& at) {
  if (at.held_out_squares.size() > 0) return at.held_out_squares;
  const auto folds = folds_of(residual);
  const Eigen::VectorXd weights = robust_weights(at.residual, at.scale);
  Gram whole = gram(at, weights, 0, residual.size());
  add_prior(at, whole);
  Eigen::VectorXd out(folds.size());
  parallel(int(folds.size()), residual.threads(), [&](int f) {
    const Fold& fold = folds[std::size_t(f)];
    const auto values = without(at, whole, gram(at, weights, fold.first, fold.count));
    const Squares s =
        squares(residual.problem(), at.structure, values, fold.trial, fold.from_s, fold.to_s);
    out(f) = s.count > 0.0 ? s.judged / s.count : std::numeric_limits<double>::quiet_NaN();
  });
  at.held_out_squares = std::move(out);
  return at.held_out_squares;
}

Eigen::VectorXd held_out_losses(const Residual& residual, const Solution& at, double scale) {
  const auto folds = folds_of(residual);
  const Eigen::VectorXd weights = robust_weights(at.residual, at.scale);
  Gram whole = gram(at, weights, 0, residual.size());
  add_prior(at, whole);
  Eigen::VectorXd out(folds.size());
  parallel(int(folds.size()), residual.threads(), [&](int f) {
    const Fold& fold = folds[std::size_t(f)];
    const auto values = without(at, whole, gram(at, weights, fold.first, fold.count));
    Eigen::VectorXd step(at.values.size());
    for (std::size_t k = 0; k < at.values.size(); ++k)
      step(Eigen::Index(k)) =
          coordinate(at.parameters[k], values[k]) - coordinate(at.parameters[k], at.values[k]);
    const Eigen::Index begin = residual.offset(fold.trial),
                       all = residual.offset(fold.trial + 1) - begin;
    Eigen::VectorXd trial =
        at.residual.segment(begin, all) + at.jacobian.middleRows(begin, all) * step;
    residual.problem().leave_stretches_out(at.structure, fold.trial, kValidation.stretches_of_trial,
                                           trial);
    const auto here = at.residual.segment(fold.first, fold.count);
    const Eigen::VectorXd there = trial.segment(fold.first - begin, fold.count);
    // Exactly 0 is that of which the structure says nothing (dry friction at rest).
    const auto judged = (here.array() != 0.0).eval();
    out(f) = robust_loss(judged.select(there, 0.0), scale) / std::max(1.0, double(judged.count()));
  });
  return out;
}

Solution fit_base(const Residual& residual, const Structure& structure) {
  std::vector<double> start;
  for (const Parameter& p : residual.problem().parameters(structure)) start.push_back(p.start);
  Solution at = search(residual, structure, std::move(start), nullptr, {.max_iterations = 40});
  differentiate(residual, at);
  return polish(residual, std::move(at));
}

Result<Fit> fit(const Problem& problem, const Structure& structure, const FitOptions& options,
                const core::Progress& progress) {
  for (const std::string& id : structure.effects) {
    const auto& all = problem.candidates();
    const auto it = std::ranges::find_if(all, [&](const auto& c) { return c.facts.id == id; });
    if (it == all.end())
      return Error{Errc::bad_input,
                   fmt::format("effect '{}': the catalogue of the {} rig has none of that name, "
                               "or the model has it already",
                               id, problem.rig())};
    if (!it->possible)
      return Error{Errc::bad_input, fmt::format("effect '{}': {}", id, it->why_not)};
  }
  const Residual residual(problem, options.threads);
  if (residual.size() == 0)
    return Error{Errc::bad_input, "the recordings are too short to compare"};
  Solution at = fit_base(residual);
  for (std::size_t k = 0; k < structure.effects.size(); ++k) {
    if (progress && !progress(double(k) / double(structure.effects.size() + 1)))
      return Error{Errc::cancelled, "stopped"};
    const std::string& id = structure.effects[k];
    at = extend(residual, at, linear_screen(residual, at, id), id, 3);
    differentiate(residual, at);
  }
  at =
      search(residual, at.structure, at.values, nullptr,
             {.max_iterations = options.max_iterations, .tolerance = 1e-7, .fresh_jacobian = true});
  if (progress && !progress(0.9)) return Error{Errc::cancelled, "stopped"};
  return report(residual, at, options.held_out);
}

}  // namespace lab
}  // namespace tractus
