#include "statistics/block_least_squares.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace statistics {
namespace {

constexpr Eigen::Index kBlock = 512;
constexpr Eigen::Index kLarge = 200'000;
constexpr double kWorstCondition = 1e5;

/// Mean about the first value, so that a large common offset costs no digits.
double mean_of(Eigen::Ref<const Vector> column) {
  const double shift = column[0];
  return shift + (column.array() - shift).mean();
}

}  // namespace

bool is_large(const Design& design) { return design.columns.size() > kLarge; }

Eigen::Index BlockLeastSquares::rows_from(Eigen::Index row) const {
  return std::min(kBlock, response_.size() - row);
}

std::optional<BlockLeastSquares> BlockLeastSquares::make(const Design& design,
                                                         const Vector& response) {
  BlockLeastSquares out(design, response);
  const Eigen::Index p = design.columns.cols();
  const auto n = static_cast<double>(response.size());
  out.means_ = Vector::Zero(p);
  out.scales_ = Vector::Ones(p);
  for (Eigen::Index j = design.intercept ? 1 : 0; j < p; ++j) {
    const auto column = design.columns.col(j);
    if (design.intercept) out.means_[j] = mean_of(column);
    const double scale = std::sqrt((column.array() - out.means_[j]).square().sum() / n);
    if (!std::isfinite(scale) || !(scale > 1e-14 * std::abs(out.means_[j]))) return std::nullopt;
    out.scales_[j] = scale;
  }
  if (design.intercept) out.mean_ = mean_of(response);
  out.total_ = (response.array() - out.mean_).square().sum();
  if (!std::isfinite(out.total_)) return std::nullopt;
  return out;
}

void BlockLeastSquares::fill(Eigen::Index row, Eigen::Index rows, Matrix& block) const {
  for (Eigen::Index j = 0; j < means_.size(); ++j)
    block.col(j).head(rows) =
        (design_.columns.col(j).segment(row, rows).array() - means_[j]) * (1.0 / scales_[j]);
}

std::optional<BlockLeastSquares::Fit> BlockLeastSquares::solve(const Vector* weights) const {
  const Eigen::Index p = means_.size();
  Matrix z(kBlock, p), weighted(kBlock, p), g = Matrix::Zero(p, p);
  Vector y(kBlock), right = Vector::Zero(p);
  for (Eigen::Index row = 0; row < response_.size(); row += kBlock) {
    const Eigen::Index rows = rows_from(row);
    fill(row, rows, z);
    y.head(rows) = response_.segment(row, rows).array() - mean_;
    for (Eigen::Index j = 0; j < p; ++j) {
      if (weights)
        weighted.col(j).head(rows) = z.col(j).head(rows).cwiseProduct(weights->segment(row, rows));
      const auto left = (weights ? weighted : z).col(j).head(rows);
      right[j] += left.dot(y.head(rows));
      for (Eigen::Index k = 0; k <= j; ++k) g(j, k) += left.dot(z.col(k).head(rows));
    }
  }
  g = g.selfadjointView<Eigen::Lower>();
  const Vector size = g.diagonal().cwiseSqrt();
  const Matrix scaled = size.cwiseInverse().asDiagonal() * g * size.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(scaled, Eigen::EigenvaluesOnly);
  const auto& values = eigen.eigenvalues();
  if (!values.allFinite() || !(values[0] * kWorstCondition > values[p - 1])) return std::nullopt;
  Fit out;
  out.inverse = size.cwiseInverse().asDiagonal() *
                scaled.ldlt().solve(Matrix::Identity(p, p)).eval() *
                size.cwiseInverse().asDiagonal();
  // One step of refinement takes back what forming the inverse lost.
  Vector solved = out.inverse * right;
  solved += out.inverse * (right - g * solved);
  Matrix back = scales_.cwiseInverse().asDiagonal();
  if (design_.intercept)
    back.row(0).tail(p - 1) = -means_.tail(p - 1).cwiseQuotient(scales_.tail(p - 1)).transpose();
  out.coefficients = back * solved;
  out.coefficients[0] += mean_;
  out.unscaled_covariance = back * out.inverse * back.transpose();
  return out;
}

void BlockLeastSquares::residuals(const Vector& coefficients, Vector& out) const {
  out.resize(response_.size());
  for (Eigen::Index row = 0; row < response_.size(); row += kBlock) {
    const Eigen::Index rows = rows_from(row);
    auto r = out.segment(row, rows);
    r = response_.segment(row, rows);
    for (Eigen::Index j = 0; j < coefficients.size(); ++j)
      r -= coefficients[j] * design_.columns.col(j).segment(row, rows);
  }
}

void BlockLeastSquares::leverage(const Fit& fit, Vector& out) const {
  const Eigen::Index p = means_.size();
  const Matrix root = fit.inverse.llt().matrixU();  // G⁻¹ = Uᵀ U, h = ‖U z‖²
  Matrix z(kBlock, p);
  Vector turned(kBlock);
  out.resize(response_.size());
  for (Eigen::Index row = 0; row < response_.size(); row += kBlock) {
    const Eigen::Index rows = rows_from(row);
    fill(row, rows, z);
    auto h = out.segment(row, rows);
    h.setZero();
    for (Eigen::Index j = 0; j < p; ++j) {
      auto t = turned.head(rows);
      t = root(j, j) * z.col(j).head(rows);
      for (Eigen::Index k = j + 1; k < p; ++k) t += root(j, k) * z.col(k).head(rows);
      h += t.cwiseAbs2();
    }
  }
}

}  // namespace statistics
