#include "statistics/mixed/lmm.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <map>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

using Real = long double;
using Square = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// All that the likelihood needs of [X y]: cross products within groups, and group means.
/// A matrix that acts as `within` across a group and as `between[i]` along its mean gives
/// [X y]ᵀ f [X y] = within · W + Σ between_i n_i m_i m_iᵀ.
struct GroupMoments {
  Eigen::Index p = 0;
  Real n = 0;
  Column sizes;                     // per group
  Square within;                    // [p + 1][p + 1]
  Square means;                     // [p + 1][group]
  std::vector<std::string> groups;  // in order of first appearance

  Square cross(Real across, const Column& between) const {
    return across * within + means * between.cwiseProduct(sizes).asDiagonal() * means.transpose();
  }
};

GroupMoments moments(const Design& design, const Vector& y,
                     const std::vector<std::string>& labels) {
  GroupMoments m;
  m.p = design.columns.cols();
  m.n = static_cast<Real>(y.size());
  std::map<std::string, Eigen::Index> place;
  for (const auto& label : labels)
    if (place.try_emplace(label, static_cast<Eigen::Index>(m.groups.size())).second)
      m.groups.push_back(label);
  const auto k = static_cast<Eigen::Index>(m.groups.size());
  Square all(y.size(), m.p + 1);
  all << design.columns.cast<Real>(), y.cast<Real>();
  m.sizes = Column::Zero(k);
  m.means = Square::Zero(m.p + 1, k);
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const Eigen::Index g = place.at(labels[static_cast<std::size_t>(i)]);
    m.sizes[g] += 1;
    m.means.col(g) += all.row(i).transpose();
  }
  m.means = (m.means * m.sizes.cwiseInverse().asDiagonal()).eval();
  for (Eigen::Index i = 0; i < y.size(); ++i)
    all.row(i) -= m.means.col(place.at(labels[static_cast<std::size_t>(i)])).transpose();
  m.within = all.transpose() * all;
  return m;
}

/// Generalised least squares at one λ, in units of σ².
struct Gls {
  Square a, a_inverse;  // Xᵀ V⁻¹ X
  Column beta;
  Real rss = 0;
  Column contrast;  // (−β, 1): [X y] · contrast is the residual
};

Gls gls(const GroupMoments& m, Real lambda) {
  const Column between = (Column::Ones(m.sizes.size()) + lambda * m.sizes).cwiseInverse();
  const Square cross = m.cross(1, between);
  Gls out;
  out.a = cross.topLeftCorner(m.p, m.p);
  out.a_inverse = out.a.ldlt().solve(Square::Identity(m.p, m.p));
  out.beta = out.a.ldlt().solve(cross.col(m.p).head(m.p));
  out.contrast.resize(m.p + 1);
  out.contrast << -out.beta, Real(1);
  out.rss = out.contrast.dot(cross * out.contrast);
  return out;
}

Real criterion(const GroupMoments& m, Real lambda, bool reml) {
  const Gls fit = gls(m, lambda);
  const Real df = reml ? m.n - static_cast<Real>(m.p) : m.n;
  Real out = df * (1 + std::log(2 * Real(M_PIl) * fit.rss / df)) +
             (Column::Ones(m.sizes.size()) + lambda * m.sizes).array().log().sum();
  if (reml) out += fit.a.ldlt().vectorD().array().log().sum();
  return out;
}

/// d criterion / dλ: RSS' by the envelope theorem, (Xᵀ V⁻¹ X)' exactly.
Real slope(const GroupMoments& m, Real lambda, bool reml) {
  const Gls fit = gls(m, lambda);
  const Column inverse = (Column::Ones(m.sizes.size()) + lambda * m.sizes).cwiseInverse();
  const Square change = -m.cross(0, inverse.cwiseAbs2().cwiseProduct(m.sizes));
  const Real df = reml ? m.n - static_cast<Real>(m.p) : m.n;
  Real out = df * fit.contrast.dot(change * fit.contrast) / fit.rss + m.sizes.dot(inverse);
  if (reml) out += (fit.a_inverse * change.topLeftCorner(m.p, m.p)).trace();
  return out;
}

