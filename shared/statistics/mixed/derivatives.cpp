#include "statistics/mixed/derivatives.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace tractus {
namespace statistics {
namespace {

constexpr int kMostNewton = 6;
// Second derivatives by differences of a known gradient are the same within this distance, about
// standard errors; those by differences of values are taken anew at each step.
constexpr double kSameCurvature = 1e-5;

/// f at x + Σ aᵢ eᵢ for up to two coordinates.
double shifted(const ScalarField& f, Vector x, Eigen::Index i, double a, Eigen::Index j = 0,
               double b = 0.0) {
  x[i] += a;
  x[j] += b;
  return f(x);
}

double mixed_difference(const ScalarField& f, const Vector& x, Eigen::Index i, Eigen::Index j,
                        double h) {
  return (shifted(f, x, i, h, j, h) - shifted(f, x, i, h, j, -h) - shifted(f, x, i, -h, j, h) +
          shifted(f, x, i, -h, j, -h)) /
         (4.0 * h * h);
}

/// The least that a value must fall by: what rounding leaves of it.
double noise(double value) { return 1e-14 * (1.0 + std::abs(value)); }

/// Halves the step until the value falls as the slope promises (Armijo). Nothing falls: false.
bool search_line(const ScalarField& f, const Vector& direction, double slope, Minimum& at) {
  for (double length = 1.0; length > 1e-10; length *= 0.5) {
    const Vector next = at.x + length * direction;
    const double value = f(next);
    if (!(value <= at.value + 1e-4 * length * slope - noise(at.value))) continue;
    at.x = next;
    at.value = value;
    return true;
  }
  return false;
}

struct Smooth {
  const ScalarField& value;
  VectorField gradient;
  std::function<Matrix(const Vector&)> hessian;
  double same_curvature = 0.0;  // distance within which second derivatives are not taken anew
};

void quasi_newton(const Smooth& f, int most_steps, Minimum& at) {
  const auto n = at.x.size();
  Matrix inverse = Matrix::Identity(n, n);
  Vector gradient = f.gradient(at.x);
  bool fresh = true;
  for (int k = 0; k < most_steps; ++k) {
    Vector direction = -inverse * gradient;
    const Vector before = at.x;
    if (!search_line(f.value, direction, gradient.dot(direction), at)) {
      if (fresh) return;
      inverse.setIdentity();
      fresh = true;
      continue;
    }
    const Vector s = at.x - before, next = f.gradient(at.x), y = next - gradient;
    gradient = next;
    const double sy = s.dot(y);
    if (!(sy > 1e-12 * s.norm() * y.norm())) continue;
    if (fresh) inverse *= sy / y.squaredNorm();  // [Nocedal2006, (6.20)]
    fresh = false;
    const Matrix left = Matrix::Identity(n, n) - s * y.transpose() / sy;
    inverse = left * inverse * left.transpose() + s * s.transpose() / sy;
  }
}

/// Newton's steps, on second derivatives that are taken anew after a long one only: they are most
/// of the work, and near the minimum hardly change. True where the last step was small: the minimum
/// is reached.
bool newton(const Smooth& f, Minimum& at) {
  double moved = std::numeric_limits<double>::infinity();  // since the second derivatives
  const auto curvature = [&] {
    if (moved <= f.same_curvature) return;
    at.hessian = f.hessian(at.x);
    moved = 0.0;
  };
  const auto reached = [&] {
    if (f.same_curvature > 0.0) curvature();
    return true;
  };
  for (int k = 0; k < kMostNewton; ++k) {
    const Vector gradient = f.gradient(at.x);
    curvature();
    const Eigen::LDLT<Matrix> hessian(at.hessian);
    if (hessian.info() != Eigen::Success || !hessian.isPositive()) return false;
    const Vector move = -hessian.solve(gradient);
    if (!move.allFinite()) return false;
    const double value = f.value(at.x + move);
    if (!(value <= at.value + 10.0 * noise(at.value))) {
      // So near the minimum the slope tells more than the value, which is a sum of many terms.
      if (!(move.norm() < 1e-5)) return false;
      at.x += move;
      moved += move.norm();
      return reached();
    }
    at.x += move;
    at.value = value;
    moved += move.norm();
    if (move.norm() < 1e-9 * (1.0 + at.x.norm())) return reached();
  }
  return reached();
}

Minimum minimum(const Smooth& f, const Vector& start, int most_steps) {
  Minimum at{start, f.value(start), {}, false};
  if (start.size() == 0) return at.converged = true, at;
  quasi_newton(f, most_steps, at);
  at.converged = newton(f, at);
  return at;
}

}  // namespace

Vector numeric_gradient(const ScalarField& f, const Vector& x, double step) {
  Vector out(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    out[i] = (shifted(f, x, i, -2 * step) - 8 * shifted(f, x, i, -step) +
              8 * shifted(f, x, i, step) - shifted(f, x, i, 2 * step)) /
             (12 * step);
  return out;
}

Matrix numeric_hessian(const ScalarField& f, const Vector& x, double step) {
  const auto n = x.size();
  const double centre = f(x);
  Matrix out(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    out(i, i) = (-shifted(f, x, i, -2 * step) + 16 * shifted(f, x, i, -step) - 30 * centre +
                 16 * shifted(f, x, i, step) - shifted(f, x, i, 2 * step)) /
                (12 * step * step);
    for (Eigen::Index j = 0; j < i; ++j)
      out(i, j) = out(j, i) =
          (4 * mixed_difference(f, x, i, j, step) - mixed_difference(f, x, i, j, 2 * step)) / 3;
  }
  return out;
}

Matrix twice_inverse(const Matrix& hessian) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(hessian);
  Vector inverse = Vector::Zero(hessian.rows());
  const double most = eigen.eigenvalues().cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < inverse.size(); ++k)
    if (eigen.eigenvalues()[k] > 1e-8 * most) inverse[k] = 2.0 / eigen.eigenvalues()[k];
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

Matrix hessian_of_gradient(const VectorField& gradient, const Vector& x, double step) {
  const auto n = x.size();
  Matrix out(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = [&](double times) { return gradient(x + times * step * Vector::Unit(n, i)); };
    out.col(i) = (at(-2) - 8 * at(-1) + 8 * at(1) - at(2)) / (12 * step);
  }
  return 0.5 * (out + out.transpose());
}

Minimum minimise(const ScalarField& f, const Vector& start, double step, int most_steps) {
  return minimum({f, [&](const Vector& x) { return numeric_gradient(f, x, step); },
                  [&](const Vector& x) { return numeric_hessian(f, x, 4.0 * step); }},
                 start, most_steps);
}

Minimum minimise(const ScalarField& f, const VectorField& gradient, const Vector& start,
                 double step, int most_steps) {
  return minimum(
      {f, gradient, [&](const Vector& x) { return hessian_of_gradient(gradient, x, step); },
       kSameCurvature},
      start, most_steps);
}

}  // namespace statistics
}  // namespace tractus
