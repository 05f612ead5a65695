#include "statistics/regression/logistic.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "core/try.hpp"
#include "statistics/distributions/binomial.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

using Array = Eigen::ArrayXd;
constexpr int kNewtonLimit = 60;

core::Result<void> check_counts(const Design& design, const Counts& counts) {
  core::require(design.columns.rows() == counts.successes.size() &&
                    counts.successes.size() == counts.trials.size(),
                "a design has one row per count");
  const auto wrong = [](std::string what) {
    return core::Error{core::Errc::bad_input, std::move(what)};
  };
  for (Eigen::Index i = 0; i < counts.successes.size(); ++i) {
    const double y = counts.successes[i], m = counts.trials[i];
    if (!(m >= 1.0 && y >= 0.0 && y <= m && std::floor(y) == y && std::floor(m) == m))
      return wrong(fmt::format("row {}: {} of {} is not a count of successes", i + 1, y, m));
    if (!design.columns.row(i).allFinite())
      return wrong(fmt::format("row {}: a column is not a finite number", i + 1));
  }
  if (design.columns.rows() < design.columns.cols())
    return wrong(fmt::format("{} row(s) cannot determine {} coefficients", design.columns.rows(),
                             design.columns.cols()));
  const double sum = counts.successes.sum();
  if (sum == 0.0 || sum == counts.trials.sum())
    return wrong("every outcome is the same: there is nothing to explain");
  for (Eigen::Index j = 0; j < design.columns.cols(); ++j)
    TRY(check_range(design.columns.col(j),
                    "column '" + design.names[static_cast<std::size_t>(j)] + "'"));
  if (!collinear_columns(design).empty()) return collinear_error(design);
  return {};
}

/// Σ y η − m ln(1 + e^η): the log-likelihood without binomial coefficients.
double kernel(const Counts& c, const Array& eta) {
  Array pi, softplus;
  binomial::parts(eta, pi, softplus);
  return (c.successes.array() * eta - c.trials.array() * softplus).sum();
}

Matrix information(const Matrix& x, const Counts& c, const Array& pi) {
  const Vector w = c.trials.array() * pi * (1.0 - pi);
  return x.transpose() * w.asDiagonal() * x;
}

/// Newton's method for η = X b + offset. False: no finite maximum was reached.
bool newton(const Matrix& x, const Counts& c, const Array& offset, Vector& b, int& iterations) {
  double last = kernel(c, (x * b).array() + offset);
  for (iterations = 1; iterations <= kNewtonLimit; ++iterations) {
    const Array pi = binomial::inverse_logit((x * b).array() + offset);
    const Vector score = x.transpose() * (c.successes.array() - c.trials.array() * pi).matrix();
    const Eigen::LDLT<Matrix> ldlt(information(x, c, pi));
    if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 0.0)) return false;
    Vector step = ldlt.solve(score);
    if (!step.allFinite()) return false;
    double now = kernel(c, (x * (b + step)).array() + offset);
    for (int halving = 0; now < last - 1e-12 * std::abs(last) && halving < 30; ++halving) {
      step *= 0.5;
      now = kernel(c, (x * (b + step)).array() + offset);
    }
    b += step;
    last = now;
    const double reach = (x * step).cwiseAbs().maxCoeff();
    if (reach < 1e-13 * (1.0 + (x * b).cwiseAbs().maxCoeff())) return true;
    if ((x * b).cwiseAbs().maxCoeff() > 1e3) return false;
  }
  // The last digits may flicker; what keeps growing is separation.
  const Array pi = binomial::inverse_logit((x * b).array() + offset);
  const Vector score = x.transpose() * (c.successes.array() - c.trials.array() * pi).matrix();
  const Vector step = information(x, c, pi).ldlt().solve(score);
  return step.allFinite() && (x * step).cwiseAbs().maxCoeff() < 1e-9;
}

