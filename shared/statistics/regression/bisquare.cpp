#include "statistics/regression/bisquare.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/regression/block_least_squares.hpp"

namespace tractus {
namespace statistics {
namespace {

using Array = Eigen::ArrayXd;
using Qr = Eigen::ColPivHouseholderQR<Matrix>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
const double kRootEpsilon = std::sqrt(kEpsilon);

/// Median of |r| about zero, without the `dropped` smallest, as a standard deviation.
double mad_sigma(const Array& residuals, Eigen::Index dropped) {
  std::vector<double> size(static_cast<std::size_t>(residuals.size()));
  Eigen::Map<Array>(size.data(), residuals.size()) = residuals.abs();
  const auto left = residuals.size() - dropped;
  const auto middle = size.begin() + dropped + left / 2;
  std::nth_element(size.begin(), middle, size.end());
  double median = *middle;
  if (left % 2 == 0) median = 0.5 * (median + *std::max_element(size.begin(), middle));
  return median / 0.6745;
}

/// How many of the smallest residuals the scale leaves out.
Eigen::Index dropped_by(BisquareConvention convention, Eigen::Index rank) {
  return convention == BisquareConvention::mass ? 0 : std::max<Eigen::Index>(1, rank) - 1;
}

Array weights_of(const Array& u) {
  return (u.abs() < 1.0).select((1.0 - u.square()).square(), 0.0);
}

Array influence_of(const Array& u) { return u * weights_of(u); }

bool settled(const Vector& now, const Vector& before) {
  const Array limit = kRootEpsilon * now.array().abs().max(before.array().abs());
  return ((now - before).array().abs() <= limit).all();
}

double sample_deviation(const Vector& y) {
  return std::sqrt((y.array() - y.mean()).square().sum() / static_cast<double>(y.size() - 1));
}

/// What stays fixed while the weights move.
struct Problem {
  const Matrix& x;
  const Vector& y;
  BisquareOptions options;
  double tiny_sigma = 0.0;  ///< floor of the scale
  Array leverage_factor = {};
  std::optional<BlockLeastSquares> blocks = {};  ///< for very many rows

