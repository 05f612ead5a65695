#include "probing/judge.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace blind {
namespace {

bool fixed(const SetPlan& plan, const std::string& name) {
  return std::ranges::any_of(plan.supplied.fixed,
                             [&](const std::string& p) { return p.ends_with("/" + name); });
}

/// Columns: ∂F/∂K, ∂F/∂D, ∂F/∂x0 of each layer and the shift of each inner boundary, those of them
/// that are free.
std::vector<double> sensitivities(const JudgedPoint& p, const SetPlan& plan) {
  std::vector<double> row;
  const auto& layers = plan.truth.layers;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Layer& layer = layers[i];
    const bool inside = p.x_m >= layer.start_m && p.x_m < layer.start_m + layer.thickness_m;
    if (!fixed(plan, "stiffness_N_per_m"))
      row.push_back(inside ? p.x_m - layer.equilibrium_m : 0.0);
    if (!fixed(plan, "damping_Ns_per_m")) row.push_back(inside ? p.v_m_s : 0.0);
    if (!fixed(plan, "equilibrium_m")) row.push_back(inside ? layer.stiffness_N_per_m : 0.0);
    if (i > 0 && !fixed(plan, "start_m")) {
      constexpr double kShift_m = 2e-5;
      const bool near = std::abs(p.x_m - layer.start_m) < kShift_m;
      row.push_back(near ? 1.0 : 0.0);
    }
  }
  return row;
}

}  // namespace

std::vector<double> projected_rms(const std::vector<JudgedPoint>& points, const SetPlan& plan) {
  const auto rows = static_cast<Eigen::Index>(points.size());
  const auto columns = static_cast<Eigen::Index>(sensitivities(points.front(), plan).size());
  const auto effects = static_cast<Eigen::Index>(points.front().added_N.size());
  Eigen::MatrixXd base(rows, std::max<Eigen::Index>(1, columns)), added(rows, effects);
  base.setZero();
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto& p = points[static_cast<std::size_t>(i)];
    const auto row = sensitivities(p, plan);
    for (Eigen::Index c = 0; c < columns; ++c) base(i, c) = row[static_cast<std::size_t>(c)];
    for (Eigen::Index e = 0; e < effects; ++e) added(i, e) = p.added_N[static_cast<std::size_t>(e)];
  }
  for (Eigen::Index c = 0; c < columns; ++c)
    if (const double norm = base.col(c).norm(); norm > 0) base.col(c) /= norm;
  Eigen::MatrixXd left = added;  // a base that is held whole hides nothing
  if (columns > 0) left -= base * base.colPivHouseholderQr().solve(added);
  std::vector<double> out;
  for (Eigen::Index e = 0; e < effects; ++e)
    out.push_back(left.col(e).norm() / std::sqrt(static_cast<double>(rows)));
  return out;
}

}  // namespace blind
