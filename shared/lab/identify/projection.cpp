#include "lab/identify/projection.hpp"

#include <algorithm>

namespace tractus {
namespace lab {

Projection::Projection(const Solution& at)
    : at_(at),
      weights_(robust_weights(at.residual, at.scale)),
      g_(gram(at, weights_, 0, at.residual.size())) {
  add_prior(at, g_);
  weighted_ = weights_.asDiagonal() * at.jacobian;
  for (Eigen::Index k = 0; k < g_.a.rows(); ++k) g_.a(k, k) += 1e-12 * std::max(g_.a(k, k), 1e-12);
  if (g_.a.rows() > 0) factor_.compute(g_.a);
}

Gram Projection::without_fitted(const Eigen::MatrixXd& columns, Eigen::VectorXd& norms) const {
  const Eigen::MatrixXd weighted = weights_.asDiagonal() * columns;
  Gram out{columns.transpose() * weighted, weighted.transpose() * at_.residual};
  norms = out.a.diagonal();
  if (g_.a.rows() == 0) return out;
  const Eigen::MatrixXd cross = weighted_.transpose() * columns;
  const Eigen::MatrixXd solved = factor_.solve(cross);
  out.a -= cross.transpose() * solved;
  out.b -= solved.transpose() * g_.b;
  return out;
}

}  // namespace lab
}  // namespace tractus
