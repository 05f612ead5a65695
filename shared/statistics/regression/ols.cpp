#include "statistics/regression/ols.hpp"

#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/regression/block_least_squares.hpp"

namespace tractus {
namespace statistics {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kConstantShare = 1e-15;
/// Below this share of its length a column is a combination of the others.
constexpr long double kDependence = 1e-13L;

// With 64 bits of mantissa: the certified digits of NIST's hard sets need them.
using Real = long double;
using ExtendedMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using ExtendedVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// Mean of a column, taken about its first value so that a large common offset costs no digits.
Real centre(ExtendedVector& column) {
  const Real shift = column[0];
  column.array() -= shift;
  const Real mean = column.mean();
  column.array() -= mean;
  const Real rest = column.mean();
  column.array() -= rest;
  return shift + (mean + rest);
}

/// The problem after centring and scaling.
struct Scaled {
  ExtendedMatrix z;  // [observation][column], length one each
  ExtendedVector means, scales;
  ExtendedVector y;
  Real y_mean = 0;
};

Scaled scaled(const Design& design, const Vector& response) {
  const Eigen::Index first = design.intercept ? 1 : 0;
  Scaled s;
  s.z = design.columns.rightCols(design.columns.cols() - first).cast<Real>();
  s.means = ExtendedVector::Zero(s.z.cols());
  s.scales = ExtendedVector::Ones(s.z.cols());
  s.y = response.cast<Real>();
  if (design.intercept) s.y_mean = centre(s.y);
  for (Eigen::Index j = 0; j < s.z.cols(); ++j) {
    ExtendedVector column = s.z.col(j);
    if (design.intercept) s.means[j] = centre(column);
    const Real length = column.stableNorm();
    const Real size = std::abs(s.means[j]) + length;
    // A constant column leaves only rounding behind: to zero, so that the rank shows it.
    if (length > Real(kConstantShare) * size)
      s.z.col(j) = column / (s.scales[j] = length);
    else
      s.z.col(j).setZero();
  }
  return s;
}

/// What follows from the residual and the total sum of squares, with k columns beside an intercept.
void add_model(Real rss, Real tss, Eigen::Index k, Eigen::Index df_residual, Ols& out) {
  const Real df = Real(df_residual);
  out.rss = static_cast<double>(rss);
  out.sigma = static_cast<double>(std::sqrt(rss / df));
  out.r_squared = static_cast<double>(Real(1) - rss / tss);
  out.adjusted_r_squared =
      static_cast<double>(Real(1) - (rss / df) / (tss / Real(df_residual + k)));
  out.f_df1 = static_cast<double>(k);
  out.f = k > 0 ? static_cast<double>(((tss - rss) / Real(k)) / (rss / df)) : kNaN;
}

/// Coefficients, (XᵀX)⁻¹, residuals and leverage; the rest follows in double.
/// False when the columns are collinear.
bool solve(const Design& design, const Vector& response, Ols& out) {
  const Eigen::Index first = design.intercept ? 1 : 0, n = response.size();
  const Scaled s = scaled(design, response);
  const Eigen::Index k = s.z.cols();
  ExtendedVector b = ExtendedVector::Zero(k + first);
  ExtendedMatrix unscaled = ExtendedMatrix::Zero(k + first, k + first);
  ExtendedVector leverage = ExtendedVector::Constant(n, first ? Real(1) / Real(n) : Real(0));
  ExtendedVector residuals = s.y;
  if (k > 0) {
    const Eigen::ColPivHouseholderQR<ExtendedMatrix> qr(s.z);
    if (qr.matrixR().diagonal().cwiseAbs().minCoeff() < kDependence) return false;
    const ExtendedVector g = qr.solve(s.y);
    residuals -= s.z * g;
    const ExtendedMatrix r_inverse =
        qr.matrixR().topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(
            ExtendedMatrix::Identity(k, k));
    const ExtendedMatrix root =
        s.scales.cwiseInverse().asDiagonal() * (qr.colsPermutation() * r_inverse).eval();
    b.tail(k) = g.cwiseQuotient(s.scales);
    unscaled.bottomRightCorner(k, k) = root * root.transpose();
    leverage += (s.z * (qr.colsPermutation() * r_inverse).eval()).rowwise().squaredNorm();
    if (first) {
      b[0] = s.y_mean - s.means.dot(b.tail(k));
      const ExtendedVector cross = unscaled.bottomRightCorner(k, k) * s.means;
      unscaled.col(0).tail(k) = -cross;
      unscaled.row(0).tail(k) = -cross.transpose();
      unscaled(0, 0) = (root.transpose() * s.means).squaredNorm();
    }
  } else {
    b[0] = s.y_mean;
  }
  if (first) unscaled(0, 0) += Real(1) / Real(n);
  out.coefficients = b.cast<double>();
  out.unscaled_covariance = unscaled.cast<double>();
  out.leverage = leverage.cast<double>();
  out.residuals = residuals.cast<double>();
  add_model(residuals.squaredNorm(), s.y.squaredNorm(), k, n - k - first, out);
  return true;
}

/// The same for very many rows. False: too near to collinear for it, or not of full rank.
bool solve_in_blocks(const Design& design, const Vector& response, Ols& out) {
  const auto blocks = BlockLeastSquares::make(design, response);
  if (!blocks) return false;
  const auto fit = blocks->solve(nullptr);
  if (!fit) return false;
  out.coefficients = fit->coefficients;
  out.unscaled_covariance = fit->unscaled_covariance;
  blocks->residuals_and_leverage(*fit, out.residuals, out.leverage);
  const Eigen::Index k = design.columns.cols() - (design.intercept ? 1 : 0);
  add_model(out.residuals.squaredNorm(), blocks->total_sum_of_squares(), k,
            response.size() - design.columns.cols(), out);
  return true;
}

void add_tests(Ols& fit) {
  const Eigen::Index p = fit.coefficients.size();
  fit.standard_errors = fit.sigma * fit.unscaled_covariance.diagonal().cwiseSqrt();
  fit.t = fit.coefficients.cwiseQuotient(fit.standard_errors);
  fit.p.resize(p);
  for (Eigen::Index j = 0; j < p; ++j) fit.p[j] = student_t_two_sided(fit.t[j], fit.df_residual);
  const double reach = student_t_quantile(0.975, fit.df_residual);
  fit.ci_low = fit.coefficients - reach * fit.standard_errors;
  fit.ci_high = fit.coefficients + reach * fit.standard_errors;
  fit.f_p = fit.f_df1 > 0.0 ? f_upper(fit.f, fit.f_df1, fit.df_residual) : kNaN;
  const double n = static_cast<double>(fit.residuals.size());
  fit.log_likelihood = -0.5 * n * (std::log(2.0 * M_PI) + std::log(fit.rss / n) + 1.0);
  const double parameters = static_cast<double>(p) + 1.0;
  fit.aic = -2.0 * fit.log_likelihood + 2.0 * parameters;
  fit.bic = -2.0 * fit.log_likelihood + std::log(n) * parameters;
}

/// Is s² (XᵀX)⁻¹ within a double? Scales of x and y that both are may be too far apart.
bool covariance_fits(const Ols& fit) {
  const Eigen::ArrayXd variance =
      (fit.sigma * fit.sigma) * fit.unscaled_covariance.diagonal().array();
  return variance.isFinite().all() && (fit.rss == 0.0 || variance.minCoeff() > 1e-300);
}

}  // namespace

core::Result<Ols> ols(const Design& design, const Vector& response) {
  TRY(check_shape(design, response));
  Ols fit;
  fit.names = design.names;
  fit.df_residual = static_cast<double>(response.size() - design.columns.cols());
  // Blocks need every number finite and a response that varies, and say so themselves.
  if (!is_large(design) || !solve_in_blocks(design, response, fit)) {
    TRY(check(design, response));
    if (!solve(design, response, fit)) return collinear_error(design);
  }
  if (!fit.coefficients.allFinite() || !fit.unscaled_covariance.allFinite() ||
      !std::isfinite(fit.rss) || !(fit.unscaled_covariance.diagonal().minCoeff() > 0.0) ||
      !covariance_fits(fit))
    return core::Error{core::Errc::out_of_range,
                       "the numbers are too large or too small for sums of squares: rescale them"};
  add_tests(fit);
  return fit;
}

Influence influence(const Ols& fit) {
  const auto h = fit.leverage.array();
  const auto r = fit.residuals.array();
  const double df = fit.df_residual, p = static_cast<double>(fit.coefficients.size());
  const double s2 = fit.sigma * fit.sigma;
  Influence out;
  out.standardised = r / (fit.sigma * (1.0 - h).sqrt());
  const Eigen::ArrayXd without = (df * s2 - r.square() / (1.0 - h)) / (df - 1.0);
  out.studentised = r / (without * (1.0 - h)).sqrt();
  out.cooks_distance = out.standardised.array().square() * h / ((1.0 - h) * p);
  out.dffits = out.studentised.array() * (h / (1.0 - h)).sqrt();
  return out;
}

Vector hc3_standard_errors(const Design& design, const Ols& fit) {
  const Eigen::ArrayXd weights = (fit.residuals.array() / (1.0 - fit.leverage.array())).abs();
  const Matrix root = weights.matrix().asDiagonal() * design.columns * fit.unscaled_covariance;
  return root.colwise().norm().transpose();
}

}  // namespace statistics
}  // namespace tractus
