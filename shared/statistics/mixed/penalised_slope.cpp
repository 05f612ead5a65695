/// Derivatives of ln|L|² = ln|A|, A = Λᵀ Zᵀ W Z Λ + I, in the weights and in θ:
///
///     d ln|A| = Σ_i h_i dw_i + 2 Σ_i w_i v_iᵀ dΛᵀ z_i,   v_i = A⁻¹ Λᵀ z_i,   h_i = z_iᵀ Λ v_i
///
/// Only the entries of v_i at row i's own levels are needed. With Z₁ eliminated (penalised.hpp),
/// a = Λᵀ z in its two parts, A₁ = Λ₁ᵀ Z₁ᵀ W Z₁ Λ₁ + I and F = A₁⁻¹ Λ₁ᵀ Z₁ᵀ W Z₂ Λ₂:
///
///     v₁ = A₁⁻¹ a₁ + F S⁻¹ Fᵀ a₁ − F S⁻¹ a₂,   v₂ = S⁻¹ a₂ − S⁻¹ Fᵀ a₁
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
template <int K>
struct PenalisedLeastSquares::OfGroup {
  Eigen::Matrix<double, K, K> v;                // A₁⁻¹ + F S⁻¹ Fᵀ
  Eigen::Matrix<double, K, Eigen::Dynamic> fs;  // F S⁻¹
};

template <int K, class Inverse>
PenalisedLeastSquares::OfGroup<K> PenalisedLeastSquares::of_group(std::size_t group,
                                                                  const std::vector<Matrix>& lambda,
                                                                  const Inverse& s_inverse) const {
  const Matrix of_level = lambda1(lambda);
  const Eigen::LLT<Matrix> a(of_level.transpose() * own_.middleCols(Eigen::Index(group) * k_, k_) *
                                 of_level +
                             Matrix::Identity(k_, k_));
  const std::size_t from = begin_[group];
  const auto met = Eigen::Index(begin_[group + 1] - from);
  const Matrix r = a.solve(of_level.transpose());
  OfGroup<K> out;
  Eigen::Matrix<double, K, Eigen::Dynamic> f =
      r * Eigen::Map<const Matrix>(cross_.data() + from * std::size_t(k_), k_, met);
  for (Eigen::Index c = 0; c < met;) {
    const Matrix& of = lambda[std::size_t(term_of_[std::size_t(column_[from + std::size_t(c)])])];
    f.middleCols(c, of.cols()) = (f.middleCols(c, of.cols()) * of).eval();
    c += of.cols();
  }
  out.fs.setZero(k_, met);
  for (Eigen::Index c = 0; c < met; ++c)
    for (Eigen::Index at = 0; at < met; ++at)
      out.fs.col(c) += f.col(at) * s_inverse.coeff(column_[from + std::size_t(at)],
                                                   column_[from + std::size_t(c)]);
  out.v = a.solve(Matrix::Identity(k_, k_)) + out.fs * f.transpose();
  return out;
}

template <int K, class Inverse>
LogDeterminantSlope PenalisedLeastSquares::slope(const std::vector<Matrix>& lambda,
                                                 const Inverse& s_inverse) const {
  using Column = Eigen::Matrix<double, K, 1>;
  const Eigen::Matrix<double, K, K> of_level = lambda1(lambda).transpose();
  std::vector<Matrix> sums;  // Σ w z vᵀ per term
  for (const auto& term : terms_) sums.push_back(Matrix::Zero(term.effects(), term.effects()));
  LogDeterminantSlope out;
  out.of_weights.resize(rows());
  Vector a2(slot_.rows()), v(z_.rows());  // v: v₁, then v₂
  for (std::size_t g = 0; g < rows_of_.size(); ++g) {
    const auto shared = of_group<K>(g, lambda, s_inverse);
    for (const int i : rows_of_[g]) {
      const Column a1 = of_level * z_.col(i).head(k_);
      Column v1 = shared.v * a1;
      for (Eigen::Index n = 0; n < a2.size();) {
        const Matrix& of =
            lambda[std::size_t(term_of_[std::size_t(column_[std::size_t(slot_(n, i))])])];
        for (Eigen::Index c = 0; c < of.cols(); ++c)
          a2[n + c] = of.col(c).dot(z_.col(i).segment(k_ + n, of.rows()));
        n += of.cols();
      }
      for (Eigen::Index n = 0; n < a2.size(); ++n) {
        const auto place = std::size_t(slot_(n, i));
        const auto fs = shared.fs.col(Eigen::Index(place - begin_[g]));
        v1 -= a2[n] * fs;
        double v2 = -fs.dot(a1);
        for (Eigen::Index m = 0; m < a2.size(); ++m)
          v2 += a2[m] * s_inverse.coeff(column_[place], column_[std::size_t(slot_(m, i))]);
        v[k_ + n] = v2;
      }
      v.head(k_) = v1;
      out.of_weights[i] = a1.dot(v1) + a2.dot(v.tail(a2.size()));
      Eigen::Index behind = k_;
      for (std::size_t t = 0; t < terms_.size(); ++t) {
        const auto k = terms_[t].effects();
        const auto at = eliminated_[t] ? first_[t] : std::exchange(behind, behind + k);
        for (Eigen::Index c = 0; c < k; ++c)
          for (Eigen::Index r = 0; r < k; ++r)
            sums[t](r, c) += weights_[i] * z_(at + r, i) * v[at + c];
      }
    }
  }
  Eigen::Index place = 0;
  out.of_theta.resize(start().size());
  for (const Matrix& sum : sums)
    for (Eigen::Index c = 0; c < sum.cols(); ++c)
      for (Eigen::Index r = c; r < sum.rows(); ++r) out.of_theta[place++] = 2.0 * sum(r, c);
  return out;
}

template <class Inverse>
LogDeterminantSlope PenalisedLeastSquares::any_slope(const std::vector<Matrix>& lambda,
                                                     const Inverse& s_inverse) const {
  LogDeterminantSlope out;
  sized([&]<int K>() { out = slope<K>(lambda, s_inverse); });
  return out;
}

LogDeterminantSlope PenalisedLeastSquares::log_determinant_slope(const Vector& theta) const {
  const std::vector<Matrix> lambda = triangles(theta);
  if (dense_) {
    Matrix inverse = Matrix::Identity(q2_, q2_);
    if (q2_ > 0) factor_.dense.solveInPlace(inverse);
    return any_slope(lambda, inverse);
  }
  const Sparse inverse = inverse_on_pattern(factor_.sparse.matrixL().nestedExpression());
  const Sparse whole = inverse.selfadjointView<Eigen::Lower>();
  return any_slope(
      lambda, Sparse(factor_.sparse.permutationPinv() * whole * factor_.sparse.permutationP()));
}

}  // namespace statistics
}  // namespace tractus
