/// The slow trend of a six-axis sensor over one trial: free in each, found from the residuals.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "lab/rigs/palpation/recording.hpp"
#include "lab/signal/left_out.hpp"

namespace tractus::lab {

/// Legendre polynomials over a trial for each of the six channels, as the whitened residuals see
/// them.
class Trend {
 public:
  static constexpr int kOrders = 6;  ///< constant to fifth
  static constexpr int kNumbers = 6 * kOrders;

  Trend() = default;
  /// @param t_s  of each output. @param whitener  of each output.
  Trend(std::span<const double> t_s, std::span<const Mat6> whitener);

  /// Takes out of a whitened residual (six numbers per output) what is trend, and scales the rest
  /// so that noise keeps its variance.
  void remove(Eigen::Ref<Eigen::VectorXd> residual) const;
  /// Of a residual without its trend: each stretch without the trend of the others (signal/left_out.hpp).
  void leave_stretches_out(int stretches, Eigen::Ref<Eigen::VectorXd> residual) const {
    if (basis_.rows() == residual.size()) lab::leave_stretches_out(basis_, stretches, 6, residual);
  }
  /// The trend in a whitened residual at any times, [channel][time], N and N·m.
  Eigen::MatrixXd at(std::span<const double> t_s, const Eigen::VectorXd& residual) const;
  /// Variance of the difference of a channel's trend at two times, (N or N·m)², when the whitened
  /// residuals are independent of variance 1.
  double variance_between(int channel, double a_s, double b_s) const;

 private:
  Eigen::RowVectorXd powers(double t_s) const;
  double middle_s_ = 0.0, half_s_ = 1.0;
  Eigen::MatrixXd basis_;     // [residual][number], orthonormal columns
  Eigen::MatrixXd to_plain_;  // coefficients of the basis → of channel and order
};

}  // namespace tractus::lab
