#include "lab/rigs/palpation/trend.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace tractus::lab {

Eigen::RowVectorXd Trend::powers(double t_s) const {
  const double x = (t_s - middle_s_) / half_s_;
  Eigen::RowVectorXd p(kOrders);
  p(0) = 1.0;
  p(1) = x;
  for (int k = 1; k + 1 < kOrders; ++k)
    p(k + 1) = ((2.0 * k + 1.0) * x * p(k) - k * p(k - 1)) / (k + 1.0);  // Bonnet's recursion
  return p;
}

Trend::Trend(std::span<const double> t_s, std::span<const Mat6> whitener) {
  if (t_s.empty()) return;
  middle_s_ = 0.5 * (t_s.front() + t_s.back());
  half_s_ = std::max(0.5 * (t_s.back() - t_s.front()), 1e-9);
  basis_.resize(6 * Eigen::Index(t_s.size()), kNumbers);
  for (std::size_t j = 0; j < t_s.size(); ++j) {
    const Eigen::RowVectorXd p = powers(t_s[j]);
    for (int c = 0; c < 6; ++c)
      basis_.block(6 * Eigen::Index(j), c * kOrders, 6, kOrders) = whitener[j].col(c) * p;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(basis_);
  const Eigen::MatrixXd R = qr.matrixQR().topRows(kNumbers).triangularView<Eigen::Upper>();
  basis_ = qr.householderQ() * Eigen::MatrixXd::Identity(basis_.rows(), kNumbers);
  to_plain_ = R.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(kNumbers, kNumbers));
}

void Trend::remove(Eigen::Ref<Eigen::VectorXd> residual) const {
  if (basis_.rows() != residual.size()) return;
  residual -= basis_ * (basis_.transpose() * residual).eval();
  const auto n = double(residual.size());
  if (n > 2.0 * kNumbers) residual *= std::sqrt(n / (n - kNumbers));
}

Eigen::MatrixXd Trend::at(std::span<const double> t_s, const Eigen::VectorXd& residual) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(6, Eigen::Index(t_s.size()));
  if (basis_.rows() != residual.size()) return out;
  const Eigen::VectorXd numbers = to_plain_ * (basis_.transpose() * residual);
  for (std::size_t k = 0; k < t_s.size(); ++k) {
    const Eigen::RowVectorXd p = powers(t_s[k]);
    for (int c = 0; c < 6; ++c)
      out(c, Eigen::Index(k)) = p.dot(numbers.segment(c * kOrders, kOrders));
  }
  return out;
}

double Trend::variance_between(int channel, double a_s, double b_s) const {
  if (basis_.rows() == 0) return 0.0;
  const auto rows = to_plain_.middleRows(channel * kOrders, kOrders);
  return ((powers(a_s) - powers(b_s)) * rows).squaredNorm();
}

}  // namespace tractus::lab
