#include "statistics/learning/learning_curve.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

constexpr double kLeastRate = 1e-4, kMostRate = 20.0;
constexpr int kRates = 120;

struct Data {
  Eigen::ArrayXd n;
  Vector y;
  CurveShape shape;

  bool has_plateau() const { return shape != CurveShape::power; }
  /// What b multiplies in the exponent of the falling part: −ln n, or 1 − n.
  Eigen::ArrayXd exponent =
      shape == CurveShape::exponential_plateau ? Eigen::ArrayXd(1.0 - n) : Eigen::ArrayXd(-n.log());
  /// The falling part at rate b, 1 at the first trial.
  Eigen::ArrayXd falling(double b) const { return (b * exponent).exp(); }
  Vector residuals(const Vector& abc) const {
    return y.array() - abc[0] * falling(abc[1]) - (has_plateau() ? abc[2] : 0.0);
  }
  Matrix jacobian(const Vector& abc) const {
    Matrix out(n.size(), has_plateau() ? 3 : 2);
    out.col(0) = falling(abc[1]);
    out.col(1) = abc[0] * falling(abc[1]) * exponent;
    if (has_plateau()) out.col(2).setOnes();
    return out;
  }
};

/// The best coefficients over a logarithmic grid of rates; b at the grid's end means no curve.
bool search(const Data& data, Vector& best) {
  double least = std::numeric_limits<double>::infinity();
  int at = 0;
  const double centre = data.has_plateau() ? data.y.mean() : 0.0;
  const Eigen::ArrayXd y = data.y.array() - centre;
  for (int i = 0; i <= kRates; ++i) {
    const double b = kLeastRate * std::pow(kMostRate / kLeastRate, i / double(kRates));
    Eigen::ArrayXd f = data.falling(b);
    const double middle = data.has_plateau() ? f.mean() : 0.0;
    f -= middle;
    const double a = (f * y).sum() / f.square().sum(), rss = (y - a * f).square().sum();
    if (!(rss < least)) continue;
    least = rss;
    at = i;
    best.resize(data.has_plateau() ? 3 : 2);
    best[0] = a;
    best[1] = b;
    if (data.has_plateau()) best[2] = centre - a * middle;
  }
  return at > 0 && at < kRates;
}

/// Gauss–Newton with halving; ends when steps are rounding.
void polish(const Data& data, Vector& abc) {
  for (int i = 0; i < 200; ++i) {
    const Vector r = data.residuals(abc);
    Vector step = data.jacobian(abc).colPivHouseholderQr().solve(r);
    for (int halving = 0; halving < 40; ++halving, step *= 0.5)
      if (data.residuals(abc + step).squaredNorm() <= r.squaredNorm() * (1.0 + 1e-14)) break;
    abc += step;
    if ((step.array().abs() <= 1e-14 * abc.array().abs()).all()) return;
  }
}

void add_tests(const Data& data, LearningCurve& fit) {
  const double n = static_cast<double>(data.y.size());
  const double parameters = static_cast<double>(fit.coefficients.size()) + 1.0;
  fit.df = n - parameters + 1.0;
  fit.rss = data.residuals(fit.coefficients).squaredNorm();
  fit.sigma = std::sqrt(fit.rss / fit.df);
  const Matrix j = data.jacobian(fit.coefficients);
  const Matrix inverse = (j.transpose() * j).inverse();
  fit.standard_errors = fit.sigma * inverse.diagonal().cwiseSqrt();
  fit.t = fit.coefficients.cwiseQuotient(fit.standard_errors);
  fit.p = fit.t.unaryExpr([&](double t) { return student_t_two_sided(t, fit.df); });
  fit.log_likelihood = -0.5 * n * (std::log(2.0 * M_PI * fit.rss / n) + 1.0);
  fit.aic = -2.0 * fit.log_likelihood + 2.0 * parameters;
  fit.aicc = fit.aic + 2.0 * parameters * (parameters + 1.0) / (n - parameters - 1.0);
  fit.bic = -2.0 * fit.log_likelihood + std::log(n) * parameters;
}

}  // namespace

core::Result<LearningCurve> learning_curve(const Vector& trial, const Vector& score,
                                           CurveShape shape) {
  core::require(trial.size() == score.size(), "every trial has its score");
  const auto wrong = [](const char* what) { return core::Error{core::Errc::bad_input, what}; };
  const Data data{trial.array(), score, shape};
  if (trial.size() < (data.has_plateau() ? 6 : 5))
    return wrong("a learning curve needs at least 5 trials, 6 with a plateau");
  if (!trial.allFinite() || !score.allFinite() || !(trial.minCoeff() > 0.0))
    return wrong("trials are numbered from 1, scores are finite");
  TRY(check_range(score, "the score"));
  if (score.maxCoeff() == score.minCoeff()) return wrong("every score is the same: no curve");
  LearningCurve fit;
  fit.names = data.has_plateau() ? std::vector<std::string>{"a", "b", "c"}
                                 : std::vector<std::string>{"a", "b"};
  const bool inside = search(data, fit.coefficients);
  if (inside) polish(data, fit.coefficients);
  if (!inside || !fit.coefficients.allFinite() || !(fit.coefficients[1] > 0.0))
    return core::Error{core::Errc::out_of_range, "the scores show no curve of this shape"};
  add_tests(data, fit);
  return fit;
}

double share_per_doubling(const LearningCurve& power) { return std::exp2(-power.coefficients[1]); }

}  // namespace statistics
}  // namespace tractus
