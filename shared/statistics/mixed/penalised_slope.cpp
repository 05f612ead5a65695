/// Derivatives of ln|L|² = ln|A|, A = Λᵀ Zᵀ W Z Λ + I, in the weights and in θ:
///
///     d ln|A| = Σ_i h_i dw_i + 2 Σ_i w_i v_iᵀ dΛᵀ z_i,   v_i = A⁻¹ Λᵀ z_i,   h_i = z_iᵀ Λ v_i
///
/// Only the entries of v_i at row i's own levels are needed. With Z₁ eliminated (penalised.hpp),
/// A₁ = Λ₁ᵀ Z₁ᵀ W Z₁ Λ₁ + I, F = A₁⁻¹ Λ₁ᵀ Z₁ᵀ W Z₂, N = S⁻¹ Λ₂ᵀ and Q = Λ₂ N:
///
///     v₁ = A₁⁻¹ Λ₁ᵀ z₁ + F Q Fᵀ Λ₁ᵀ z₁ − F Q z₂,   v₂ = N z₂ − N Fᵀ Λ₁ᵀ z₁
///
/// where F has entries at the levels alone that a level of Z₁ meets. There S⁻¹ has to be known: a
/// pattern within that of L, on which a sparse S is inverted [Takahashi1973].
#include <algorithm>

#include "statistics/mixed/penalised.hpp"

