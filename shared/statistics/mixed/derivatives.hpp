/// Derivatives of a smooth function by central differences of fourth order.
#pragma once

#include <functional>

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

using ScalarField = std::function<double(const Vector&)>;

/// df/dx_i = (f(−2h) − 8 f(−h) + 8 f(h) − f(2h)) / 12h, error of order h⁴.
Vector numeric_gradient(const ScalarField& f, const Vector& x, double step);
/// Second derivatives: on the diagonal by five points; off it by four corners with steps h and 2h,
/// extrapolated (Richardson), error of order h⁴.
Matrix numeric_hessian(const ScalarField& f, const Vector& x, double step);

/// Twice the inverse of a Hessian of −2 ln likelihood: the covariance of its parameters. Directions
/// of no or negative curvature have none.
Matrix twice_inverse(const Matrix& hessian);

using VectorField = std::function<Vector(const Vector&)>;

/// d g_i/dx_j by the differences of numeric_gradient(), made symmetric: the second derivatives of a
/// function whose gradient is g.
Matrix hessian_of_gradient(const VectorField& gradient, const Vector& x, double step);

struct Minimum {
  Vector x;
  double value = 0.0;
  /// At x, or within 1e-5 of it, where it converged and the gradient is known.
  Matrix hessian;
  bool converged = false;
};

/// A minimum of a smooth function without bounds: BFGS with a backtracking line search
/// [Nocedal2006, algorithm 6.1], then Newton's steps on numeric second derivatives. `step`: of the
/// differences. Ends where no step lowers the value, or after `most_steps`.
Minimum minimise(const ScalarField& f, const Vector& start, double step, int most_steps = 200);

/// The same of a function whose gradient is known; second derivatives by differences of that.
Minimum minimise(const ScalarField& f, const VectorField& gradient, const Vector& start,
                 double step, int most_steps = 200);

}  // namespace tractus::statistics
