#include "statistics/mixed/mixed_model.hpp"

#include <cmath>
#include <numbers>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/mixed/derivatives.hpp"
#include "statistics/mixed/penalised.hpp"

namespace tractus {
namespace statistics {
namespace {

using core::Errc;
using core::Error;

constexpr double kThetaStep = 2e-3;  // of differences in θ, whose entries are of order 1

/// The criterion of given data as a function of θ.
class ProfiledCriterion {
 public:
  ProfiledCriterion(const Design& design, const Vector& y, const std::vector<RandomTerm>& terms)
      : squares_(design.columns, terms), centre_(design.intercept ? y.mean() : 0.0) {
    squares_.observe(y.array() - centre_);
  }

  const PenalisedLeastSquares& squares() const { return squares_; }
  double centre() const { return centre_; }  ///< taken from the response
  double df(Likelihood how) const {
    const auto n = squares_.rows();
    return double(how == Likelihood::reml ? n - squares_.column_scale().size() : n);
  }
  Penalised solve(const Vector& theta) const {
    return squares_.solve(theta, PenalisedLeastSquares::Want::criterion);
  }
  Penalised everything(const Vector& theta) const {
    return squares_.solve(theta, PenalisedLeastSquares::Want::everything);
  }
  double criterion(const Vector& theta, Likelihood how) const {
    const Penalised at = solve(theta);
    const double left = df(how);
    const double out =
        at.log_det_L + left * (1.0 + std::log(2.0 * std::numbers::pi * at.rss / left));
    return how == Likelihood::reml ? out + at.log_det_RX : out;
  }

