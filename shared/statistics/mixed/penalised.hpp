/// Penalised least squares of a mixed model: what given variances of its random effects say.
///
///     minimise over β and u   Σ w (y − X β − Z Λ u)² + |u|²,   r² the least value
///     L Lᵀ = Λᵀ Zᵀ W Z Λ + I,   R_Xᵀ R_X = Xᵀ V⁻¹ X,   V = W⁻¹ + Z Λ Λᵀ Zᵀ
///
/// Z₁ is the grouping with most effects. No two of its levels share a row, so that it is eliminated
/// level by level, and only the other groupings Z₂ are factorised together:
///
///     A = Λ₁ᵀ Z₁ᵀ W Z₁ Λ₁ + I, block diagonal,   E = [Z₂ X y]
///     K = Eᵀ W E − Eᵀ W Z₁ (Λ₁ A⁻¹ Λ₁ᵀ) Z₁ᵀ W E
///     S = Λ₂ᵀ K_ZZ Λ₂ + I,   [X y]ᵀ V⁻¹ [X y] = K_ee − K_eZ Λ₂ S⁻¹ Λ₂ᵀ K_Ze
///
/// so that 10⁴ surgeons crossed with 10³ scenarios cost one dense 10³ × 10³ Cholesky factorisation.
/// This is the elimination order that a fill-reducing permutation finds too [Bates2015, section 5.3],
/// without its indirection. The rows are gone through once: Zᵀ W Z is summed by level.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

#include "statistics/mixed/random_term.hpp"

namespace tractus::statistics {

/// One term with its levels counted and its columns scaled to a root mean square of 1.
struct ScaledTerm {
  const RandomTerm* from = nullptr;
  std::vector<std::string> levels;  ///< in order of first appearance
  std::vector<int> level_of;        ///< per observation
  Vector scale;                     ///< per effect
  Eigen::Index effects() const { return scale.size(); }
  Eigen::Index size() const { return effects() * Eigen::Index(levels.size()); }
  /// How many entries of θ it has.
  Eigen::Index parameters() const { return effects() * (effects() + 1) / 2; }
};
ScaledTerm scaled(const RandomTerm& term);

/// Λ_t of a term, from its part of θ in column order; moves `at` behind it.
Matrix triangle(const ScaledTerm& term, const Vector& theta, Eigen::Index& at);

/// A term's part of an estimate in units of the columns as given: `block` is its Λ_t, `effects`
/// are Λ u, [level][effect]. Singular as lme4's isSingular says.
RandomPart random_part(const ScaledTerm& term, const Matrix& block, const Matrix& effects,
                       double sigma_squared);

/// What one θ gives, in units of the scaled columns.
struct Penalised {
  double log_det_L = 0.0;   ///< ln|L|²
  double log_det_RX = 0.0;  ///< ln|R_X|², in units of the unscaled columns of X
  double rss = 0.0;         ///< r²
  Vector beta;
  Matrix covariance;            ///< (R_XᵀR_X)⁻¹; empty unless asked for
  std::vector<Matrix> effects;  ///< Λ u per term, [level][effect]; empty unless asked for
  std::vector<Matrix> u;        ///< as `effects`
};

/// Derivatives of ln|L|².
struct LogDeterminantSlope {
  Vector of_weights;  ///< per observation, h = z Λ (L Lᵀ)⁻¹ Λᵀ zᵀ, z its row of Z
  Vector of_theta;    ///< at these weights: 2 tr((L Lᵀ)⁻¹ Λᵀ Zᵀ W Z dΛ)
};

class PenalisedLeastSquares {
 public:
  /// @param x  columns of the fixed effects. `terms` is referred to as long as this lives.
  PenalisedLeastSquares(const Matrix& x, const std::vector<RandomTerm>& terms);

  /// The response and the weight of each observation (empty: 1).
  void observe(const Vector& y, const Vector& weights = {});

  enum class Want { criterion, everything };
  Penalised solve(const Vector& theta, Want want) const;
  /// Without X, the response being Z Λ u and noise: ln|L|², u and Λ u alone.
  Penalised solve_effects(const Vector& theta) const;
  /// Of the weights observed last; `theta` is that of the last solve_effects().
  LogDeterminantSlope log_determinant_slope(const Vector& theta) const;

  /// θ of Λ = I.
  Vector start() const;
  const std::vector<ScaledTerm>& terms() const { return terms_; }
  const Vector& column_scale() const { return column_scale_; }  ///< of X
  Eigen::Index rows() const { return x_.rows(); }

 private:
  using Sparse = Eigen::SparseMatrix<double>;

  /// S = L Lᵀ: dense, or sparse where it is large.
  struct Factor {
    Eigen::LLT<Matrix> dense;
    Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::AMDOrdering<int>> sparse;
    bool analysed = false;  // the sparse pattern is that of every θ
  };
  /// The first grouping at one Λ₁.
  struct Eliminated {
    double log_det = 0.0;
    std::vector<Matrix> p;  // Λ₁ A⁻¹ Λ₁ᵀ per level
    Matrix zz;              // K_ZZ where it is dense
    Matrix ze, ee;          // K_Ze, K_ee
  };

  void find_pattern();
  void sum_rows(const Matrix& xy, const Vector& weights);
  std::vector<Matrix> triangles(const Vector& theta) const;
  Matrix lambda1(const std::vector<Matrix>& lambda) const;
  Eliminated eliminate(const std::vector<Matrix>& lambda) const;
  template <int K>
  void subtract(Eliminated& out) const;
  Sparse sparse_zz(const Eliminated& at) const;
  Matrix turned(const std::vector<Matrix>& lambda, Matrix rows) const;
  Sparse lambda2(const std::vector<Matrix>& lambda) const;
  double factorise(const std::vector<Matrix>& lambda, const Eliminated& at) const;
  Matrix forward(const Matrix& right) const;   // L⁻¹
  Vector backward(const Vector& right) const;  // L⁻ᵀ
  void add_effects(const std::vector<Matrix>& lambda, const Eliminated& at, const Vector& u2,
                   const Vector& residual, Penalised& out) const;
  struct OfGroup;
  template <class Inverse>
  OfGroup of_group(std::size_t group, const Matrix& lambda1, const Inverse& n,
                   const Inverse& q) const;
  template <class Inverse>
  LogDeterminantSlope slope(const std::vector<Matrix>& lambda, const Inverse& s_inverse) const;

  Matrix x_;        // scaled
  Vector weights_;  // observed last
  std::vector<ScaledTerm> terms_;
  Vector column_scale_;
  std::size_t main_ = 0;             // the term whose levels are eliminated
  std::vector<bool> eliminated_;     // per term: its levels are those of main_
  std::vector<Eigen::Index> first_;  // per term: its first column in Z₂, or within a level of Z₁
  Eigen::Index k_ = 0, q2_ = 0, groups_ = 0;
  bool dense_ = true;
  // Z₁ᵀ W Z₂ by level of Z₁: columns of Z₂ ascending, k values each.
  std::vector<std::size_t> begin_;
  std::vector<int> column_;
  std::vector<double> cross_;
  std::vector<std::vector<int>> rows_of_;       // per level of Z₁
  std::vector<std::vector<std::size_t>> slot_;  // [term of Z₂][row]: its first place in column_
  std::vector<Matrix> own_, with_xy_;           // Z₁ᵀ W Z₁ and Z₁ᵀ W [X y] of each level
  Matrix zz_, ze_, ee_;                         // of Z₂ and [X y]
  Sparse sparse_zz_;                            // instead of zz_
  mutable Factor factor_;
};

}  // namespace tractus::statistics
