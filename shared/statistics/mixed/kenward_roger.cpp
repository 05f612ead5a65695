#include "statistics/mixed/kenward_roger.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <cmath>

#include "statistics/distributions/distributions.hpp"
#include "statistics/mixed/penalised.hpp"

namespace tractus {
namespace statistics {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
constexpr Eigen::Index kMostInverted = 2000;  // random effects: matrices of 32 MB

/// λ and m of the scaled F, from A_1 and A_2 (Kenward & Roger 1997, section 2.3).
struct Scaling {
  double scale = 1.0, df = 0.0;
};

Scaling scaling(double a1, double a2, double q) {
  const double b = (a1 + 6.0 * a2) / (2.0 * q);
  const double g = ((q + 1.0) * a1 - (q + 4.0) * a2) / ((q + 2.0) * a2);
  const double below = 3.0 * q + 2.0 * (1.0 - g);
  const double c1 = g / below, c2 = (q - g) / below, c3 = (q + 2.0 - g) / below;
  const double mean = 1.0 / (1.0 - a2 / q);
  const double variance = 2.0 / q * (1.0 + c1 * b) / (std::pow(1.0 - c2 * b, 2) * (1.0 - c3 * b));
  const double rho = variance / (2.0 * mean * mean);
  const double m = 4.0 + (q + 2.0) / (q * rho - 1.0);
  return {m / (mean * (m - 2.0)), m};
}

/// Z of all terms, unscaled; levels in the order of the fit.
Sparse random_design(const std::vector<RandomTerm>& terms, Eigen::Index rows, Eigen::Index& q) {
  std::vector<Eigen::Triplet<double>> entries;
  q = 0;
  for (const auto& term : terms) {
    const ScaledTerm counted = scaled(term);
    const auto k = counted.effects();
    for (Eigen::Index i = 0; i < rows; ++i)
      for (Eigen::Index e = 0; e < k; ++e)
        entries.emplace_back(int(i), int(q + counted.level_of[std::size_t(i)] * k + e),
                             term.columns(i, e));
    q += counted.size();
  }
  Sparse z(rows, q);
  z.setFromTriplets(entries.begin(), entries.end());
  return z;
}

/// A matrix for the effects of one level, repeated for every level of its term.
void repeat(const Matrix& block, Eigen::Index first, Eigen::Index levels,
            std::vector<Eigen::Triplet<double>>& entries) {
  const auto k = block.rows();
  for (Eigen::Index level = 0; level < levels; ++level)
    for (Eigen::Index r = 0; r < k; ++r)
      for (Eigen::Index c = 0; c < k; ++c)
        if (block(r, c) != 0.0)
          entries.emplace_back(int(first + level * k + r), int(first + level * k + c), block(r, c));
}

Sparse sparse_of(const std::vector<Eigen::Triplet<double>>& entries, Eigen::Index size) {
  Sparse out(size, size);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

/// The symmetric square root of Σ/σ², of full rank or not.
Sparse root_of_covariance(const MixedModel& fit, Eigen::Index q) {
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index first = 0;
  for (const auto& part : fit.random) {
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(part.covariance / fit.sigma_squared);
    const Vector roots = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    repeat(eigen.eigenvectors() * roots.asDiagonal() * eigen.eigenvectors().transpose(), first,
           std::ssize(part.levels), entries);
    first += std::ssize(part.levels) * part.covariance.rows();
  }
  return sparse_of(entries, q);
}

/// K_a of V_a = Z K_a Zᵀ: one for each variance and covariance of each term.
std::vector<Sparse> parameters_of(const MixedModel& fit, Eigen::Index q) {
  std::vector<Sparse> out;
  Eigen::Index first = 0;
  for (const auto& part : fit.random) {
    const auto k = part.covariance.rows();
    for (Eigen::Index c = 0; c < k; ++c)
      for (Eigen::Index r = c; r < k; ++r) {
        Matrix block = Matrix::Zero(k, k);
        block(r, c) = block(c, r) = 1.0;
        std::vector<Eigen::Triplet<double>> entries;
        repeat(block, first, std::ssize(part.levels), entries);
        out.push_back(sparse_of(entries, q));
      }
    first += std::ssize(part.levels) * k;
  }
  return out;
}

/// Twice the inverse of a symmetric matrix; where a parameter cannot be told from others, of what
/// can be told.
Matrix twice_inverse_of(const Matrix& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(information);
  const double least = 1e-13 * eigen.eigenvalues().cwiseAbs().maxCoeff();
  const Vector inverse =
      eigen.eigenvalues().unaryExpr([&](double v) { return std::abs(v) > least ? 2.0 / v : 0.0; });
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

/// Products through V⁻¹, with a parameter's index last for σ² (V_a = I).
struct Products {
  std::vector<Matrix> d;               // D_a
  std::vector<std::vector<Matrix>> q;  // Q_ab
  Matrix traces;                       // tr(V⁻¹V_aV⁻¹V_b)
};

Products products(const MixedModel& fit, const Sparse& z, const Matrix& x) {
  const auto n = double(z.rows()), s2 = fit.sigma_squared;
  const auto q = z.cols();
  const Matrix zz = Matrix(Sparse(z.transpose() * z)), zx = z.transpose() * x;
  const Sparse root = root_of_covariance(fit, q);
  const Matrix one = Matrix::Identity(q, q);
  const Matrix m_inverse = Eigen::LLT<Matrix>(root * zz * root + one).solve(one);
  const Matrix h = root * m_inverse * root;  // V⁻¹ = (I − Z H Zᵀ)/σ²
  const Matrix t = one - h * zz;             // V⁻¹Z = Z T/σ²
  const Matrix zvz = zz * t / s2, zv2z = t.transpose() * zvz / s2;
  const Matrix zvx = t.transpose() * zx / s2, zv2x = t.transpose() * zvx / s2;
  const Matrix hx = h * zx;
  const Matrix xv2x =
      (x.transpose() * x - zx.transpose() * hx - hx.transpose() * zx + hx.transpose() * zz * hx) /
      (s2 * s2);
  const Matrix xv3x = (xv2x - zvx.transpose() * h * zvx) / s2;
  const auto parameters = parameters_of(fit, q);
  const auto last = parameters.size();
  Products out;
  out.q.assign(last + 1, std::vector<Matrix>(last + 1));
  out.traces.resize(std::ssize(parameters) + 1, std::ssize(parameters) + 1);
  std::vector<Matrix> turned;  // K_a ZᵀV⁻¹Z
  for (const auto& parameter : parameters) turned.push_back(parameter * zvz);
  for (std::size_t a = 0; a < last; ++a) {
    const Matrix ahead = parameters[a] * zvx;
    out.d.push_back(zvx.transpose() * ahead);
    for (std::size_t b = 0; b < last; ++b) {
      out.q[a][b] = ahead.transpose() * zvz * (parameters[b] * zvx);
      out.traces(Eigen::Index(a), Eigen::Index(b)) =
          turned[a].cwiseProduct(turned[b].transpose()).sum();
    }
    out.q[a][last] = ahead.transpose() * zv2x;
    out.q[last][a] = out.q[a][last].transpose();
    out.traces(Eigen::Index(a), Eigen::Index(last)) =
        out.traces(Eigen::Index(last), Eigen::Index(a)) = Matrix(parameters[a] * zv2z).trace();
  }
  out.d.push_back(xv2x);
  out.q[last][last] = xv3x;
  const Matrix kept = one - m_inverse;
  out.traces(Eigen::Index(last), Eigen::Index(last)) =
      (n - 2.0 * kept.trace() + kept.squaredNorm()) / (s2 * s2);
  return out;
}

}  // namespace

KenwardRoger kenward_roger(const Vector& coefficients, const Matrix& covariance,
                           const std::vector<Matrix>& covariance_slope,
                           const Matrix& parameter_covariance, const Matrix& bias) {
  KenwardRoger out;
  out.coefficients = coefficients;
  out.unadjusted = covariance;
  out.covariance_slope = covariance_slope;
  out.parameter_covariance = parameter_covariance;
  out.covariance = covariance + 2.0 * covariance * bias * covariance;
  out.standard_errors = out.covariance.diagonal().cwiseSqrt();
  out.t = coefficients.cwiseQuotient(out.standard_errors);
  out.df.resize(out.t.size());
  out.p.resize(out.t.size());
  for (Eigen::Index j = 0; j < out.t.size(); ++j) {
    out.df[j] = joint_test(out, {j}).df2;
    out.p[j] = student_t_two_sided(out.t[j], out.df[j]);
  }
  return out;
}

core::Result<KenwardRoger> kenward_roger(const MixedModel& fit, const Design& design,
                                         const std::vector<RandomTerm>& terms) {
  Eigen::Index q = 0;
  const Sparse z = random_design(terms, design.columns.rows(), q);
  if (q > kMostInverted)
    return core::bad_input("Kenward and Roger's tests take at most " +
                           std::to_string(kMostInverted) + " random effects, these terms have " +
                           std::to_string(q) + ": ask for Satterthwaite's");
  const Products of = products(fit, z, design.columns);
  const Matrix& phi = fit.covariance;
  const auto count = of.d.size();
  Matrix information = of.traces;
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < count; ++b)
      information(Eigen::Index(a), Eigen::Index(b)) +=
          (phi * of.d[a] * phi * of.d[b]).trace() - 2.0 * (phi * of.q[a][b]).trace();
  const Matrix w = twice_inverse_of(information);
  Matrix bias = Matrix::Zero(phi.rows(), phi.cols());
  std::vector<Matrix> slope;
  for (std::size_t a = 0; a < count; ++a) {
    slope.push_back(phi * of.d[a] * phi);
    for (std::size_t b = 0; b < count; ++b)
      bias += w(Eigen::Index(a), Eigen::Index(b)) * (of.q[a][b] - of.d[a] * phi * of.d[b]);
  }
  return kenward_roger(fit.coefficients, phi, slope, w, bias);
}

JointTest joint_test(const KenwardRoger& tests, const std::vector<Eigen::Index>& columns) {
  core::require(!columns.empty(), "a joint test is of one coefficient or more");
  const auto p = tests.coefficients.size();
  const auto size = std::ssize(columns);
  const double q = static_cast<double>(size);
  Matrix theta = Matrix::Zero(p, p);
  const Matrix inverse =
      Matrix(tests.unadjusted(columns, columns)).ldlt().solve(Matrix::Identity(size, size));
  theta(columns, columns) = inverse;
  std::vector<Matrix> turned;  // Θ Φ D_a Φ
  for (const auto& slope : tests.covariance_slope) turned.push_back(theta * slope);
  double a1 = 0.0, a2 = 0.0;
  for (std::size_t a = 0; a < turned.size(); ++a)
    for (std::size_t b = 0; b < turned.size(); ++b) {
      const double w = tests.parameter_covariance(Eigen::Index(a), Eigen::Index(b));
      a1 += w * turned[a].trace() * turned[b].trace();
      a2 += w * (turned[a] * turned[b]).trace();
    }
  const Scaling scaled_f = scaling(a1, a2, q);
  const Vector b = tests.coefficients(columns);
  JointTest out{0.0, q, scaled_f.df, 0.0};
  out.statistic =
      scaled_f.scale / q * b.dot(Matrix(tests.covariance(columns, columns)).ldlt().solve(b));
  out.p = f_upper(out.statistic, out.df1, out.df2);
  return out;
}

}  // namespace statistics
}  // namespace tractus
