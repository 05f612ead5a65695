#include "lab/identify/residual_model.hpp"

namespace tractus {
namespace lab {

void ResidualModel::residuals_near(const Structure& structure, std::span<const double>,
                                   const std::vector<std::vector<double>>& points, int trial,
                                   Eigen::Ref<Eigen::MatrixXd> out) const {
  for (std::size_t k = 0; k < points.size(); ++k)
    residuals(structure, points[k], trial, out.col(Eigen::Index(k)));
}

}  // namespace lab
}  // namespace tractus
