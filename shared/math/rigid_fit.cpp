#include "math/rigid_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace tractus::math {
namespace {

Vec3 centre(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / double(points.size());
}

}  // namespace

Pose rigid_fit(std::span<const Vec3> p_A, std::span<const Vec3> p_B) {
  const Vec3 centre_A = centre(p_A), centre_B = centre(p_B);
  Mat3 covariance = Mat3::Zero();
  for (std::size_t i = 0; i < p_A.size(); ++i)
    covariance += (p_A[i] - centre_A) * (p_B[i] - centre_B).transpose();
  const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 keep = Mat3::Identity();  // a turn, not a mirror image
  keep(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Mat3 turn = svd.matrixU() * keep * svd.matrixV().transpose();
  return {centre_A - turn * centre_B, Quat(turn).normalized()};
}

Vec3 extents(std::span<const Vec3> points) {
  const Vec3 middle = centre(points);
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : points) spread += (p - middle) * (p - middle).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(spread, Eigen::EigenvaluesOnly);  // ascending
  return axes.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace tractus::math
