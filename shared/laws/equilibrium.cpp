#include "laws/equilibrium.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "laws/trust_region.hpp"

namespace tractus {
namespace laws {
namespace {

using math::Mat2;
using math::Mat3;
using math::Vec2;
using math::Vec3;

constexpr double kTolerance_N = 1e-3;  // [Zoller2020, "Iterative pedicle probe bending"]
// Newton goes on to here when it can, so that the answer depends neither on where it started nor on
// how it came: a residual is up to k⁻¹ times as much deflection, and that many walls' stiffness
// more in force.
constexpr double kPolished_N = 1e-7;
constexpr double kRounding_N = 2e-6;  // what misses less and falls no more is the field's rounding
constexpr int kMostIterations = 60;

/// One trial bending and what follows from it.
struct Bending {
  Vec2 deflection_m = Vec2::Zero();
  Vec2 residual_N = Vec2::Zero();         // r
  Mat2 stiffness_N_per_m = Mat2::Zero();  // A = ∂r/∂δ
  std::array<Vec3, kMaxPoints> force_H_N;

  double miss_N() const { return residual_N.norm(); }
};

class Solver {
 public:
  Solver(const Beam& beam, const math::Pose& X_VH)
      : beam_(beam), origin_(X_VH.p), R_VH_(X_VH.q.toRotationMatrix()) {
    const auto& spacing = beam.field->geometry().spacing_m;
    voxel_m_ = spacing.minCoeff();
  }

  Equilibrium solve(const Vec2& start_m, std::span<Vec3> force_H_N) {
    bend(start_m, *now_);
    keep_best();
    // Short first, so that where a rest has ceased to be, the shank slides to the next one down and
    // is not thrown over it.
    double radius = 0.1 * voxel_m_;
    while (iterations_ < kMostIterations && now_->miss_N() >= kTolerance_N) step(radius);
    while (iterations_ < kMostIterations && now_->miss_N() > kPolished_N) {
      if (polish()) continue;
      if (now_->miss_N() < kRounding_N) break;
      step(radius);  // a shelf: little force over a long way, and the rest at its end
    }
    std::copy_n(best_force_.begin(), force_H_N.size(), force_H_N.begin());
    return {best_deflection_m_, iterations_, best_miss_N_ < kTolerance_N};
  }

 private:
  /// The forces at δ, their sum and its derivative.
  void bend(const Vec2& deflection_m, Bending& out) {
    ++iterations_;
    out.deflection_m = deflection_m;
    const Shank& shank = *beam_.shank;
    out.residual_N = shank.stiffness_N_per_m * deflection_m;
    out.stiffness_N_per_m = shank.stiffness_N_per_m * Mat2::Identity();
    const Vec3 sideways = R_VH_.leftCols<2>() * deflection_m;
    for (std::size_t i = 0; i < std::size_t(shank.points); ++i) {
      const double shape = shank.shape[i];
      Vec3 p_V = origin_ + shank.z_m[i] * R_VH_.col(2) + shape * sideways;
      if (!shank.straight) p_V += R_VH_.leftCols<2>() * shank.rest_m[i];
      const Eigen::Matrix<double, 3, 2> lateral = R_VH_.leftCols<2>();
      if (beam_.contact) [[unlikely]] {
        const ForceSample at = beam_.contact->at(i, p_V);
        out.force_H_N[i] = R_VH_.transpose() * at.force_N;
        out.stiffness_N_per_m -=
            shape * shape * (lateral.transpose() * (at.jacobian_N_per_m * lateral));
      } else {
        const volume::FieldSample at = beam_.field->sample(p_V);
        out.force_H_N[i] = beam_.force_factor_Nm * (R_VH_.transpose() * at.g_per_m);
        out.stiffness_N_per_m -= shape * shape * beam_.force_factor_Nm *
                                 (lateral.transpose() * (at.jacobian_per_m2 * lateral));
      }
      out.residual_N -= shape * out.force_H_N[i].head<2>();
    }
  }

  /// One trial step from `now_`, taken or not.
  void step(double& radius) {
    const Mat2 A = 0.5 * (now_->stiffness_N_per_m + now_->stiffness_N_per_m.transpose());
    const Vec2& r = now_->residual_N;
    const Vec2 s = trust_region_step(A, r, radius);
    bend(now_->deflection_m + s, *next_);
    const double promised = -(r.dot(s) + 0.5 * s.dot(A * s));
    const double bend_of_work =
        s.dot((now_->stiffness_N_per_m - next_->stiffness_N_per_m) * s) / 12.0;
    const double fell = -0.5 * (r + next_->residual_N).dot(s) - bend_of_work;
    const double truth = promised > 0.0 ? fell / promised : -1.0;
    if (truth < 0.25)
      radius = 0.25 * s.norm();
    else if (truth > 0.75)
      radius = std::max(radius, 2.5 * s.norm());
    if (truth > 0.25) {
      std::swap(now_, next_);
      keep_best();
    }
  }

  /// A Newton step with all of A, taken if |r| falls as it must near a rest. There the symmetric
  /// part alone, which the search needs, would let the published field's curl hold r up at a
  /// hundredth a step. Where a rest has just ceased to be, |r| is small too, but does not fall so.
  bool polish() {
    const Vec2 s = -now_->stiffness_N_per_m.inverse() * now_->residual_N;
    if (!(s.norm() < 0.5 * voxel_m_)) return false;
    bend(now_->deflection_m + s, *next_);
    if (!(next_->miss_N() < 0.5 * now_->miss_N())) return false;
    std::swap(now_, next_);
    keep_best();
    return true;
  }

  void keep_best() {
    if (!(now_->miss_N() < best_miss_N_)) return;
    best_miss_N_ = now_->miss_N();
    best_deflection_m_ = now_->deflection_m;
    best_force_ = now_->force_H_N;
  }

  const Beam& beam_;
  const Vec3 origin_;
  const Mat3 R_VH_;
  double voxel_m_;
  int iterations_ = 0;
  Bending a_, b_;
  Bending *now_ = &a_, *next_ = &b_;
  double best_miss_N_ = HUGE_VAL;
  Vec2 best_deflection_m_ = Vec2::Zero();
  std::array<Vec3, kMaxPoints> best_force_;
};

}  // namespace

Equilibrium equilibrium(const Beam& beam, const math::Pose& X_VH, const Vec2& start_m,
                        std::span<Vec3> force_H_N) noexcept {
  return Solver(beam, X_VH).solve(start_m, force_H_N);
}

}  // namespace laws
}  // namespace tractus
