/// Smoothed values and derivatives of evenly spaced samples [SavitzkyGolay1964]: a polynomial is
/// fitted to each window by least squares and evaluated (or differentiated) in it.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace tractus::math {

class SavitzkyGolay {
 public:
  /// @param window  odd number of samples, > order; order ≥ derivative ≥ 0.
  SavitzkyGolay(int window, int order, int derivative);

  /// The derivative at every sample, in units of y per dt^derivative. Within half a window of an
  /// end the polynomial of the first (last) window is evaluated off its middle. Fewer samples than
  /// the window: empty.
  std::vector<double> apply(std::span<const double> y, double dt) const;

  /// Weights of the window's samples for the value at sample `at` of the window (window/2 is the
  /// middle), for dt = 1.
  Eigen::VectorXd weights(int at) const { return weights_.row(at); }
  int window() const { return window_; }

 private:
  int window_, derivative_;
  Eigen::MatrixXd weights_;  // [at][sample of the window]
};

}  // namespace tractus::math
