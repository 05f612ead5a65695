#include "lab/signal/left_out.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>

namespace tractus::lab {
namespace {

/// Each stretch against a fit to the other stretches, solved anew.
TEST(LeaveStretchesOut, LeavesWhatAFitToTheOtherStretchesLeaves) {
  constexpr Eigen::Index kUnits = 40, kUnit = 3, kColumns = 5;
  constexpr int kStretches = 7;
  const Eigen::MatrixXd columns = Eigen::MatrixXd::Random(kUnits * kUnit, kColumns);
  const Eigen::VectorXd measured = Eigen::VectorXd::Random(kUnits * kUnit);
  const Eigen::MatrixXd basis = Eigen::HouseholderQR<Eigen::MatrixXd>(columns).householderQ() *
                                Eigen::MatrixXd::Identity(columns.rows(), kColumns);
  Eigen::VectorXd left = measured - basis * (basis.transpose() * measured);
  leave_stretches_out(basis, kStretches, kUnit, left);
  for (int s = 0; s < kStretches; ++s) {
    const Eigen::Index from = kUnits * s / kStretches * kUnit,
                       end = kUnits * (s + 1) / kStretches * kUnit;
    Eigen::MatrixXd others(columns.rows() - (end - from), kColumns);
    others << columns.topRows(from), columns.bottomRows(columns.rows() - end);
    Eigen::VectorXd seen(others.rows());
    seen << measured.head(from), measured.tail(measured.size() - end);
    const Eigen::VectorXd fitted = others.colPivHouseholderQr().solve(seen);
    for (Eigen::Index k = from; k < end; ++k)
      EXPECT_NEAR(left(k), measured(k) - columns.row(k) * fitted, 1e-10);
  }
}

}  // namespace
}  // namespace tractus::lab
