/// Least squares of very many rows, in blocks that stay in the processor's cache.
///
///     Z = [1, (x − m)/s],  G = Zᵀ W Z,  g = G⁻¹ Zᵀ W (y − ȳ)
///
/// Two passes over memory: one for every sum of products, about a mean guessed from a few rows and
/// then made exact (Chan, Golub & LeVeque 1983; taken again where the guess was bad), one for
/// residuals and leverage. The normal equations of centred and scaled columns lose no more than
/// cond(G) ε; where cond(G) is above 1e5 (coefficients good to about 1e-11 no longer) nothing comes
/// back, and the caller takes a QR decomposition instead. For more than 200 000 numbers; below, QR
/// is as fast.
#pragma once

#include <optional>

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

class BlockLeastSquares {
 public:
  /// Keeps references to both, which must outlive it. Nothing when a column or the response does
  /// not vary, or a number is not finite, or its square leaves a double.
  static std::optional<BlockLeastSquares> make(const Design& design, const Vector& response);

  struct Fit {
    Vector coefficients;
    Matrix unscaled_covariance;      ///< (Xᵀ W X)⁻¹
    Matrix inverse;                  ///< G⁻¹; without an intercept it has no row for one
    double centred_intercept = 0.0;  ///< of y − ȳ on x − m
  };
  /// @param weights  one per row, ≥ 0; null: all 1. Nothing when G is too near to singular.
  std::optional<Fit> solve(const Vector* weights) const;
  /// y − X b.
  void residuals(const Vector& coefficients, Vector& out) const;
  /// The same of a fit without weights, and zᵀ G⁻¹ z per row.
  void residuals_and_leverage(const Fit& fit, Vector& residuals, Vector& leverage) const;
  /// Σ (y − ȳ)² with an intercept, Σ y² without.
  double total_sum_of_squares() const { return sums_(sums_.rows() - 1, sums_.rows() - 1); }

 private:
  BlockLeastSquares(const Design& design, const Vector& response)
      : design_(design), response_(response) {}
  /// Σ w u uᵀ over rows, u = [1, x − m, y − ȳ], lower triangle.
  Matrix products(const Vector* weights) const;
  /// Means good enough that the sums about them lose nothing, and those sums. False: see make().
  bool centre();
  /// One block's x − m, columns kBlock apart, zeros after its last row.
  void fill(Eigen::Index row, Eigen::Index rows, double* block) const;

  const Design& design_;
  const Vector& response_;
  Eigen::Index first_ = 0;  ///< of the columns that vary: 1 with an intercept
  Vector means_, scales_;   ///< of those columns; means_ ends in ȳ
  Matrix sums_;             ///< products(nullptr)
};

/// Is the design so large that blocks pay?
bool is_large(const Design& design);

}  // namespace tractus::statistics
