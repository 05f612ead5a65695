#include "lab/signal/left_out.hpp"

#include <Eigen/Cholesky>

namespace tractus::lab {

void leave_stretches_out(const Eigen::MatrixXd& basis, int stretches, Eigen::Index unit,
                         Eigen::Ref<Eigen::VectorXd> residual) {
  const Eigen::Index units = residual.size() / unit;
  for (int s = 0; s < stretches; ++s) {
    const Eigen::Index from = units * s / stretches * unit,
                       count = units * (s + 1) / stretches * unit - from;
    const auto part = basis.middleRows(from, count);
    const Eigen::MatrixXd others =
        Eigen::MatrixXd::Identity(basis.cols(), basis.cols()) - part.transpose() * part;
    auto left = residual.segment(from, count);
    left += part * others.ldlt().solve(part.transpose() * left);
  }
}

}  // namespace tractus::lab
