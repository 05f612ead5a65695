#include "statistics/bisquare.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/distributions.hpp"
#include "statistics/modified_z.hpp"

namespace statistics {
namespace {

using Array = Eigen::ArrayXd;
using Qr = Eigen::ColPivHouseholderQR<Matrix>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
const double kRootEpsilon = std::sqrt(kEpsilon);

/// Median of |r| about zero, without the (rank − 1) smallest, as a standard deviation.
double mad_sigma(const Array& residuals, Eigen::Index rank) {
  std::vector<double> size(residuals.size());
  Eigen::Map<Array>(size.data(), residuals.size()) = residuals.abs();
  const auto dropped = static_cast<std::ptrdiff_t>(std::max<Eigen::Index>(1, rank) - 1);
  std::nth_element(size.begin(), size.begin() + dropped, size.end());
  size.erase(size.begin(), size.begin() + dropped);
  return median(std::move(size)) / 0.6745;
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
  double tuning;
  double tiny_sigma;  ///< floor of the scale
  Array leverage_factor;
};

/// The least-squares start: coefficients, sigma, leverage and (XᵀX)⁻¹. False: collinear.
bool start(const Matrix& x, const Vector& y, Bisquare& fit) {
  const Eigen::Index n = x.rows(), p = x.cols();
  const Qr qr(x);
  if (qr.rank() < p) return false;
  fit.ols_coefficients = qr.solve(y);
  const Matrix thin = qr.householderQ() * Matrix::Identity(n, p);
  fit.leverage = thin.rowwise().squaredNorm().cwiseMin(0.9999);
  fit.ols_sigma = (y - x * fit.ols_coefficients).norm() / std::sqrt(static_cast<double>(n - p));
  const Matrix root = qr.colsPermutation() * qr.matrixR()
                                                 .topLeftCorner(p, p)
                                                 .triangularView<Eigen::Upper>()
                                                 .solve(Matrix::Identity(p, p))
                                                 .eval();
  fit.covariance = root * root.transpose();
  return true;
}

/// Step 1: reweight until every coefficient settles.
void iterate(const Problem& problem, int solves, Bisquare& fit) {
  Eigen::Index rank = problem.x.cols();
  fit.coefficients = fit.ols_coefficients;
  fit.weights = Vector::Ones(problem.y.size());
  for (fit.iterations = 1; fit.iterations <= solves; ++fit.iterations) {
    const Array adjusted =
        (problem.y - problem.x * fit.coefficients).array() * problem.leverage_factor;
    const double scale = std::max(mad_sigma(adjusted, rank), problem.tiny_sigma) * problem.tuning;
    fit.weights = weights_of(adjusted / scale);
    const Vector root = fit.weights.cwiseSqrt();
    const Qr qr(root.asDiagonal() * problem.x);
    rank = qr.rank();
    const Vector before = fit.coefficients;
    fit.coefficients = qr.solve(root.cwiseProduct(problem.y));
    if (settled(fit.coefficients, before)) {
      fit.converged = true;
      return;
    }
  }
}

/// Step 3: sigma from the weights; raw residuals where every weight is 0 or 1.
double robust_sigma(const Problem& problem, const Bisquare& fit) {
  const double n = static_cast<double>(problem.y.size()), p = static_cast<double>(problem.x.cols());
  const Array w = fit.weights.array();
  if (((w < kRootEpsilon) || (w > 1.0 - kRootEpsilon)).all()) {
    const Array kept = (w > 1.0 - kRootEpsilon).cast<double>();
    return (fit.residuals.array() * kept).matrix().norm() / std::sqrt(kept.sum() - p);
  }
  const double scale = std::max(fit.mad_sigma, problem.tiny_sigma) * problem.tuning;
  const Array u = fit.residuals.array() * problem.leverage_factor / scale;
  constexpr double kStep = 1e-4;
  const double m1 = ((influence_of(u + kStep) - influence_of(u - kStep)) / (2.0 * kStep)).mean();
  const double m2 = ((1.0 - fit.leverage.array()) * influence_of(u).square()).sum() / (n - p);
  const double correction = 1.0 + p / n * (1.0 - m1) / m1;
  return correction * std::sqrt(m2) * scale / m1;
}

/// Steps 4 and 5: shrinkage towards the least-squares sigma, then the tests.
void add_tests(Bisquare& fit, double n, double p, bool floor) {
  const double blend =
      (fit.ols_sigma * fit.ols_sigma * p * p + fit.robust_sigma * fit.robust_sigma * n) /
      (p * p + n);
  fit.sigma = std::max(fit.robust_sigma, std::sqrt(blend));
  fit.covariance *= fit.sigma * fit.sigma;
  fit.standard_errors = fit.covariance.diagonal().cwiseMax(floor ? kEpsilon : 0.0).cwiseSqrt();
  fit.df_residual = n - p;
  fit.t = fit.coefficients.cwiseQuotient(fit.standard_errors);
  fit.p = fit.t.unaryExpr([&](double t) { return student_t_two_sided(t, n - p); });
}

}  // namespace

core::Result<Bisquare> bisquare(const Design& design, const Vector& response,
                                const BisquareOptions& options) {
  if (auto fine = check(design, response); !fine) return fine.error();
  Bisquare fit;
  fit.names = design.names;
  if (!start(design.columns, response, fit)) return collinear_error(design);
  if (!std::isfinite(fit.ols_sigma) || !fit.covariance.allFinite())
    return core::Error{core::Errc::out_of_range,
                       "the numbers are too large or too small for sums of squares: rescale them"};
  Problem problem{design.columns, response, options.tuning, 1e-6 * sample_deviation(response),
                  (1.0 - fit.leverage.array()).rsqrt()};
  if (problem.tiny_sigma == 0.0) problem.tiny_sigma = 1.0;
  iterate(problem, options.solves, fit);
  fit.residuals = response - design.columns * fit.coefficients;
  fit.mad_sigma = mad_sigma(fit.residuals.array() * problem.leverage_factor, design.columns.cols());
  fit.robust_sigma = robust_sigma(problem, fit);
  add_tests(fit, static_cast<double>(response.size()), static_cast<double>(design.columns.cols()),
            options.standard_error_floor);
  fit.studentised = fit.residuals.array() * problem.leverage_factor / fit.sigma;
  if (!fit.coefficients.allFinite() || !std::isfinite(fit.sigma))
    return core::Error{core::Errc::out_of_range,
                       "too few observations keep a weight to estimate their spread"};
  return fit;
}

}  // namespace statistics
