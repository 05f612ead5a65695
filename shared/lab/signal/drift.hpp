/// The slow trend of a sensor over one trial: free in each, found from the residuals.
#pragma once

#include <Eigen/Core>
#include <span>

#include "lab/signal/left_out.hpp"

namespace tractus::lab {

/// Legendre polynomials over a trial, orthonormal under the weights of its residuals.
class Drift {
 public:
  static constexpr int kOrders = 6;  ///< constant to fifth

  Drift() = default;
  /// @param t_s  of each weighted residual. @param sd  by which each was divided.
  Drift(std::span<const double> t_s, std::span<const double> sd);

  /// What of a weighted residual is trend: coefficients of the basis.
  Eigen::VectorXd fit(const Eigen::Ref<const Eigen::VectorXd>& residual) const;
  /// Takes the trend out.
  void remove(Eigen::Ref<Eigen::VectorXd> residual) const;
  /// Of a residual without its trend: each stretch without the trend of the others (signal/left_out.hpp).
  void leave_stretches_out(int stretches, Eigen::Ref<Eigen::VectorXd> residual) const {
    lab::leave_stretches_out(basis_, stretches, 1, residual);
  }
  /// The trend at any times, in the unit of the unweighted residual.
  Eigen::VectorXd at(std::span<const double> t_s, const Eigen::VectorXd& coefficients) const;
  /// Variance of the difference of the fitted trend at two times, when the weighted residuals are
  /// independent of variance 1.
  double variance_between(double a_s, double b_s) const {
    return (to_basis_.transpose() * (powers(a_s) - powers(b_s)).transpose()).squaredNorm();
  }

 private:
  Eigen::RowVectorXd powers(double t_s) const;
  double middle_s_ = 0.0, half_s_ = 1.0;
  Eigen::MatrixXd basis_;     // [residual][order], orthonormal columns, weighted
  Eigen::MatrixXd to_basis_;  // Legendre values → values of the basis, unweighted
};

}  // namespace tractus::lab