 private:
  PenalisedLeastSquares squares_;
  double centre_ = 0.0;
};

/// A variance at 0 may be a local minimum: θ² is tried at some sizes there.
Vector least(const ProfiledCriterion& problem, Likelihood how, const ScalarField& f,
             bool& converged) {
  Minimum best = minimise(f, problem.squares().start(), kThetaStep);
  for (Eigen::Index i = 0; i < best.x.size(); ++i) {
    if (std::abs(best.x[i]) > 1e-3) continue;
    for (const double size : {0.03, 0.3}) {
      Vector from = best.x;
      from[i] = size;
      if (problem.criterion(from, how) < best.value - 1e-8) {
        const Minimum again = minimise(f, from, kThetaStep);
        if (again.value < best.value) best = again;
      }
    }
  }
  converged = best.converged;
  return best.x;
}

void add_random(const ProfiledCriterion& problem, const Vector& theta, const Penalised& at,
                MixedModel& out) {
  Eigen::Index place = 0;
  for (std::size_t t = 0; t < at.effects.size(); ++t) {
    const ScaledTerm& term = problem.squares().terms()[t];
    RandomPart part =
        random_part(term, triangle(term, theta, place), at.effects[t], out.sigma_squared);
    out.singular = out.singular || part.singular;
    out.random.push_back(std::move(part));
  }
}

Matrix unscaled_covariance(const ProfiledCriterion& problem, const Penalised& at) {
  const auto inverse = problem.squares().column_scale().cwiseInverse();
  return inverse.asDiagonal() * at.covariance * inverse.asDiagonal();
}

/// Hessian of the criterion in (θ, σ), not profiled: ln|L|² (+ ln|R_X|²) + r²/σ² + df ln(2πσ²).
void add_curvature(const ProfiledCriterion& problem, Likelihood how, const Vector& theta,
                   MixedModel& out) {
  const auto m = theta.size();
  const double sigma2 = out.sigma_squared, sigma = std::sqrt(sigma2), df = problem.df(how);
  const auto fixed_sigma = [&](const Vector& at) {
    const Penalised here = problem.solve(at);
    return here.log_det_L + (how == Likelihood::reml ? here.log_det_RX : 0.0) + here.rss / sigma2;
  };
  const auto rss = [&](const Vector& at) { return problem.solve(at).rss; };
  Matrix hessian(m + 1, m + 1);
  hessian.topLeftCorner(m, m) = numeric_hessian(fixed_sigma, theta, 4.0 * kThetaStep);
  const Vector cross = -2.0 / (sigma2 * sigma) * numeric_gradient(rss, theta, kThetaStep);
  hessian.col(m).head(m) = cross;
  hessian.row(m).head(m) = cross.transpose();
  hessian(m, m) = 6.0 * rss(theta) / (sigma2 * sigma2) - 2.0 * df / sigma2;
  out.parameter_covariance = twice_inverse(hessian);
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto covariance_at = [&](double shift) {
      Vector at = theta;
      at[i] += shift;
      return Matrix(sigma2 * unscaled_covariance(problem, problem.everything(at)));
    };
    const double h = kThetaStep;
    out.covariance_slope.push_back((covariance_at(-2 * h) - 8.0 * covariance_at(-h) +
                                    8.0 * covariance_at(h) - covariance_at(2 * h)) /
                                   (12.0 * h));
  }
  out.covariance_slope.push_back(2.0 / sigma * out.covariance);
}

void add_tests(MixedModel& out) {
  out.standard_errors = out.covariance.diagonal().cwiseSqrt();
  out.t = out.coefficients.cwiseQuotient(out.standard_errors);
  out.df.resize(out.t.size());
  out.p.resize(out.t.size());
  for (Eigen::Index j = 0; j < out.t.size(); ++j) {
    out.df[j] = mixed_df(out, Vector::Unit(out.t.size(), j));
    out.p[j] = student_t_two_sided(out.t[j], out.df[j]);
  }
}

}  // namespace

core::Result<MixedModel> mixed_model(const Design& design, const Vector& response,
                                     const std::vector<RandomTerm>& terms, Likelihood likelihood,
                                     const core::Progress& progress) {
  TRY(check_terms(terms, response.size(), double(response.size())));
  TRY(check(design, response));
  if (!collinear_columns(design).empty()) return collinear_error(design);
  const ProfiledCriterion problem(design, response, terms);
  bool stopped = false;
  int evaluations = 0;
  const ScalarField f = [&](const Vector& theta) {
    if (progress && !stopped) stopped = !progress(1.0 - 1.0 / (1.0 + 0.01 * ++evaluations));
    return stopped ? std::numeric_limits<double>::quiet_NaN()
                   : problem.criterion(theta, likelihood);
  };
  MixedModel out;
  const Vector theta = least(problem, likelihood, f, out.converged);
  if (stopped) return Error{Errc::cancelled, "stopped"};
  const Penalised at = problem.everything(theta);
  out.names = design.names;
  out.sigma_squared = at.rss / problem.df(likelihood);
  out.criterion = problem.criterion(theta, likelihood);
  out.covariance = out.sigma_squared * unscaled_covariance(problem, at);
  out.coefficients = at.beta.cwiseQuotient(problem.squares().column_scale());
  if (design.intercept) out.coefficients[0] += problem.centre();
  out.parameters = int(out.coefficients.size() + theta.size()) + 1;
  if (!std::isfinite(out.criterion) || !out.covariance.allFinite() || !(out.sigma_squared > 0.0))
    return Error{Errc::out_of_range,
                 "the numbers leave no residual, or are too large or too small: rescale them"};
  add_random(problem, theta, at, out);
  add_curvature(problem, likelihood, theta, out);
  add_tests(out);
  return out;
}

double mixed_df(const MixedModel& fit, const Vector& contrast) {
  const double variance = contrast.dot(fit.covariance * contrast);
  Vector gradient(Eigen::Index(fit.covariance_slope.size()));
  for (std::size_t k = 0; k < fit.covariance_slope.size(); ++k)
    gradient[Eigen::Index(k)] = contrast.dot(fit.covariance_slope[k] * contrast);
  return 2.0 * variance * variance / gradient.dot(fit.parameter_covariance * gradient);
}

JointTest joint_test(const MixedModel& fit, const std::vector<Eigen::Index>& columns) {
  return joint_test_by_contrasts(fit.coefficients, fit.covariance, columns,
                                 [&](const Vector& contrast) { return mixed_df(fit, contrast); });
}

}  // namespace statistics
}  // namespace tractus
