#include "math/savitzky_golay.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/require.hpp"

namespace tractus::math {

SavitzkyGolay::SavitzkyGolay(int window, int order, int derivative)
    : window_(window), derivative_(derivative), weights_(window, window) {
  core::require(window % 2 == 1 && window > order && order >= derivative && derivative >= 0,
                "a Savitzky-Golay window is odd and longer than its order");
  // Abscissae are scaled to -1 … 1, where powers are well conditioned; the scale comes back with
  // the derivative.
  const double half = std::max(1, window / 2);
  Eigen::MatrixXd powers(window, order + 1), wanted(window, order + 1);
  for (int i = 0; i < window; ++i) {
    const double x = (i - window / 2) / half;
    for (int p = 0; p <= order; ++p) {
      powers(i, p) = std::pow(x, p);
      double factor = p >= derivative ? 1.0 : 0.0;
      for (int d = 0; d < derivative; ++d) factor *= p - d;
      wanted(i, p) = factor == 0.0 ? 0.0 : factor * std::pow(x, p - derivative);
    }
  }
  const Eigen::MatrixXd fit = powers.colPivHouseholderQr().solve(
      Eigen::MatrixXd(Eigen::MatrixXd::Identity(window, window)));
  weights_ = wanted * fit / std::pow(half, derivative);
}

std::vector<double> SavitzkyGolay::apply(std::span<const double> y, double dt) const {
  const auto count = static_cast<Eigen::Index>(y.size());
  if (count < window_) return {};
  const Eigen::Map<const Eigen::VectorXd> values(y.data(), count);
  const double scale = std::pow(dt, -derivative_);
  std::vector<double> out(y.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index start = std::clamp<Eigen::Index>(i - window_ / 2, 0, count - window_);
    out[std::size_t(i)] = scale * weights_.row(i - start).dot(values.segment(start, window_));
  }
  return out;
}

}  // namespace tractus::math