  Vector residuals(const Vector& coefficients) const {
    if (!blocks) return y - x * coefficients;
    Vector out;
    blocks->residuals(coefficients, out);
    return out;
  }
  /// Weighted least squares; the rank of the weighted design.
  Eigen::Index solve(const Vector& weights, Vector& coefficients) const {
    if (const auto fit = blocks ? blocks->solve(&weights) : std::nullopt) {
      coefficients = fit->coefficients;
      return x.cols();
    }
    const Vector root = weights.cwiseSqrt();
    const Qr qr(root.asDiagonal() * x);
    coefficients = qr.solve(root.cwiseProduct(y));
    return qr.rank();
  }
};

/// The least-squares start: coefficients, sigma, leverage and (XᵀX)⁻¹. False: collinear.
bool start(const Problem& problem, Bisquare& fit) {
  const Matrix& x = problem.x;
  const Eigen::Index n = x.rows(), p = x.cols();
  if (const auto solved = problem.blocks ? problem.blocks->solve(nullptr) : std::nullopt) {
    fit.ols_coefficients = solved->coefficients;
    fit.covariance = solved->unscaled_covariance;
    problem.blocks->residuals_and_leverage(*solved, fit.residuals, fit.leverage);
    fit.leverage = fit.leverage.cwiseMin(0.9999);
  } else {
    const Qr qr(x);
    if (qr.rank() < p) return false;
    fit.ols_coefficients = qr.solve(problem.y);
    const Matrix thin = qr.householderQ() * Matrix::Identity(n, p);
    fit.leverage = thin.rowwise().squaredNorm().cwiseMin(0.9999);
    const Matrix root = qr.colsPermutation() * qr.matrixR()
                                                   .topLeftCorner(p, p)
                                                   .triangularView<Eigen::Upper>()
                                                   .solve(Matrix::Identity(p, p))
                                                   .eval();
    fit.covariance = root * root.transpose();
    fit.residuals = problem.residuals(fit.ols_coefficients);
  }
  fit.ols_sigma = fit.residuals.norm() / std::sqrt(static_cast<double>(n - p));
  return true;
}

/// Step 1: reweight until every coefficient settles (or, as in MASS, the residuals do). Leaves the
/// residuals of the last coefficients, and in `fit.mad_sigma` the last scale.
void iterate(const Problem& problem, Bisquare& fit) {
  const bool mass = problem.options.convention == BisquareConvention::mass;
  Eigen::Index rank = problem.x.cols();
  fit.coefficients = fit.ols_coefficients;
  fit.weights = Vector::Ones(problem.y.size());
  for (fit.iterations = 1; fit.iterations <= problem.options.solves; ++fit.iterations) {
    Array adjusted = fit.residuals.array();
    if (!mass) adjusted *= problem.leverage_factor;
    fit.mad_sigma = mad_sigma(adjusted, dropped_by(problem.options.convention, rank));
    const double scale = std::max(fit.mad_sigma, problem.tiny_sigma) * problem.options.tuning;
    fit.weights = weights_of(adjusted * (1.0 / scale));
    const Vector before = fit.coefficients;
    rank = problem.solve(fit.weights, fit.coefficients);
    const Vector residuals = problem.residuals(fit.coefficients);
    const double moved = (residuals - fit.residuals).norm();
    fit.converged = mass ? moved <= 1e-4 * fit.residuals.norm() : settled(fit.coefficients, before);
    fit.residuals = residuals;
    if (fit.converged) return;
  }
}

/// The spread of MASS::rlm's summary: Huber's proposal, at the last residuals and the scale of the
/// last solve.
double huber_sigma(const Problem& problem, const Bisquare& fit) {
  const double n = static_cast<double>(problem.y.size()), p = static_cast<double>(problem.x.cols());
  const Array u = fit.residuals.array() / (fit.mad_sigma * problem.options.tuning), t = u.square();
  const double s = (fit.residuals.array() * weights_of(u)).square().sum() / (n - p);
  const Array slope = (t < 1.0).select((1.0 - t) * (1.0 - 5.0 * t), 0.0);
  const double mean = slope.mean();
  const double variance = (slope - mean).square().sum() / (n - 1.0);
  return std::sqrt(s) * (1.0 + p * variance / (n * mean * mean)) / mean;
}

/// Step 3: sigma from the weights; raw residuals where every weight is 0 or 1.
double robust_sigma(const Problem& problem, const Bisquare& fit) {
  const double n = static_cast<double>(problem.y.size()), p = static_cast<double>(problem.x.cols());
  const Array w = fit.weights.array();
  if (((w < kRootEpsilon) || (w > 1.0 - kRootEpsilon)).all()) {
    const Array kept = (w > 1.0 - kRootEpsilon).cast<double>();
    return (fit.residuals.array() * kept).matrix().norm() / std::sqrt(kept.sum() - p);
  }
  const double scale = std::max(fit.mad_sigma, problem.tiny_sigma) * problem.options.tuning;
  const Array u = fit.residuals.array() * problem.leverage_factor / scale;
  constexpr double kStep = 1e-4;
  const double m1 = ((influence_of(u + kStep) - influence_of(u - kStep)) / (2.0 * kStep)).mean();
  const double m2 = ((1.0 - fit.leverage.array()) * influence_of(u).square()).sum() / (n - p);
  const double correction = 1.0 + p / n * (1.0 - m1) / m1;
  return correction * std::sqrt(m2) * scale / m1;
}

/// Step 4: shrinkage towards the least-squares sigma.
double shrunk_sigma(const Bisquare& fit, double n, double p) {
  const double blend =
      (fit.ols_sigma * fit.ols_sigma * p * p + fit.robust_sigma * fit.robust_sigma * n) /
      (p * p + n);
  return std::max(fit.robust_sigma, std::sqrt(blend));
}

/// Step 5: the tests.
void add_tests(Bisquare& fit, double n, double p, bool floor) {
  fit.covariance *= fit.sigma * fit.sigma;
  fit.standard_errors = fit.covariance.diagonal().cwiseMax(floor ? kEpsilon : 0.0).cwiseSqrt();
  fit.df_residual = n - p;
  fit.t = fit.coefficients.cwiseQuotient(fit.standard_errors);
  fit.p = fit.t.unaryExpr([&](double t) { return student_t_two_sided(t, n - p); });
}

}  // namespace

core::Result<Bisquare> bisquare(const Design& design, const Vector& response,
                                const BisquareOptions& options) {
  TRY(check(design, response));
  const bool mass = options.convention == BisquareConvention::mass;
  const auto p = design.columns.cols();
  Bisquare fit;
  fit.names = design.names;
  Problem problem{design.columns, response, options, 1e-6 * sample_deviation(response)};
  if (problem.tiny_sigma == 0.0) problem.tiny_sigma = 1.0;
  if (mass) problem.options.solves = std::min(options.solves, 20);
  if (is_large(design))
    if (auto blocks = BlockLeastSquares::make(design, response))
      problem.blocks.emplace(std::move(*blocks));
  if (!start(problem, fit)) return collinear_error(design);
  if (!std::isfinite(fit.ols_sigma) || !fit.covariance.allFinite())
    return core::Error{core::Errc::out_of_range,
                       "the numbers are too large or too small for sums of squares: rescale them"};
  problem.leverage_factor = (1.0 - fit.leverage.array()).rsqrt();
  if (mass) problem.leverage_factor.setOnes();
  iterate(problem, fit);
  if (mass) {
    fit.robust_sigma = huber_sigma(problem, fit);
    fit.sigma = fit.robust_sigma;
  } else {
    fit.mad_sigma = mad_sigma(fit.residuals.array() * problem.leverage_factor,
                              dropped_by(options.convention, p));
    fit.robust_sigma = robust_sigma(problem, fit);
    fit.sigma = shrunk_sigma(fit, static_cast<double>(response.size()), static_cast<double>(p));
  }
  add_tests(fit, static_cast<double>(response.size()), static_cast<double>(p),
            options.standard_error_floor);
  if (!fit.covariance.allFinite() ||
      (fit.sigma > 0.0 && !(fit.covariance.diagonal().minCoeff() > 1e-300)))
    return core::Error{
        core::Errc::out_of_range,
        "the scales of the columns and of the response are too far apart: rescale them"};
  fit.studentised = fit.residuals.array() * problem.leverage_factor / fit.sigma;
  if (!fit.coefficients.allFinite() || !std::isfinite(fit.sigma))
    return core::Error{core::Errc::out_of_range,
                       "too few observations keep a weight to estimate their spread"};
  return fit;
}

}  // namespace statistics
}  // namespace tractus