namespace tractus {
namespace statistics {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// An entry of a lower triangle's pattern that is known to be there.
double& entry(Sparse& of, int row, int column) {
  const int* const from = of.innerIndexPtr() + of.outerIndexPtr()[column];
  const int* const to = of.innerIndexPtr() + of.outerIndexPtr()[column + 1];
  return of.valuePtr()[std::lower_bound(from, to, row) - of.innerIndexPtr()];
}

/// (L Lᵀ)⁻¹ where L has entries, the lower half [Takahashi1973], from the last column to the first:
/// Z_ij = −Σ_k L_kj Z_ik / L_jj,  Z_jj = 1/L_jj² − Σ_k L_kj Z_kj / L_jj,  k > j
Sparse inverse_on_pattern(const Sparse& lower) {
  Sparse out = lower;
  const int* const starts = lower.outerIndexPtr();
  const int* const rows = lower.innerIndexPtr();
  const double* const values = lower.valuePtr();
  for (int j = int(lower.cols()) - 1; j >= 0; --j) {
    const int diagonal = starts[j], end = starts[j + 1];
    for (int at = end - 1; at >= diagonal; --at) {
      double sum = at == diagonal ? -1.0 / values[diagonal] : 0.0;
      for (int k = diagonal + 1; k < end; ++k)
        sum += values[k] * entry(out, std::max(rows[at], rows[k]), std::min(rows[at], rows[k]));
      out.valuePtr()[at] = -sum / values[diagonal];
    }
  }
  return out;
}

}  // namespace

/// What the rows of one level of Z₁ share, columns [level that it meets].
struct PenalisedLeastSquares::OfGroup {
  Matrix r;          // A₁⁻¹ Λ₁ᵀ
  Matrix f, fq, fn;  // F, F Q, F Nᵀ
};

template <class Inverse>
PenalisedLeastSquares::OfGroup PenalisedLeastSquares::of_group(std::size_t group,
                                                               const Matrix& lambda1,
                                                               const Inverse& n,
                                                               const Inverse& q) const {
  const Eigen::LLT<Matrix> a(lambda1.transpose() * own_[group] * lambda1 +
                             Matrix::Identity(k_, k_));
  const std::size_t from = begin_[group];
  const auto met = Eigen::Index(begin_[group + 1] - from);
  OfGroup out;
  out.r = a.solve(lambda1.transpose());
  out.f = out.r * Eigen::Map<const Matrix>(cross_.data() + from * std::size_t(k_), k_, met);
  Matrix n_met(met, met), q_met(met, met);
  for (Eigen::Index c = 0; c < met; ++c)
    for (Eigen::Index r = 0; r < met; ++r) {
      n_met(r, c) = n.coeff(column_[from + std::size_t(r)], column_[from + std::size_t(c)]);
      q_met(r, c) = q.coeff(column_[from + std::size_t(r)], column_[from + std::size_t(c)]);
    }
  out.fq = out.f * q_met;
  out.fn = out.f * n_met.transpose();
  return out;
}

template <class Inverse>
LogDeterminantSlope PenalisedLeastSquares::slope(const std::vector<Matrix>& lambda,
                                                 const Inverse& s_inverse) const {
  const Sparse l2 = lambda2(lambda);
  const Inverse n = s_inverse * Sparse(l2.transpose()), q = l2 * n;
  const Matrix of_level = lambda1(lambda);
  std::vector<Matrix> sums;  // Σ w z vᵀ per term
  for (const auto& term : terms_) sums.push_back(Matrix::Zero(term.effects(), term.effects()));
  LogDeterminantSlope out;
  out.of_weights.resize(rows());
  Vector z1(k_), v1(k_);
  std::vector<std::pair<Eigen::Index, double>> rest;  // z₂: place among the levels met, value
  for (std::size_t g = 0; g < rows_of_.size(); ++g) {
    const OfGroup shared = of_group(g, of_level, n, q);
    const Matrix fqf = shared.fq * shared.f.transpose();
    for (const int i : rows_of_[g]) {
      rest.clear();
      for (std::size_t t = 0; t < terms_.size(); ++t)
        for (Eigen::Index e = 0; e < terms_[t].effects(); ++e) {
          const double value = terms_[t].from->columns(i, e) / terms_[t].scale[e];
          if (eliminated_[t])
            z1[first_[t] + e] = value;
          else
            rest.emplace_back(Eigen::Index(slot_[t][std::size_t(i)] - begin_[g]) + e, value);
        }
      const Vector a1 = of_level.transpose() * z1;
      v1 = shared.r * z1 + fqf * a1;
      for (const auto& [place, value] : rest) v1 -= value * shared.fq.col(place);
      double h = a1.dot(v1);
      std::size_t at = 0;
      for (std::size_t t = 0; t < terms_.size(); ++t) {
        const auto k = terms_[t].effects();
        Vector z(k), v(k);
        for (Eigen::Index e = 0; e < k; ++e) {
          if (eliminated_[t]) {
            z[e] = z1[first_[t] + e];
            v[e] = v1[first_[t] + e];
            continue;
          }
          const auto [place, own] = rest[at++];
          z[e] = own;
          v[e] = -shared.fn.col(place).dot(a1);
          for (const auto& [other, value] : rest)
            v[e] += value * n.coeff(column_[begin_[g] + std::size_t(place)],
                                    column_[begin_[g] + std::size_t(other)]);
        }
        if (!eliminated_[t]) h += (lambda[t].transpose() * z).dot(v);
        sums[t].noalias() += weights_[i] * z * v.transpose();
      }
      out.of_weights[i] = h;
    }
  }
  Eigen::Index place = 0;
  out.of_theta.resize(start().size());
  for (const Matrix& sum : sums)
    for (Eigen::Index c = 0; c < sum.cols(); ++c)
      for (Eigen::Index r = c; r < sum.rows(); ++r) out.of_theta[place++] = 2.0 * sum(r, c);
  return out;
}

LogDeterminantSlope PenalisedLeastSquares::log_determinant_slope(const Vector& theta) const {
  const std::vector<Matrix> lambda = triangles(theta);
  if (q2_ == 0) return slope(lambda, Matrix(0, 0));
  if (dense_) return slope(lambda, Matrix(factor_.dense.solve(Matrix::Identity(q2_, q2_))));
  const Sparse inverse = inverse_on_pattern(factor_.sparse.matrixL().nestedExpression());
  const Sparse whole = inverse.selfadjointView<Eigen::Lower>();
  return slope(lambda,
               Sparse(factor_.sparse.permutationPinv() * whole * factor_.sparse.permutationP()));
}

}  // namespace statistics
}  // namespace tractus
