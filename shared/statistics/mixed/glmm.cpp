#include "statistics/mixed/glmm.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/try.hpp"
#include "statistics/distributions/binomial.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

using Array = Eigen::ArrayXd;
constexpr int kNodes = 50;

/// Nodes x and weights w e^{x²} for ∫ f(x) dx, f falling like e^{−x²} (Golub & Welsch 1969).
struct Quadrature {
  Array nodes, log_weights;
  Quadrature() {
    Matrix jacobi = Matrix::Zero(kNodes, kNodes);
    for (int i = 1; i < kNodes; ++i) jacobi(i, i - 1) = jacobi(i - 1, i) = std::sqrt(0.5 * i);
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(jacobi);
    nodes = solver.eigenvalues();
    log_weights = 0.5 * std::log(M_PI) +
                  solver.eigenvectors().row(0).transpose().array().square().log() + nodes.square();
  }
};

struct Group {
  Matrix x;
  Array y, m;

  Array eta(const Vector& beta) const { return (x * beta).array(); }
  double kernel(const Array& eta_at) const {
    Array pi, softplus;
    binomial::parts(eta_at, pi, softplus);
    return (y * eta_at - m * softplus).sum();
  }
};

/// Log-likelihood with its first and second derivatives in (β, σ_u).
struct Value {
  double log_likelihood = 0.0;
  Vector gradient;
  Matrix hessian;
};

/// The smallest change that a sum of so many terms can show.
double rounding_of(double log_likelihood) { return 1e-12 * (1.0 + std::abs(log_likelihood)); }

/// The z where a group's integrand is highest, and the width of the peak: Newton on a concave
/// function, halved where it overshoots.
std::pair<double, double> mode(const Group& group, const Array& base, double sigma) {
  const auto height = [&](double z) { return group.kernel(base + sigma * z) - 0.5 * z * z; };
  double z = 0.0, curvature = 1.0;
  for (int i = 0; i < 100; ++i) {
    const Array pi = binomial::inverse_logit(base + sigma * z);
    const double slope = sigma * (group.y - group.m * pi).sum() - z;
    curvature = 1.0 + sigma * sigma * (group.m * pi * (1.0 - pi)).sum();
    double step = slope / curvature;
    while (height(z + step) < height(z) && std::abs(step) > 1e-9) step *= 0.5;
    z += step;
    if (std::abs(step) < 1e-9) break;
  }
  return {z, 1.0 / std::sqrt(curvature)};
}

/// At each node the rows' residuals and weights, [row][node], and the share each node has of the
/// group's integral.
struct AtNodes {
  Array z, share;
  Eigen::ArrayXXd residuals, weights;
  double log_integral = 0.0;
};

AtNodes at_nodes(const Group& group, const Quadrature& rule, const Array& base, double sigma) {
  const auto [centre, width] = mode(group, base, sigma);
  AtNodes out;
  out.z = centre + std::sqrt(2.0) * width * rule.nodes;
  const Eigen::ArrayXXd eta =
      base.replicate(1, kNodes) + sigma * out.z.transpose().replicate(base.size(), 1);
  Eigen::ArrayXXd pi, softplus;
  binomial::parts(eta, pi, softplus);
  const auto of_rows = [](const Array& column) { return column.replicate(1, kNodes); };
  const Array kernel =
      (eta * of_rows(group.y) - softplus * of_rows(group.m)).colwise().sum().transpose();
  const Array log_terms = rule.log_weights + kernel - 0.5 * out.z.square();
  const double top = log_terms.maxCoeff();
  out.share = (log_terms - top).exp();
  // √2 width dx, over the √(2π) of the normal density.
  out.log_integral = top + std::log(out.share.sum() * width / std::sqrt(M_PI));
  out.share /= out.share.sum();
  out.residuals = of_rows(group.y) - pi * of_rows(group.m);
  out.weights = pi * (1.0 - pi) * of_rows(group.m);
  return out;
}

/// Adds E[g], E[g gᵀ − Dᵀ W D] − E[g] E[g]ᵀ over the nodes, g = Dᵀ r, D = [X, z].
void add_group(const Group& group, const Quadrature& rule, const Vector& beta, double sigma,
               Value& out) {
  const Eigen::Index p = beta.size();
  const AtNodes at = at_nodes(group, rule, group.eta(beta), sigma);
  out.log_likelihood += at.log_integral;
  Matrix g(p + 1, kNodes);
  g.topRows(p) = group.x.transpose() * at.residuals.matrix();
  g.row(p) = (at.residuals.colwise().sum() * at.z.transpose()).matrix();
  const Vector mean = g * at.share.matrix();
  const Vector share_z = at.share * at.z;
  const Vector w = at.weights.matrix() * at.share.matrix();
  const Vector w_z = group.x.transpose() * (at.weights.matrix() * share_z);
  Matrix information(p + 1, p + 1);
  information.topLeftCorner(p, p) = group.x.transpose() * w.asDiagonal() * group.x;
  information.col(p).head(p) = w_z;
  information.row(p).head(p) = w_z.transpose();
  information(p, p) = (at.weights.colwise().sum().transpose() * at.share * at.z.square()).sum();
  out.gradient += mean;
  out.hessian +=
      g * at.share.matrix().asDiagonal() * g.transpose() - information - mean * mean.transpose();
}

