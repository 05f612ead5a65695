#include "lab/discover/evidence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

double log_determinant(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  return 2.0 * factor.matrixLLT().diagonal().array().log().sum();
}

/// A positive definite sum, made so where a direction is unknown.
Eigen::LLT<Eigen::MatrixXd> factored(Eigen::MatrixXd a) {
  for (Eigen::Index k = 0; k < a.rows(); ++k) a(k, k) += 1e-10 * std::max(a(k, k), 1e-30);
  return Eigen::LLT<Eigen::MatrixXd>(a);
}

double squares_at(const TrialGram& t, const Eigen::VectorXd& change) {
  return std::max(0.0, t.rr + 2.0 * t.b.dot(change) + change.dot(t.a * change));
}

/// Weights of a Bayesian bootstrap over trials, one draw a column, that sum to their number.
Eigen::MatrixXd trial_weights(Eigen::Index trials) {
  std::mt19937_64 random(20261123);
  std::exponential_distribution<double> one(1.0);
  Eigen::MatrixXd out(trials, kDiscovery.bootstraps);
  for (Eigen::Index c = 0; c < out.cols(); ++c) {
    for (Eigen::Index r = 0; r < trials; ++r) out(r, c) = one(random);
    out.col(c) *= double(trials) / out.col(c).sum();
  }
  return out;
}

/// [hypothesis][draw]
Eigen::MatrixXd drawn_scores(const std::vector<Eigen::VectorXd>& scores,
                             const std::vector<double>& prior) {
  const Eigen::MatrixXd weights = trial_weights(scores.front().size());
  Eigen::MatrixXd out(Eigen::Index(scores.size()), weights.cols());
  for (std::size_t h = 0; h < scores.size(); ++h)
    out.row(Eigen::Index(h)) = (scores[h].transpose() * weights).array() + prior[h];
  return out;
}

}  // namespace

Evidence leave_one_out(const std::vector<TrialGram>& trials, const LinearPrior& prior,
                       double correlation) {
  const Eigen::Index p = prior.mean.size();
  TrialGram all{Eigen::MatrixXd::Zero(p, p), Eigen::VectorXd::Zero(p)};
  for (const TrialGram& t : trials) all.a += t.a, all.b += t.b, all.rows += t.rows, all.rr += t.rr;
  const auto& [a, b, squares, rows] = all;
  Evidence out;
  out.log_score.resize(Eigen::Index(trials.size()));
  const Eigen::VectorXd pull = prior.precision * prior.mean;
  // What is left decides what a residual weighs against the prior: twice is enough.
  double variance = std::max(kDiscovery.least_variance, squares / rows);
  for (int round = 0; round < 2; ++round) {
    const double weight = 1.0 / (correlation * variance);
    out.change = factored(weight * a + prior.precision).solve(pull - weight * b);
    variance = std::max(kDiscovery.least_variance, squares_at(all, out.change) / rows);
  }
  double held_out = 0.0;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const TrialGram& t = trials[k];
    const double weight = 1.0 / (correlation * variance);
    const Eigen::MatrixXd known = weight * (a - t.a) + prior.precision;
    const auto others = factored(known);
    const Eigen::VectorXd mean = others.solve(pull - weight * (b - t.b));
    const double off = squares_at(t, mean);
    const double own = std::max(kDiscovery.least_variance,
                                (squares_at(all, mean) - off) / std::max(1.0, rows - t.rows));
    // The trial's residual is normal about Z mean with variance own·correlation + Z known⁻¹ Zᵀ.
    const double unit = 1.0 / (correlation * own);
    const auto with = factored(known + unit * t.a);
    const Eigen::VectorXd slope = unit * (t.b + t.a * mean);
    const double quadratic = unit * off - slope.dot(with.solve(slope));
    out.log_score(Eigen::Index(k)) =
        -0.5 * (t.rows / correlation * std::log(2.0 * std::numbers::pi * own) +
                log_determinant(with) - log_determinant(others) + std::max(0.0, quadratic));
    held_out += off;
  }
  out.total = out.log_score.sum();
  out.mean_square = held_out / rows;
  return out;
}

double correlation_of(const std::vector<Eigen::VectorXd>& residuals) {
  double variance = 0.0;
  for (const auto& r : residuals) variance += r.squaredNorm();
  if (!(variance > 0.0)) return 1.0;
  double out = 1.0;
  for (Eigen::Index lag = 1; lag <= kDiscovery.most_correlation; ++lag) {
    double sum = 0.0;
    for (const auto& r : residuals)
      if (r.size() > lag) sum += r.head(r.size() - lag).dot(r.tail(r.size() - lag));
    if (!(sum > 0.0)) break;
    out += 2.0 * sum / variance;
  }
  return out;
}

std::vector<double> stacked_probabilities(const std::vector<Eigen::VectorXd>& scores,
                                          const std::vector<double>& prior) {
  std::vector<double> out(scores.size(), 0.0);
  if (scores.empty()) return out;
  const Eigen::MatrixXd drawn = drawn_scores(scores, prior);
  for (Eigen::Index c = 0; c < drawn.cols(); ++c) {
    const Eigen::ArrayXd share = (drawn.col(c).array() - drawn.col(c).maxCoeff()).exp();
    const double sum = share.sum();
    for (std::size_t h = 0; h < out.size(); ++h)
      out[h] += share(Eigen::Index(h)) / sum / double(drawn.cols());
  }
  return out;
}

std::vector<double> share_of_best(const std::vector<Eigen::VectorXd>& scores,
                                  const std::vector<double>& prior) {
  std::vector<double> out(scores.size(), 0.0);
  if (scores.empty()) return out;
  const Eigen::MatrixXd drawn = drawn_scores(scores, prior);
  for (Eigen::Index c = 0; c < drawn.cols(); ++c) {
    Eigen::Index best = 0;
    drawn.col(c).maxCoeff(&best);
    out[std::size_t(best)] += 1.0 / double(drawn.cols());
  }
  return out;
}

}  // namespace lab
}  // namespace tractus