/// 2 Σ y ln(y/ŷ) + (m − y) ln((m − y)/(m − ŷ)), terms with a count of 0 being 0.
double deviance_of(const Counts& c, const Array& pi) {
  const auto term = [](double count, double fitted) {
    return count > 0.0 ? count * std::log(count / fitted) : 0.0;
  };
  double sum = 0.0;
  for (Eigen::Index i = 0; i < pi.size(); ++i) {
    const double y = c.successes[i], m = c.trials[i];
    sum += term(y, m * pi[i]) + term(m - y, m * (1.0 - pi[i]));
  }
  return 2.0 * sum;
}

/// Wald tests from coefficients and their covariance.
template <class Fit>
void add_wald(const Matrix& covariance, Fit& fit) {
  fit.standard_errors = covariance.diagonal().cwiseSqrt();
  fit.z = fit.coefficients.cwiseQuotient(fit.standard_errors);
  fit.p = fit.z.unaryExpr([](double z) { return 2.0 * normal_upper(std::abs(z)); });
  const double reach = normal_quantile(0.975);
  fit.ci_low = fit.coefficients - reach * fit.standard_errors;
  fit.ci_high = fit.coefficients + reach * fit.standard_errors;
}

core::Error separated() {
  return {core::Errc::out_of_range,
          "the columns separate the outcomes, so no finite maximum exists: use Firth's estimate"};
}

}  // namespace

core::Result<Logistic> logistic(const Design& design, const Counts& counts) {
  TRY(check_counts(design, counts));
  const Matrix& x = design.columns;
  Logistic fit;
  fit.names = design.names;
  fit.coefficients = Vector::Zero(x.cols());
  const auto alike = binomial::merged(x, counts);
  const Matrix& rows = alike ? alike->columns : x;
  const Counts& sums = alike ? alike->counts : counts;
  if (!newton(rows, sums, Array::Zero(rows.rows()), fit.coefficients, fit.iterations))
    return separated();
  const Array eta = x * fit.coefficients, pi = binomial::inverse_logit(eta);
  fit.fitted = pi;
  fit.covariance = information(x, counts, pi).ldlt().solve(Matrix::Identity(x.cols(), x.cols()));
  add_wald(fit.covariance, fit);
  fit.deviance = deviance_of(counts, pi);
  const double share = counts.successes.sum() / counts.trials.sum();
  fit.null_deviance =
      deviance_of(counts, Array::Constant(x.rows(), design.intercept ? share : 0.5));
  fit.log_likelihood = kernel(counts, eta) + binomial::log_coefficients(counts);
  fit.aic = -2.0 * fit.log_likelihood + 2.0 * static_cast<double>(x.cols());
  fit.lr_df = static_cast<double>(x.cols() - (design.intercept ? 1 : 0));
  fit.lr_chi_squared = std::max(0.0, fit.null_deviance - fit.deviance);
  fit.lr_p = fit.lr_df > 0.0 ? chi_squared_upper(fit.lr_chi_squared, fit.lr_df) : 1.0;
  fit.df_residual = static_cast<double>(x.rows() - x.cols());
  const Array expected = counts.trials.array() * pi;
  fit.dispersion =
      ((counts.successes.array() - expected).square() / (expected * (1.0 - pi))).sum() /
      fit.df_residual;
  return fit;
}

