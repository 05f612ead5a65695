/// What a fitted structure cannot imitate of further columns.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// The normal equations of what is fitted already, solved once for all that is tried on top of it.
class Projection {
 public:
  /// @param at  with a jacobian of its own point; must outlive this.
  explicit Projection(const Solution& at);

  /// Normal equations of more columns with what is fitted projected out.
  /// @param norms  set to the columns' squares before that.
  Gram without_fitted(const Eigen::MatrixXd& columns, Eigen::VectorXd& norms) const;

 private:
  const Solution& at_;
  Eigen::VectorXd weights_;
  Gram g_;
  Eigen::MatrixXd weighted_;
  Eigen::LDLT<Eigen::MatrixXd> factor_;
};

}  // namespace tractus::lab
