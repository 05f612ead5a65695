/// Laplace's approximation of a logistic mixed model's likelihood, as lme4's glmer has it with
/// nAGQ = 1 [Bates2015], [Breslow1993]:
///
///     logit π = X β + Z Λ u,  u ~ N(0, I),  y ~ Binomial(m, π)
///     d(θ, β) = −2 ln p(y | û, β) + |û|² + ln|L|²,   L Lᵀ = Λᵀ Zᵀ W Z Λ + I,  W = m π (1 − π) at û
///
/// û, the conditional mode of u, is found by penalised iteratively reweighted least squares, that is
/// Newton's method, with halved steps: the working response η + (y − m π)/W and the weights W go
/// through PenalisedLeastSquares. The gradient of d is analytic: with r = y − m π, h of
/// LogDeterminantSlope, g = h dW/dη, q = (L Lᵀ)⁻¹ Λᵀ Zᵀ g (which follows how û moves) and
/// ρ = g − 2 r − W Z Λ q,
///
///     dd/dβ = Xᵀ ρ,   dd/dθ = Σ_levels (Zᵀρ uᵀ + Zᵀr qᵀ) + d ln|L|²/dθ at these weights
#pragma once

#include <optional>

#include "statistics/mixed/penalised.hpp"
#include "statistics/regression/logistic.hpp"

namespace tractus::statistics {

/// θ and β are in units of the scaled columns (PenalisedLeastSquares).
class LaplaceDeviance {
 public:
  /// `counts` and `terms` are referred to as long as this lives.
  LaplaceDeviance(const Matrix& x, const Counts& counts, const std::vector<RandomTerm>& terms);

  /// d(θ, β), with binomial coefficients. NaN where no mode was found.
  double value(const Vector& theta, const Vector& beta);
  struct Gradient {
    Vector theta, beta;
  };
  Gradient gradient(const Vector& theta, const Vector& beta);

  /// β with u at the joint mode of both at one θ, where glmer starts (nAGQ = 0), and its covariance.
  struct Start {
    Vector beta;
    Matrix covariance;
  };
  std::optional<Start> joint_mode(const Vector& theta);

  /// Λ û per term at the point that was evaluated last, [level][effect].
  std::vector<Matrix> effects(const Vector& theta) const;
  const PenalisedLeastSquares& squares() const { return squares_; }

 private:
  using Array = Eigen::ArrayXd;
  struct Mode {
    Vector beta;
    std::vector<Matrix> u;
    Array eta, pi;
    double objective = 0.0;  // −2 ln p(y | u, β) without binomial coefficients, + |u|²
  };

  Mode mode_of(const Vector& theta, Vector beta, std::vector<Matrix> u) const;
  void complete(Mode& mode) const;
  Vector weights(const Mode& at) const;
  Penalised weighted_step(const Vector& theta, const Mode& from, bool with_beta);
  bool climb(const Vector& theta, Mode& at, bool with_beta, Penalised& last);
  bool find(const Vector& theta, const Vector& beta);
  void add_effects(const Vector& theta, const std::vector<Matrix>& u, Array& eta) const;
  void add_slopes(const Vector& rows, const std::vector<Matrix>& of_levels, Vector& theta) const;

  const Counts& counts_;
  Matrix x_;  // scaled
  PenalisedLeastSquares squares_;
  double binomial_ = 0.0;  // −2 ln of the binomial coefficients
  Mode mode_;              // where the last search ended
  Vector theta_;           // of that search; empty: it found no mode of u alone
  double log_det_ = 0.0;   // ln|L|² there
};

}  // namespace tractus::statistics
