#include "statistics/regression/block_least_squares.hpp"

#include <sys/mman.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tractus {
namespace statistics {
namespace {

constexpr Eigen::Index kBlock = 256;
constexpr Eigen::Index kLarge = 200'000;
constexpr double kWorstCondition = 1e5;
/// Mean squares beyond these are for check() to refuse: their sums leave a double.
constexpr double kSmallestSquare = 1e-280, kLargestSquare = 1e280;

using Lanes = Eigen::Array<double, 8, 1>;
using Segment = Eigen::Map<Eigen::ArrayXd>;
using ConstSegment = Eigen::Map<const Eigen::ArrayXd>;

/// A vector not yet written to, in pages of 2 MiB where the system gives such: the first touch of
/// so many small ones takes longer than the arithmetic. A hint; nothing depends on it.
void resize_in_large_pages(Vector& out, Eigen::Index rows) {
  out.resize(rows);
  constexpr std::uintptr_t kPage = 2u << 20;
  const auto begin = reinterpret_cast<std::uintptr_t>(out.data());
  const auto end = reinterpret_cast<std::uintptr_t>(out.data() + rows) & ~(kPage - 1);
  const auto first = (begin + kPage - 1) & ~(kPage - 1);
  if (first < end) (void)::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

/// Fetches the next block of a column while this one is worked on: left to itself the processor
/// stops at the end of each page.
void ask_for(const double* next) {
  for (Eigen::Index i = 0; i < kBlock; i += 8) __builtin_prefetch(next + i);
}

/// Mean of some rows from all over the column; exact for a constant one.
double guessed_mean(const double* column, Eigen::Index rows) {
  const Eigen::Index taken = std::min<Eigen::Index>(rows, 64), step = rows / taken;
  double sum = 0.0;
  for (Eigen::Index i = 0; i < taken; ++i) sum += column[i * step] - column[0];
  return column[0] + sum / static_cast<double>(taken);
}

/// Products of one column with N others, block by block: N chains of eight lanes hide each other's
/// latency.
template <int N>
void add_dots(const double* left, const double* right, double* sums) {
  Lanes sum[N];
  for (auto& one : sum) one.setZero();
  for (Eigen::Index i = 0; i < kBlock; i += Lanes::SizeAtCompileTime) {
    const Lanes l = Lanes::Map(left + i);
    for (int n = 0; n < N; ++n) sum[n] += l * Lanes::Map(right + n * kBlock + i);
  }
  for (int n = 0; n < N; ++n) sums[n] += sum[n].sum();
}

/// sums(k, j) += left_k · right_j for j ≥ k, both blocks of columns kBlock apart.
void add_products(const double* left, const double* right, Matrix& upper_by_rows) {
  const Eigen::Index columns = upper_by_rows.rows();
  for (Eigen::Index k = 0; k < columns; ++k) {
    const double* one = left + k * kBlock;
    Eigen::Index j = k;
    for (; j + 4 <= columns; j += 4) add_dots<4>(one, right + j * kBlock, &upper_by_rows(j, k));
    for (; j < columns; ++j) add_dots<1>(one, right + j * kBlock, &upper_by_rows(j, k));
  }
}

}  // namespace

bool is_large(const Design& design) { return design.columns.size() > kLarge; }

std::optional<BlockLeastSquares> BlockLeastSquares::make(const Design& design,
                                                         const Vector& response) {
  BlockLeastSquares out(design, response);
  out.first_ = design.intercept ? 1 : 0;
  const Eigen::Index k = design.columns.cols() - out.first_;
  out.means_ = Vector::Zero(k + 1);
  if (!out.centre()) return std::nullopt;
  const auto n = static_cast<double>(response.size());
  const Vector mean_square = out.sums_.diagonal().tail(k + 1) / n;
  for (Eigen::Index j = 0; j <= k; ++j)
    if (!(mean_square[j] < kLargestSquare) || !(mean_square[j] > kSmallestSquare) ||
        !(std::sqrt(mean_square[j]) > 1e-14 * std::abs(out.means_[j])))
      return std::nullopt;
  out.scales_ = mean_square.head(k).cwiseSqrt();
  return out;
}

bool BlockLeastSquares::centre() {
  const Eigen::Index k = means_.size() - 1, n = response_.size();
  const auto rows = static_cast<double>(n);
  if (first_ == 1) {
    for (Eigen::Index j = 0; j < k; ++j)
      means_[j] = guessed_mean(design_.columns.col(j + 1).data(), n);
    means_[k] = guessed_mean(response_.data(), n);
  }
  for (int attempt = 0; attempt < 3; ++attempt) {
    sums_ = products(nullptr);
    if (!sums_.allFinite()) return false;
    if (first_ == 0) return true;
    const Vector off = sums_.col(0).tail(k + 1) / rows;
    const Vector lost = rows * off.cwiseAbs2();
    means_ += off;
    sums_.col(0).tail(k + 1).setZero();
    sums_.bottomRightCorner(k + 1, k + 1) -= rows * off * off.transpose();
    // What is taken away is less than what remains: not a bit of it is lost.
    if ((lost.array() <= sums_.diagonal().tail(k + 1).array()).all()) return true;
  }
  return false;
}

void BlockLeastSquares::fill(Eigen::Index row, Eigen::Index rows, double* block) const {
  for (Eigen::Index j = 0; j + 1 < means_.size(); ++j) {
    double* column = block + j * kBlock;
    ask_for(design_.columns.col(j + first_).data() + row + kBlock);
    Segment(column, rows) =
        ConstSegment(design_.columns.col(j + first_).data() + row, rows) - means_[j];
    std::fill(column + rows, column + kBlock, 0.0);
  }
}

Matrix BlockLeastSquares::products(const Vector* weights) const {
  const Eigen::Index k = means_.size() - 1, n = response_.size();
  Matrix block = Matrix::Zero(kBlock, k + 2), weighted(kBlock, weights ? k + 2 : 0);
  Matrix sums = Matrix::Zero(k + 2, k + 2);
  for (Eigen::Index row = 0; row < n; row += kBlock) {
    const Eigen::Index rows = std::min(kBlock, n - row);
    block.col(0).head(rows).setOnes();
    block.col(0).tail(kBlock - rows).setZero();
    fill(row, rows, block.col(1).data());
    block.col(k + 1).head(rows) = response_.segment(row, rows).array() - means_[k];
    block.col(k + 1).tail(kBlock - rows).setZero();
    if (weights) {
      weighted.topRows(rows) = weights->segment(row, rows).asDiagonal() * block.topRows(rows);
      weighted.bottomRows(kBlock - rows).setZero();
    }
    add_products((weights ? weighted : block).data(), block.data(), sums);
  }
  return sums;
}

std::optional<BlockLeastSquares::Fit> BlockLeastSquares::solve(const Vector* weights) const {
  const Eigen::Index k = means_.size() - 1, p = k + first_;
  const Matrix sums = weights ? products(weights) : sums_;
  Vector scale = Vector::Ones(k + 1);
  scale.tail(k) = scales_;
  const Matrix all = scale.cwiseInverse().asDiagonal() * sums.topLeftCorner(k + 1, k + 1) *
                     scale.cwiseInverse().asDiagonal();
  const Matrix g = Matrix(all.selfadjointView<Eigen::Lower>()).bottomRightCorner(p, p);
  const Vector right = sums.row(k + 1).head(k + 1).transpose().cwiseQuotient(scale).tail(p);
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
  Matrix back = scale.tail(p).cwiseInverse().asDiagonal();
  if (first_ == 1) {
    back.row(0).tail(k) = -means_.head(k).cwiseQuotient(scales_).transpose();
    out.centred_intercept = solved[0];
  }
  out.coefficients = back * solved;
  if (first_ == 1) out.coefficients[0] += means_[k];
  out.unscaled_covariance = back * out.inverse * back.transpose();
  return out;
}

void BlockLeastSquares::residuals(const Vector& coefficients, Vector& out) const {
  const Eigen::Index k = means_.size() - 1, n = response_.size();
  const double intercept = first_ == 1 ? coefficients[0] : 0.0;
  const double middle = intercept + coefficients.tail(k).dot(means_.head(k));
  resize_in_large_pages(out, n);
  for (Eigen::Index row = 0; row < n; row += kBlock) {
    const Eigen::Index rows = std::min(kBlock, n - row);
    auto r = out.segment(row, rows).array();
    r = response_.segment(row, rows).array() - middle;
    for (Eigen::Index j = 0; j < k; ++j)
      r -= coefficients[j + first_] *
           (design_.columns.col(j + first_).segment(row, rows).array() - means_[j]);
  }
}

void BlockLeastSquares::residuals_and_leverage(const Fit& fit, Vector& residuals,
                                               Vector& leverage) const {
  const Eigen::Index k = means_.size() - 1, n = response_.size();
  // h = 1/n + ‖U z‖² with Uᵀ U = G⁻¹, the columns' scales taken into U.
  const Matrix inverse = fit.inverse.bottomRightCorner(k, k);
  const Matrix root = Matrix(inverse.llt().matrixU()) * scales_.cwiseInverse().asDiagonal();
  const double own = first_ == 1 ? fit.inverse(0, 0) : 0.0;
  Matrix block(kBlock, k);
  Vector turned(kBlock);
  resize_in_large_pages(residuals, n);
  resize_in_large_pages(leverage, n);
  for (Eigen::Index row = 0; row < n; row += kBlock) {
    const Eigen::Index rows = std::min(kBlock, n - row);
    fill(row, rows, block.data());
    auto r = residuals.segment(row, rows).array();
    auto h = leverage.segment(row, rows).array();
    r = response_.segment(row, rows).array() - (means_[k] + fit.centred_intercept);
    h.setConstant(own);
    for (Eigen::Index j = 0; j < k; ++j) {
      r -= fit.coefficients[j + first_] * block.col(j).head(rows).array();
      auto t = turned.head(rows).array();
      t = root(j, j) * block.col(j).head(rows).array();
      for (Eigen::Index l = j + 1; l < k; ++l) t += root(j, l) * block.col(l).head(rows).array();
      h += t.square();
    }
  }
}

}  // namespace statistics
}  // namespace tractus
