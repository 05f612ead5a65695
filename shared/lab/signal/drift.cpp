#include "lab/signal/drift.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace tractus::lab {

Drift::Drift(std::span<const double> t_s, std::span<const double> sd) {
  const auto n = Eigen::Index(t_s.size());
  const auto [from, to] = std::ranges::minmax(t_s);
  middle_s_ = 0.5 * (from + to);
  half_s_ = std::max(0.5 * (to - from), 1e-9);
  Eigen::MatrixXd weighted(n, kOrders);
  for (Eigen::Index k = 0; k < n; ++k)
    weighted.row(k) = powers(t_s[std::size_t(k)]) / sd[std::size_t(k)];
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(weighted);
  basis_ = qr.householderQ() * Eigen::MatrixXd::Identity(n, kOrders);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(kOrders);
  to_basis_ = r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(kOrders, kOrders));
}

Eigen::RowVectorXd Drift::powers(double t_s) const {
  const double u = (t_s - middle_s_) / half_s_;
  Eigen::RowVectorXd p(kOrders);
  p(0) = 1.0;
  p(1) = u;
  for (int k = 2; k < kOrders; ++k)  // Bonnet's recursion
    p(k) = ((2.0 * k - 1.0) * u * p(k - 1) - (k - 1.0) * p(k - 2)) / double(k);
  return p;
}

Eigen::VectorXd Drift::fit(const Eigen::Ref<const Eigen::VectorXd>& residual) const {
  return basis_.transpose() * residual;
}

void Drift::remove(Eigen::Ref<Eigen::VectorXd> residual) const {
  residual -= basis_ * fit(residual);
}

Eigen::VectorXd Drift::at(std::span<const double> t_s, const Eigen::VectorXd& coefficients) const {
  const Eigen::VectorXd legendre = to_basis_ * coefficients;
  Eigen::VectorXd out(Eigen::Index(t_s.size()));
  for (std::size_t k = 0; k < t_s.size(); ++k) out(Eigen::Index(k)) = powers(t_s[k]).dot(legendre);
  return out;
}

}  // namespace tractus::lab
