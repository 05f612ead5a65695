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
/// without its indirection. The rows are gone through once for given weights: Zᵀ W Z is summed by
/// level. Where its entries are, and those of S, is found once.
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

  /// The weight of each observation; 1 until then.
  void weigh(const Vector& weights);
  /// The response of solve(), at the weights as they are.
  void observe(const Vector& y);

  enum class Want { criterion, everything };
  Penalised solve(const Vector& theta, Want want) const;
  /// Without X, the response `y` being Z Λ u and noise: ln|L|², u and Λ u alone.
  Penalised solve_effects(const Vector& theta, const Vector& y) const;
  /// The same of another response, at the weights and `theta` of the last solve_effects().
  Penalised solve_effects_again(const Vector& theta, const Vector& y) const;
  /// At the weights and `theta` of the last solve_effects().
  LogDeterminantSlope log_determinant_slope(const Vector& theta) const;

  /// θ of Λ = I.
  Vector start() const;
  const std::vector<ScaledTerm>& terms() const { return terms_; }
  const Vector& column_scale() const { return column_scale_; }  ///< of X
  Eigen::Index rows() const { return x_.rows(); }

 private:
  using Sparse = Eigen::SparseMatrix<double>;

  /// L at one θ: the levels of Z₁, and S = L₂ L₂ᵀ, dense or sparse where it is large.
  struct Factor {
    Matrix p;  // Λ₁ A⁻¹ Λ₁ᵀ of all levels, side by side
    Sparse s;  // lower half
    Eigen::LLT<Matrix> dense;
    Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::AMDOrdering<int>> sparse;
    bool analysed = false;  // the sparse pattern is that of every θ
    double log_det = 0.0;
  };
  /// Cross products of right-hand sides, [X y] or y alone.
  struct Right {
    Matrix with;    // Z₁ᵀ W of all levels, side by side
    Matrix ze, ee;  // of Z₂ and of the right-hand sides, or K of these
  };
  /// Column of Z₂ met by a level of Z₁.
  struct Meeting {
    std::size_t group, place;  // in column_
  };

  /// Does `work` with k, the effects of a level of Z₁, known to the compiler.
  template <class Work>
  void sized(const Work& work) const {
    if (k_ == 1)
      work.template operator()<1>();
    else if (k_ == 2)
      work.template operator()<2>();
    else
      work.template operator()<Eigen::Dynamic>();
  }

  void find_pattern();
  void find_pairs();
  template <int K>
  void sum_weights();
  template <int K>
  void sum_right(const Matrix& right, Right& out) const;
  Right cross_products(const Matrix& right) const;
  std::vector<Matrix> triangles(const Vector& theta) const;
  Matrix lambda1(const std::vector<Matrix>& lambda) const;
  template <int K>
  Right eliminate(Right of) const;
  Right eliminated(const Right& of) const;
  template <int K>
  void fill_levels(const std::vector<Matrix>& lambda) const;
  void factorise_levels(const std::vector<Matrix>& lambda) const;
  void factorise(const std::vector<Matrix>& lambda) const;
  Matrix turned(const std::vector<Matrix>& lambda, Matrix rows) const;
  Matrix forward(const Matrix& right) const;   // L₂⁻¹
  Vector backward(const Vector& right) const;  // L₂⁻ᵀ
  void add_effects(const std::vector<Matrix>& lambda, const Right& at, const Vector& u2,
                   const Vector& residual, Penalised& out) const;
  template <int K>
  struct OfGroup;
  template <int K, class Inverse>
  OfGroup<K> of_group(std::size_t group, const std::vector<Matrix>& lambda,
                      const Inverse& s_inverse) const;
  template <int K, class Inverse>
  LogDeterminantSlope slope(const std::vector<Matrix>& lambda, const Inverse& s_inverse) const;
  template <class Inverse>
  LogDeterminantSlope any_slope(const std::vector<Matrix>& lambda, const Inverse& s_inverse) const;

  Matrix x_;  // scaled
  Vector weights_;
  std::vector<ScaledTerm> terms_;
  Vector column_scale_;
  std::size_t main_ = 0;             // the term whose levels are eliminated
  std::vector<bool> eliminated_;     // per term: its levels are those of main_
  std::vector<Eigen::Index> first_;  // per term: its first column in Z₂, or within a level of Z₁
  Eigen::Index k_ = 0, q2_ = 0, groups_ = 0;
  bool dense_ = true;
  Matrix z_;                  // [entry][row]: its k values in Z₁, then those in Z₂
  std::vector<int> term_of_;  // per column of Z₂
  // Z₁ᵀ W Z₂ by level of Z₁: columns of Z₂ ascending, k values each.
  std::vector<std::size_t> begin_;
  std::vector<int> column_;
  std::vector<double> cross_;
  std::vector<std::vector<Meeting>> meetings_;  // per column of Z₂
  std::vector<std::vector<int>> rows_of_;       // per level of Z₁
  Eigen::MatrixXi slot_;                        // [entry in Z₂][row]: its place in column_
  Eigen::MatrixXi pair_;  // [pair of entries in Z₂][row]: its place among the values of zz_
  Matrix own_;            // Z₁ᵀ W Z₁ of all levels, side by side
  Sparse zz_;             // Z₂ᵀ W Z₂ on the pattern of S, lower half
  Right right_;           // of [X y]
  mutable Factor factor_;
};

}  // namespace tractus::statistics