Value value_at(const std::vector<Group>& groups, const Quadrature& rule, const Vector& theta) {
  const Eigen::Index p = theta.size() - 1;
  Value out{0.0, Vector::Zero(p + 1), Matrix::Zero(p + 1, p + 1)};
  for (const auto& group : groups) add_group(group, rule, theta.head(p), theta[p], out);
  return out;
}

/// Newton with damping until steps are rounding. False: it ran away or stuck.
bool maximise(const std::vector<Group>& groups, const Quadrature& rule, Vector& theta,
              Value& value) {
  value = value_at(groups, rule, theta);
  double damping = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Index size = theta.size();
    const Eigen::LLT<Matrix> llt(damping * Matrix::Identity(size, size) - value.hessian);
    const Vector step = llt.solve(value.gradient);
    const Value next = value_at(groups, rule, theta + step);
    const bool better =
        llt.info() == Eigen::Success &&
        next.log_likelihood >= value.log_likelihood - rounding_of(value.log_likelihood);
    if (!better) {
      damping = std::max(1e-3, 4.0 * damping);
      if (damping > 1e8) return false;
      continue;
    }
    theta += step;
    value = next;
    damping *= damping > 1e-3 ? 0.25 : 0.0;
    if (theta.cwiseAbs().maxCoeff() > 1e3) return false;
    if (damping == 0.0 && step.cwiseAbs().maxCoeff() < 1e-11) return true;
  }
  return false;
}

/// A group's rows, those with equal columns added up: the likelihood keeps its shape.
Group merged(const Design& design, const Counts& counts, std::vector<Eigen::Index> rows) {
  const auto compare = [&](Eigen::Index a, Eigen::Index b) {
    for (Eigen::Index j = 0; j < design.columns.cols(); ++j)
      if (design.columns(a, j) != design.columns(b, j))
        return design.columns(a, j) < design.columns(b, j) ? -1 : 1;
    return 0;
  };
  std::ranges::stable_sort(rows, [&](auto a, auto b) { return compare(a, b) < 0; });
  std::vector<Eigen::Index> kept;
  std::vector<double> successes, trials;
  for (const auto row : rows) {
    if (kept.empty() || compare(kept.back(), row) != 0) {
      kept.push_back(row);
      successes.push_back(0.0);
      trials.push_back(0.0);
    }
    successes.back() += counts.successes[row];
    trials.back() += counts.trials[row];
  }
  const auto size = static_cast<Eigen::Index>(kept.size());
  return {design.columns(kept, Eigen::all), Eigen::Map<Array>(successes.data(), size),
          Eigen::Map<Array>(trials.data(), size)};
}

std::vector<Group> groups_of(const Design& design, const Counts& counts,
                             const std::vector<std::string>& labels,
                             std::vector<std::string>& names) {
  std::map<std::string, std::vector<Eigen::Index>> rows;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    auto& own = rows[labels[i]];
    if (own.empty()) names.push_back(labels[i]);
    own.push_back(static_cast<Eigen::Index>(i));
  }
  std::vector<Group> out;
  for (const auto& name : names) out.push_back(merged(design, counts, rows.at(name)));
  return out;
}

void add_tests(const Matrix& covariance, Glmm& out) {
  out.covariance = covariance.topLeftCorner(out.coefficients.size(), out.coefficients.size());
  out.standard_errors = out.covariance.diagonal().cwiseSqrt();
  out.z = out.coefficients.cwiseQuotient(out.standard_errors);
  out.p = out.z.unaryExpr([](double z) { return 2.0 * normal_upper(std::abs(z)); });
}

}  // namespace

core::Result<Glmm> logistic_mixed(const Design& design, const Counts& counts,
                                  const std::vector<std::string>& labels) {
  core::require(labels.size() == static_cast<std::size_t>(counts.successes.size()),
                "every row has a group");
  const auto plain = TRY(logistic(design, counts));
  Glmm out;
  out.names = design.names;
  const auto groups = groups_of(design, counts, labels, out.groups);
  if (groups.size() < 2)
    return core::Error{core::Errc::bad_input,
                       "one group: the spread between groups cannot be estimated"};
  const Quadrature rule;
  const Eigen::Index p = plain.coefficients.size();
  Vector theta(p + 1);
  theta << plain.coefficients, 0.5;
  Value value;
  const bool found = maximise(groups, rule, theta, value);
  const double binomial =
      plain.log_likelihood -
      value_at(groups, rule, (Vector(p + 1) << plain.coefficients, 0.0).finished()).log_likelihood;
  // σ_u = 0 is always stationary; the estimate is there when nothing beyond it is higher.
  const bool at_zero = value.log_likelihood + binomial <=
                       plain.log_likelihood + std::max(1e-10, rounding_of(plain.log_likelihood));
  if (!found && !at_zero)
    return core::Error{core::Errc::out_of_range,
                       "the likelihood has no maximum: the outcomes may be separated by group"};
  if (at_zero) {
    out.coefficients = plain.coefficients;
    out.log_likelihood = plain.log_likelihood;
    out.sigma_u_se = std::numeric_limits<double>::quiet_NaN();
    add_tests(plain.covariance, out);
    return out;
  }
  out.coefficients = theta.head(p);
  out.sigma_u = std::abs(theta[p]);
  out.log_likelihood = value.log_likelihood + binomial;
  const Matrix covariance = (-value.hessian).ldlt().solve(Matrix::Identity(p + 1, p + 1));
  out.sigma_u_se = std::sqrt(covariance(p, p));
  add_tests(covariance, out);
  return out;
}

}  // namespace statistics
}  // namespace tractus