/// λ of the smallest criterion: a coarse search over θ = √λ (the criterion may have two minima),
/// then bisection on the slope to the last digit.
Real best_lambda(const GroupMoments& m, bool reml) {
  Real best = 0, least = criterion(m, 0, reml), low = 0, high = 1e-8L;
  Real before = 0;
  for (Real lambda = 1e-6L; lambda < 1e10L; lambda *= 1.8L) {
    const Real here = criterion(m, lambda, reml);
    if (here < least) {
      least = here;
      best = lambda;
      low = before;
      high = lambda * 1.8L;
    }
    before = lambda;
  }
  if (best == 0 && slope(m, 0, reml) >= 0) return 0;
  if (best == 0) high = 1e-6L;
  for (int i = 0; i < 200 && high - low > 1e-18L * high; ++i) {
    const Real middle = (low + high) / 2;
    (slope(m, middle, reml) < 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// The spectral picture of V⁻¹ V_a V⁻¹ … at (τ², σ²): V_1 = ZZᵀ has (0, n_i), V_2 = I has (1, 1).
struct Spectrum {
  Real across;
  Column between;
  Spectrum operator*(const Spectrum& o) const {
    return {across * o.across, between.cwiseProduct(o.between)};
  }
};

LmmCurvature curvature(const GroupMoments& m, const Gls& fit, Real tau2, Real sigma2) {
  const Column ones = Column::Ones(m.sizes.size());
  const Spectrum inverse{1 / sigma2, (sigma2 * ones + tau2 * m.sizes).cwiseInverse()};
  const std::array<Spectrum, 2> v = {Spectrum{0, m.sizes}, Spectrum{1, ones}};
  const Real groups = static_cast<Real>(m.sizes.size());
  const Square c = sigma2 * fit.a_inverse;
  const auto cross = [&](const Spectrum& s) { return m.cross(s.across, s.between); };
  const auto trace = [&](const Spectrum& s) { return s.across * (m.n - groups) + s.between.sum(); };
  const auto x_part = [&](const Square& s) { return Square(s.topLeftCorner(m.p, m.p)); };
  std::array<Square, 2> d;       // Xᵀ V⁻¹ V_a V⁻¹ X
  std::array<Column, 2> toward;  // Xᵀ V⁻¹ V_a V⁻¹ r
  for (std::size_t a = 0; a < 2; ++a) {
    const Square one = cross(inverse * v[a] * inverse);
    d[a] = x_part(one);
    toward[a] = (one * fit.contrast).head(m.p);
  }
  Eigen::Matrix2d observed, expected;
  std::array<std::array<Square, 2>, 2> q;  // Xᵀ V⁻¹ V_a V⁻¹ V_b V⁻¹ X
  LmmCurvature out;
  for (std::size_t a = 0; a < 2; ++a) {
    for (std::size_t b = 0; b < 2; ++b) {
      const Square cross_three = cross(inverse * v[a] * inverse * v[b] * inverse);
      q[a][b] = x_part(cross_three);
      const Real squares = trace(inverse * v[a] * inverse * v[b]) - 2 * (c * q[a][b]).trace() +
                           (c * d[a] * c * d[b]).trace();
      const Real quadratic =
          fit.contrast.dot(cross_three * fit.contrast) - toward[a].dot(c * toward[b]);
      const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
      observed(i, j) = static_cast<double>(2 * quadratic - squares);
      expected(i, j) = static_cast<double>(squares);
    }
    out.covariance_slope[a] = (c * d[a] * c).cast<double>();
  }
  out.variance_covariance = 2.0 * observed.inverse();
  out.expected_covariance = 2.0 * expected.inverse();
  Square bias = Square::Zero(m.p, m.p);
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b)
      bias += static_cast<Real>(out.expected_covariance(static_cast<Eigen::Index>(a),
                                                        static_cast<Eigen::Index>(b))) *
              (q[a][b] - d[a] * c * d[b]);
  out.bias = bias.cast<double>();
  return out;
}

core::Result<GroupMoments> prepared(const Design& design, const Vector& response,
                                    const std::vector<std::string>& labels) {
  core::require(labels.size() == static_cast<std::size_t>(response.size()),
                "every observation has a group");
  TRY(check(design, response));
  if (!collinear_columns(design).empty()) return collinear_error(design);
  GroupMoments m = moments(design, response, labels);
  if (m.groups.size() < 2)
    return core::Error{core::Errc::bad_input,
                       "one group: the spread between groups cannot be estimated"};
  if (static_cast<Eigen::Index>(m.groups.size()) == response.size())
    return core::Error{core::Errc::bad_input,
                       "every group has one observation: within and between cannot be told apart"};
  const Real least = m.within(m.p, m.p) + m.means.row(m.p).squaredNorm();
  if (!(gls(m, 0).rss > 1e-26L * least))
    return core::Error{core::Errc::bad_input,
                       "the columns fit the response exactly: no error left"};
  return m;
}

void add_tests(const GroupMoments& m, const Gls& fit, Lmm& out) {
  const Eigen::Index p = m.p;
  out.standard_errors = out.covariance.diagonal().cwiseSqrt();
  out.t = out.coefficients.cwiseQuotient(out.standard_errors);
  out.df = Vector::Constant(p, static_cast<double>(m.n) - static_cast<double>(p));
  out.curvature = curvature(m, fit, out.tau_squared, out.sigma_squared);
  if (out.tau_squared > 0.0) {
    for (Eigen::Index j = 0; j < p; ++j) {
      const auto& slope_of = out.curvature.covariance_slope;
      const Eigen::Vector2d g(slope_of[0](j, j), slope_of[1](j, j));
      const double v = out.covariance(j, j);
      out.df[j] = 2.0 * v * v / g.dot(out.curvature.variance_covariance * g);
    }
  }
  out.p.resize(p);
  for (Eigen::Index j = 0; j < p; ++j) out.p[j] = student_t_two_sided(out.t[j], out.df[j]);
}

}  // namespace

core::Result<Lmm> lmm(const Design& design, const Vector& response,
                      const std::vector<std::string>& labels) {
  const auto prepared_moments = TRY(prepared(design, response, labels));
  const GroupMoments& m = prepared_moments;
  const Real lambda = best_lambda(m, true), df = m.n - static_cast<Real>(m.p);
  const Gls fit = gls(m, lambda);
  const Real sigma2 = fit.rss / df;
  Lmm out;
  out.names = design.names;
  out.groups = m.groups;
  out.coefficients = fit.beta.cast<double>();
  out.sigma_squared = static_cast<double>(sigma2);
  out.tau_squared = static_cast<double>(lambda * sigma2);
  out.icc = static_cast<double>(lambda / (1 + lambda));
  out.covariance = (sigma2 * fit.a_inverse).cast<double>();
  const Real least = criterion(m, lambda, true);
  out.criterion = static_cast<double>(least);
  out.log_likelihood = -0.5 * out.criterion;
  out.rlrt = std::max(0.0, static_cast<double>(criterion(m, 0, true) - least));
  out.rlrt_p = lambda > 0 ? 0.5 * chi_squared_upper(out.rlrt, 1.0) : 1.0;
  const Column shrink = (lambda * m.sizes.array() / (1 + lambda * m.sizes.array())).matrix();
  out.group_effects = shrink.cwiseProduct(m.means.transpose() * fit.contrast).cast<double>();
  if (!out.covariance.allFinite() || !(out.covariance.diagonal().minCoeff() > 1e-300) ||
      !std::isfinite(out.criterion) || !(out.sigma_squared > 0.0))
    return core::Error{core::Errc::out_of_range,
                       "the numbers are too large or too small for sums of squares: rescale them"};
  add_tests(m, fit, out);
  return out;
}

core::Result<LmmMl> lmm_ml(const Design& design, const Vector& response,
                           const std::vector<std::string>& labels) {
  const auto m = TRY(prepared(design, response, labels));
  const Real lambda = best_lambda(m, false);
  const Gls fit = gls(m, lambda);
  LmmMl out;
  out.coefficients = fit.beta.cast<double>();
  out.sigma_squared = static_cast<double>(fit.rss / m.n);
  out.tau_squared = static_cast<double>(lambda * fit.rss / m.n);
  out.deviance = static_cast<double>(criterion(m, lambda, false));
  const double parameters = static_cast<double>(m.p) + 2.0;
  out.aic = out.deviance + 2.0 * parameters;
  out.bic = out.deviance + std::log(static_cast<double>(m.n)) * parameters;
  return out;
}

}  // namespace statistics
}  // namespace tractus
