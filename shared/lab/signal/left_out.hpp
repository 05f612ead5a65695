/// What numbers that are free in each trial predict of the trial they are fitted to.
#pragma once

#include <Eigen/Core>

namespace tractus::lab {

/// Replaces each of `stretches` equal stretches of a residual, from which the columns of `basis` were fitted out, by what the
/// same fit to the other stretches leaves there: e_b ← (I − B_b B_bᵀ)⁻¹ e_b, the leave-out residual of linear least squares
/// [Cook1982, section 2.2], by Woodbury's identity.
/// @param basis  orthonormal columns. @param unit  residuals that are not parted, one after the other.
void leave_stretches_out(const Eigen::MatrixXd& basis, int stretches, Eigen::Index unit,
                         Eigen::Ref<Eigen::VectorXd> residual);

}  // namespace tractus::lab
