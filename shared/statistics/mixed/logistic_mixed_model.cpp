#include "statistics/mixed/logistic_mixed_model.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/mixed/derivatives.hpp"
#include "statistics/mixed/laplace.hpp"

namespace tractus {
namespace statistics {
namespace {

constexpr double kDifferenceStep = 0.01;  // of differences; about that many standard errors
// A standard deviation beyond it is a variance that runs away; so is a lesser one without a minimum.
constexpr double kMostLogit = 1e3, kMostUnsettled = 10.0;

/// The deviance in coordinates of about one standard error each: θ = spread · x of θ,
/// β = β₀ + R · x of β.
class ScaledDeviance {
 public:
  ScaledDeviance(LaplaceDeviance& deviance, const LaplaceDeviance::Start& start)
      : deviance_(deviance),
        beta_(start.beta),
        root_(Eigen::LLT<Matrix>(start.covariance).matrixL()) {
    const auto& squares = deviance.squares();
    spread_.resize(squares.start().size());
    Eigen::Index at = 0;
    for (const auto& term : squares.terms())
      for (Eigen::Index i = 0; i < term.parameters(); ++i)
        spread_[at++] = 1.0 / std::sqrt(double(term.levels.size()));
  }

  Vector start() const {
    Vector out = Vector::Zero(spread_.size() + beta_.size());
    out.head(spread_.size()) = deviance_.squares().start().cwiseQuotient(spread_);
    return out;
  }
  Vector theta(const Vector& x) const { return x.head(spread_.size()).cwiseProduct(spread_); }
  Vector beta(const Vector& x) const { return beta_ + root_ * x.tail(beta_.size()); }
  double value(const Vector& x) const { return deviance_.value(theta(x), beta(x)); }
  Vector gradient(const Vector& x) const {
    const auto at = deviance_.gradient(theta(x), beta(x));
    Vector out(x.size());
    out << at.theta.cwiseProduct(spread_), root_.transpose() * at.beta;
    return out;
  }
  /// Of β, from the Hessian in x.
  Matrix covariance(const Matrix& hessian) const {
    const auto p = beta_.size();
    return root_ * twice_inverse(hessian).bottomRightCorner(p, p) * root_.transpose();
  }
  const Vector& spread() const { return spread_; }

 private:
  LaplaceDeviance& deviance_;
  Vector beta_, spread_;
  Matrix root_;
};

/// A variance at 0 may be a local minimum: θ is tried at some sizes there.
Minimum least(const ScaledDeviance& problem, const ScalarField& f, const VectorField& gradient) {
  Minimum best = minimise(f, gradient, problem.start(), kDifferenceStep);
  for (Eigen::Index i = 0; i < problem.spread().size(); ++i) {
    if (std::abs(best.x[i] * problem.spread()[i]) > 1e-3) continue;
    for (const double size : {0.03, 0.3}) {
      Vector from = best.x;
      from[i] = size / problem.spread()[i];
      if (f(from) < best.value - 1e-8) {
        const Minimum again = minimise(f, gradient, from, kDifferenceStep);
        if (again.value < best.value) best = again;
      }
    }
  }
  return best;
}

void add_wald(LogisticMixedModel& out) {
  out.standard_errors = out.covariance.diagonal().cwiseSqrt();
  out.z = out.coefficients.cwiseQuotient(out.standard_errors);
  out.p = out.z.unaryExpr([](double z) { return 2.0 * normal_upper(std::abs(z)); });
  const double reach = normal_quantile(0.975);
  out.ci_low = out.coefficients - reach * out.standard_errors;
  out.ci_high = out.coefficients + reach * out.standard_errors;
}

void add_random(const LaplaceDeviance& deviance, const Vector& theta, LogisticMixedModel& out) {
  const std::vector<Matrix> effects = deviance.effects(theta);
  Eigen::Index place = 0;
  for (std::size_t t = 0; t < effects.size(); ++t) {
    const ScaledTerm& term = deviance.squares().terms()[t];
    RandomPart part = random_part(term, triangle(term, theta, place), effects[t], 1.0);
    out.singular = out.singular || part.singular;
    out.random.push_back(std::move(part));
  }
}

core::Error no_maximum() {
  return {core::Errc::out_of_range,
          "the likelihood has no maximum: the outcomes may be separated by the levels of a group"};
}

}  // namespace

core::Result<LogisticMixedModel> logistic_mixed_model(const Design& design, const Counts& counts,
                                                      const std::vector<RandomTerm>& terms,
                                                      const core::Progress& progress) {
  TRY(logistic(design, counts));  // refuses what no random term can help
  TRY(check_terms(terms, counts.trials.size(), counts.trials.sum()));
  LaplaceDeviance deviance(design.columns, counts, terms);
  const auto start = deviance.joint_mode(deviance.squares().start());
  if (!start) return no_maximum();
  const ScaledDeviance problem(deviance, *start);
  bool stopped = false, ran_away = false;
  int evaluations = 0;
  const auto go_on = [&](const Vector& x) {
    if (progress && !stopped) stopped = !progress(1.0 - 1.0 / (1.0 + 0.02 * ++evaluations));
    ran_away = ran_away || problem.theta(x).cwiseAbs().maxCoeff() > kMostLogit;
    return !stopped && !ran_away;
  };
  const ScalarField value = [&](const Vector& x) {
    return go_on(x) ? problem.value(x) : std::numeric_limits<double>::quiet_NaN();
  };
  const VectorField gradient = [&](const Vector& x) -> Vector {
    return go_on(x) ? problem.gradient(x) : Vector::Zero(x.size());
  };
  const Minimum at = least(problem, value, gradient);
  const Matrix covariance = problem.covariance(
      at.converged ? at.hessian : hessian_of_gradient(gradient, at.x, kDifferenceStep));
  if (stopped) return core::Error{core::Errc::cancelled, "stopped"};
  const Vector theta = problem.theta(at.x), beta = problem.beta(at.x);
  ran_away = ran_away || (!at.converged && theta.cwiseAbs().maxCoeff() > kMostUnsettled);
  if (ran_away || !std::isfinite(at.value) || !covariance.allFinite()) return no_maximum();
  const auto scale = deviance.squares().column_scale().cwiseInverse();
  LogisticMixedModel out;
  out.names = design.names;
  out.log_likelihood = -0.5 * deviance.value(theta, beta);
  out.coefficients = scale.cwiseProduct(beta);
  out.covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
  out.parameters = int(theta.size() + beta.size());
  out.aic = -2.0 * out.log_likelihood + 2.0 * out.parameters;
  out.converged = at.converged;
  add_random(deviance, theta, out);
  add_wald(out);
  return out;
}

}  // namespace statistics
}  // namespace tractus