core::Result<std::pair<double, double>> profile_interval(const Design& design, const Counts& counts,
                                                         const Logistic& fit, Eigen::Index j) {
  const Eigen::Index p = design.columns.cols();
  core::require(j >= 0 && j < p, "a profile is of one of the coefficients");
  const auto alike = binomial::merged(design.columns, counts);
  const Matrix& x = alike ? alike->columns : design.columns;
  const Counts& sums = alike ? alike->counts : counts;
  Matrix rest(x.rows(), p - 1);
  rest << x.leftCols(j), x.rightCols(p - 1 - j);
  const Vector column = x.col(j);
  const double top = kernel(sums, x * fit.coefficients);
  const double drop = 0.5 * chi_squared_quantile_upper(0.05, 1.0);
  std::array<double, 2> ends{};
  for (const int side : {-1, 1}) {
    double b = fit.coefficients[j] + side * 1.96 * fit.standard_errors[j];
    Vector others(p - 1);
    others << fit.coefficients.head(j), fit.coefficients.tail(p - 1 - j);
    bool done = false;
    for (int i = 0; i < 100 && !done; ++i) {
      const Array offset = b * column;
      int spent = 0;
      if (p > 1 && !newton(rest, sums, offset, others, spent)) return separated();
      const Array eta = (rest * others).array() + offset;
      // d(profile)/db is the score of b where the others are at their best.
      const double slope = column.dot(
          (sums.successes.array() - sums.trials.array() * binomial::inverse_logit(eta)).matrix());
      const double step = (top - kernel(sums, eta) - drop) / slope;
      if (!std::isfinite(step) || side * slope >= 0.0) return separated();
      b += step;
      // The likelihood itself is only so sharp: of very many rows its last digits are rounding.
      done = std::abs(step) < 1e-13 * (1.0 + std::abs(b)) ||
             std::abs(step * slope) < 1e-14 * std::abs(top);
    }
    ends[side < 0 ? 0 : 1] = b;
  }
  return std::pair{ends[0], ends[1]};
}

QuasiBinomial quasi_binomial(const Logistic& fit) {
  QuasiBinomial out;
  out.standard_errors = fit.standard_errors * std::sqrt(fit.dispersion);
  out.t = fit.coefficients.cwiseQuotient(out.standard_errors);
  out.p = out.t.unaryExpr([&](double t) { return student_t_two_sided(t, fit.df_residual); });
  return out;
}

core::Result<Firth> firth_logistic(const Design& design, const Counts& counts) {
  TRY(check_counts(design, counts));
  const Matrix& x = design.columns;
  Firth fit;
  fit.names = design.names;
  fit.coefficients = Vector::Zero(x.cols());
  const auto penalised = [&](const Vector& b) {
    const Array eta = x * b;
    return kernel(counts, eta) + 0.5 * information(x, counts, binomial::inverse_logit(eta))
                                           .ldlt()
                                           .vectorD()
                                           .array()
                                           .log()
                                           .sum();
  };
  Matrix covariance;
  bool settled = false;
  for (fit.iterations = 1; fit.iterations <= 1000 && !settled; ++fit.iterations) {
    const Array pi = binomial::inverse_logit((x * fit.coefficients).array());
    covariance = information(x, counts, pi).ldlt().solve(Matrix::Identity(x.cols(), x.cols()));
    const Array w = counts.trials.array() * pi * (1.0 - pi);
    const Array h = w * (x * covariance).cwiseProduct(x).rowwise().sum().array();
    const Vector score =
        x.transpose() *
        (counts.successes.array() - counts.trials.array() * pi + h * (0.5 - pi)).matrix();
    Vector step = covariance * score;
    const double before = penalised(fit.coefficients);
    for (int halving = 0; halving < 30; ++halving, step *= 0.5) {
      const double now = penalised(fit.coefficients + step);
      if (now >= before - 1e-12 * std::abs(before)) break;
    }
    fit.coefficients += step;
    settled = step.cwiseAbs().maxCoeff() < 1e-14 * (1.0 + fit.coefficients.cwiseAbs().maxCoeff());
  }
  if (!fit.coefficients.allFinite() || !covariance.allFinite())
    return core::Error{core::Errc::out_of_range, "the information matrix is singular"};
  fit.penalised_log_likelihood = penalised(fit.coefficients);
  fit.fitted = binomial::inverse_logit((x * fit.coefficients).array());
  add_wald(covariance, fit);
  return fit;
}

}  // namespace statistics
}  // namespace tractus
