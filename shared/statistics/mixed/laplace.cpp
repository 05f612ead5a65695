#include "statistics/mixed/laplace.hpp"

#include <cmath>
#include <limits>

#include "statistics/distributions/binomial.hpp"

namespace tractus {
namespace statistics {
namespace {

constexpr int kMostSteps = 100, kMostHalvings = 30;
constexpr double kSettled = 1e-10;        // of η
constexpr double kLeastVariance = 1e-12;  // of one answer, so that the working response is finite

double squared_norm(const std::vector<Matrix>& u) {
  double out = 0.0;
  for (const Matrix& part : u) out += part.squaredNorm();
  return out;
}

}  // namespace

LaplaceDeviance::LaplaceDeviance(const Matrix& x, const Counts& counts,
                                 const std::vector<RandomTerm>& terms)
    : counts_(counts), squares_(x, terms) {
  x_ = x * squares_.column_scale().cwiseInverse().asDiagonal();
  binomial_ = -2.0 * binomial::log_coefficients(counts);
  for (const auto& term : squares_.terms())
    mode_.u.push_back(Matrix::Zero(std::ssize(term.levels), term.effects()));
}

/// η += Z Λ u.
void LaplaceDeviance::add_effects(const Vector& theta, const std::vector<Matrix>& u,
                                  Array& eta) const {
  Eigen::Index place = 0;
  for (std::size_t t = 0; t < u.size(); ++t) {
    const ScaledTerm& term = squares_.terms()[t];
    const Matrix lambda = triangle(term, theta, place);
    const Matrix b = u[t] * lambda.transpose() * term.scale.cwiseInverse().asDiagonal();
    for (Eigen::Index e = 0; e < term.effects(); ++e)
      for (Eigen::Index i = 0; i < eta.size(); ++i)
        eta[i] += term.from->columns(i, e) * b(term.level_of[std::size_t(i)], e);
  }
}

/// θ += Σ_levels Zᵀ rows of_levelsᵀ, the entries of each Λ.
void LaplaceDeviance::add_slopes(const Vector& rows, const std::vector<Matrix>& of_levels,
                                 Vector& theta) const {
  Eigen::Index place = 0;
  for (std::size_t t = 0; t < of_levels.size(); ++t) {
    const ScaledTerm& term = squares_.terms()[t];
    Matrix sums = Matrix::Zero(of_levels[t].rows(), term.effects());  // Zᵀ rows
    for (Eigen::Index e = 0; e < term.effects(); ++e)
      for (Eigen::Index i = 0; i < rows.size(); ++i)
        sums(term.level_of[std::size_t(i)], e) +=
            rows[i] * term.from->columns(i, e) / term.scale[e];
    const Matrix slope = sums.transpose() * of_levels[t];
    for (Eigen::Index c = 0; c < slope.cols(); ++c)
      for (Eigen::Index r = c; r < slope.rows(); ++r) theta[place++] += slope(r, c);
  }
}

/// The objective of a mode whose η is known.
void LaplaceDeviance::complete(Mode& mode) const {
  Array softplus;
  binomial::parts(mode.eta, mode.pi, softplus);
  mode.objective =
      -2.0 * (counts_.successes.array() * mode.eta - counts_.trials.array() * softplus).sum() +
      squared_norm(mode.u);
}

LaplaceDeviance::Mode LaplaceDeviance::mode_of(const Vector& theta, Vector beta,
                                               std::vector<Matrix> u) const {
  Mode out{std::move(beta), std::move(u), {}, {}};
  out.eta = (x_ * out.beta).array();
  add_effects(theta, out.u, out.eta);
  complete(out);
  return out;
}

Vector LaplaceDeviance::weights(const Mode& at) const {
  return counts_.trials.array() * (at.pi * (1.0 - at.pi)).cwiseMax(kLeastVariance);
}

/// Where one weighted least squares leads, with β or at this β.
Penalised LaplaceDeviance::weighted_step(const Vector& theta, const Mode& from, bool with_beta) {
  const Vector w = weights(from);
  Vector working =
      from.eta + (counts_.successes.array() - counts_.trials.array() * from.pi) / w.array();
  squares_.weigh(w);
  if (with_beta) {
    squares_.observe(working);
    return squares_.solve(theta, PenalisedLeastSquares::Want::everything);
  }
  working.noalias() -= x_ * from.beta;
  return squares_.solve_effects(theta, working);
}

/// To the mode of a concave function. False: it was not reached.
bool LaplaceDeviance::climb(const Vector& theta, Mode& at, bool with_beta, Penalised& last) {
  for (int k = 0; k < kMostSteps; ++k) {
    last = weighted_step(theta, at, with_beta);
    Mode next = mode_of(theta, with_beta ? last.beta : at.beta, last.u);
    const double rounding = 1e-12 * (1.0 + std::abs(at.objective));
    for (int half = 0; half < kMostHalvings && !(next.objective <= at.objective + rounding);
         ++half) {
      next.beta = 0.5 * (next.beta + at.beta);
      next.eta = 0.5 * (next.eta + at.eta);
      for (std::size_t t = 0; t < next.u.size(); ++t) next.u[t] = 0.5 * (next.u[t] + at.u[t]);
      complete(next);
    }
    if (!(next.objective <= at.objective + rounding)) return false;
    const double moved = (next.eta - at.eta).abs().maxCoeff();
    at = std::move(next);
    if (moved < kSettled * (1.0 + at.eta.abs().maxCoeff())) return true;
  }
  return false;
}

/// The mode of u, from the last one or from 0, whichever is nearer.
bool LaplaceDeviance::find(const Vector& theta, const Vector& beta) {
  if (!theta.allFinite() || !beta.allFinite()) return false;
  if (theta_.size() > 0 && theta == theta_ && beta == mode_.beta) return true;
  theta_.resize(0);
  std::vector<Matrix> zero = mode_.u;
  for (Matrix& part : zero) part.setZero();
  Mode at = mode_of(theta, beta, mode_.u), from_zero = mode_of(theta, beta, std::move(zero));
  if (!(at.objective <= from_zero.objective)) at = std::move(from_zero);
  Penalised last;
  if (!climb(theta, at, false, last) || !std::isfinite(at.objective)) return false;
  mode_ = std::move(at);
  theta_ = theta;
  log_det_ = last.log_det_L;
  return true;
}

std::optional<LaplaceDeviance::Start> LaplaceDeviance::joint_mode(const Vector& theta) {
  Mode at = mode_of(theta, Vector::Zero(x_.cols()), mode_.u);
  Penalised last;
  if (!climb(theta, at, true, last)) return {};
  mode_ = std::move(at);
  theta_.resize(0);
  return Start{mode_.beta, last.covariance};
}

double LaplaceDeviance::value(const Vector& theta, const Vector& beta) {
  if (!find(theta, beta)) return std::numeric_limits<double>::quiet_NaN();
  return mode_.objective + log_det_ + binomial_;
}

LaplaceDeviance::Gradient LaplaceDeviance::gradient(const Vector& theta, const Vector& beta) {
  Gradient out{Vector::Constant(theta.size(), std::numeric_limits<double>::quiet_NaN()),
               Vector::Constant(beta.size(), std::numeric_limits<double>::quiet_NaN())};
  if (!find(theta, beta)) return out;
  const LogDeterminantSlope slope = squares_.log_determinant_slope(theta);
  const Array w = weights(mode_);
  const Array residual = counts_.successes.array() - counts_.trials.array() * mode_.pi;
  // g/W is a response whose effects are q: dW/dη = W (1 − 2π).
  const Array g_by_w = slope.of_weights.array() * (1.0 - 2.0 * mode_.pi);
  const std::vector<Matrix> q = squares_.solve_effects_again(theta, g_by_w).u;
  Array of_q = Array::Zero(w.size());
  add_effects(theta, q, of_q);
  const Vector rho = w * (g_by_w - of_q) - 2.0 * residual;
  out.beta = x_.transpose() * rho;
  out.theta = slope.of_theta;
  add_slopes(rho, mode_.u, out.theta);
  add_slopes(residual.matrix(), q, out.theta);
  return out;
}

std::vector<Matrix> LaplaceDeviance::effects(const Vector& theta) const {
  std::vector<Matrix> out;
  Eigen::Index place = 0;
  for (std::size_t t = 0; t < mode_.u.size(); ++t)
    out.push_back(mode_.u[t] * triangle(squares_.terms()[t], theta, place).transpose());
  return out;
}

}  // namespace statistics
}  // namespace tractus
