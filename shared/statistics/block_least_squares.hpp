/// Least squares of very many rows, in blocks that stay in the processor's cache.
///
///     Z = [1, (x − m)/s],  G = Zᵀ W Z,  g = G⁻¹ Zᵀ W (y − ȳ)
///
/// Columns are centred and scaled first, so that normal equations lose no more than cond(G) ε;
/// where cond(G) is above 1e5 (coefficients good to about 1e-11 no longer) nothing comes back, and
/// the caller takes a QR decomposition instead. For more than 200 000 numbers; below, QR is as
/// fast.
#pragma once

#include <optional>

#include "statistics/design.hpp"

namespace statistics {

class BlockLeastSquares {
 public:
  /// Keeps references to both, which must outlive it. Nothing when a column does not vary or a
  /// number is not finite.
  static std::optional<BlockLeastSquares> make(const Design& design, const Vector& response);

  struct Fit {
    Vector coefficients;
    Matrix unscaled_covariance;  ///< (Xᵀ W X)⁻¹
    Matrix inverse;              ///< G⁻¹
  };
  /// @param weights  one per row, ≥ 0; null: all 1. Nothing when G is too near to singular.
  std::optional<Fit> solve(const Vector* weights) const;
  /// y − X b.
  void residuals(const Vector& coefficients, Vector& out) const;
  /// zᵀ G⁻¹ z per row.
  void leverage(const Fit& fit, Vector& out) const;
  /// Σ (y − ȳ)² with an intercept, Σ y² without.
  double total_sum_of_squares() const { return total_; }

 private:
  BlockLeastSquares(const Design& design, const Vector& response)
      : design_(design), response_(response) {}
  Eigen::Index rows_from(Eigen::Index row) const;
  /// Rows from `row` on, centred and scaled.
  void fill(Eigen::Index row, Eigen::Index rows, Matrix& block) const;

  const Design& design_;
  const Vector& response_;
  Vector means_, scales_;
  double mean_ = 0.0, total_ = 0.0;
};

/// Is the design so large that blocks pay?
bool is_large(const Design& design);

}  // namespace statistics
