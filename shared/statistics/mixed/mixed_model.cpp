#include "statistics/mixed/mixed_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <map>
#include <numbers>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/mixed/derivatives.hpp"

namespace tractus {
namespace statistics {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using core::Errc;
using core::Error;

constexpr double kStep = 2e-3;      // of differences in θ, whose entries are of order 1
constexpr double kSingular = 1e-4;  // as lme4's isSingular: relative to σ
constexpr Eigen::Index kMostEffects = 200'000;

/// One term with its levels counted and its columns scaled to a root mean square of 1.
struct ScaledTerm {
  const RandomTerm* from = nullptr;
  std::vector<std::string> levels;
  std::vector<Eigen::Index> level_of;  // per observation
  Vector scale;                        // per effect
  Eigen::Index first = 0;              // column of Z
  Eigen::Index effects() const { return scale.size(); }
  Eigen::Index size() const { return effects() * Eigen::Index(levels.size()); }
  /// How many entries of θ it has.
  Eigen::Index parameters() const { return effects() * (effects() + 1) / 2; }
};

ScaledTerm scaled(const RandomTerm& term) {
  ScaledTerm out;
  out.from = &term;
  std::map<std::string_view, Eigen::Index> place;
  for (const auto& label : term.labels) {
    const auto [at, fresh] = place.try_emplace(label, Eigen::Index(out.levels.size()));
    if (fresh) out.levels.push_back(label);
    out.level_of.push_back(at->second);
  }
  out.scale = (term.columns.colwise().squaredNorm() / double(term.columns.rows())).cwiseSqrt();
  return out;
}

/// Λ_t of a term, from its part of θ in column order.
Matrix triangle(const ScaledTerm& term, const Vector& theta, Eigen::Index& at) {
  Matrix out = Matrix::Zero(term.effects(), term.effects());
  for (Eigen::Index c = 0; c < term.effects(); ++c)
    for (Eigen::Index r = c; r < term.effects(); ++r) out(r, c) = theta[at++];
  return out;
}

/// What one θ gives, in units of the scaled columns.
struct At {
  double log_det_L = 0.0;   // ln|L|²
  double log_det_RX = 0.0;  // ln|R_X|²
  double rss = 0.0;         // r²
  Vector beta;
  Vector u;           // spherical random effects
  Matrix covariance;  // (R_XᵀR_X)⁻¹
};

/// The penalised least squares problem: cross products once, a factorisation per θ.
class Problem {
 public:
  Problem(const Design& design, const Vector& y, const std::vector<RandomTerm>& terms);

  At solve(const Vector& theta, bool whole) const;
  double criterion(const Vector& theta, Likelihood how) const;
  Vector start() const;

  const std::vector<ScaledTerm>& terms() const { return terms_; }
  const Vector& column_scale() const { return column_scale_; }
  double df(Likelihood how) const { return how == Likelihood::reml ? n_ - double(p_) : n_; }
  double centre() const { return centre_; }

 private:
  Sparse lambda(const Vector& theta) const;

  std::vector<ScaledTerm> terms_;
  Vector column_scale_;  // of X
  double n_ = 0.0, centre_ = 0.0, yy_ = 0.0;
  Eigen::Index p_ = 0, q_ = 0;
  Sparse zz_;
  Matrix zx_, xx_;
  Vector zy_, xy_;
  using Factor = Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::AMDOrdering<int>>;
  mutable Factor factor_;  // its pattern is that of every θ
};

Problem::Problem(const Design& design, const Vector& y, const std::vector<RandomTerm>& terms) {
  n_ = double(y.size());
  p_ = design.columns.cols();
  for (const auto& term : terms) {
    terms_.push_back(scaled(term));
    terms_.back().first = q_;
    q_ += terms_.back().size();
  }
  column_scale_ = (design.columns.colwise().squaredNorm() / n_).cwiseSqrt();
  const Matrix x = design.columns * column_scale_.cwiseInverse().asDiagonal();
  centre_ = design.intercept ? y.mean() : 0.0;
  const Vector centred = y.array() - centre_;
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& term : terms_)
    for (Eigen::Index i = 0; i < y.size(); ++i)
      for (Eigen::Index e = 0; e < term.effects(); ++e)
        entries.emplace_back(i, term.first + term.level_of[std::size_t(i)] * term.effects() + e,
                             term.from->columns(i, e) / term.scale[e]);
  Sparse z(y.size(), q_);
  z.setFromTriplets(entries.begin(), entries.end());
  const Sparse zt = z.transpose();
  zz_ = zt * z;
  zx_ = zt * x;
  zy_ = zt * centred;
  xx_ = x.transpose() * x;
  xy_ = x.transpose() * centred;
  yy_ = centred.squaredNorm();
  Sparse identity(q_, q_);
  identity.setIdentity();
  const Sparse l = lambda(Vector::Ones(start().size()));
  factor_.analyzePattern(Sparse(Sparse(l.transpose()) * zz_ * l) + identity);
}

Vector Problem::start() const {
  Eigen::Index size = 0;
  for (const auto& term : terms_) size += term.parameters();
  Vector out = Vector::Zero(size);
  Eigen::Index at = 0;
  for (const auto& term : terms_)
    for (Eigen::Index c = 0; c < term.effects(); ++c) {
      out[at] = 1.0;
      at += term.effects() - c;
    }
  return out;
}

Sparse Problem::lambda(const Vector& theta) const {
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index at = 0;
  for (const auto& term : terms_) {
    const Matrix block = triangle(term, theta, at);
    const auto k = term.effects();
    for (Eigen::Index level = 0; level < Eigen::Index(term.levels.size()); ++level)
      for (Eigen::Index c = 0; c < k; ++c)
        for (Eigen::Index r = c; r < k; ++r)
          entries.emplace_back(term.first + level * k + r, term.first + level * k + c, block(r, c));
  }
  Sparse out(q_, q_);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

At Problem::solve(const Vector& theta, bool whole) const {
  const Sparse l = lambda(theta), lt = l.transpose();
  Sparse identity(q_, q_);
  identity.setIdentity();
  factor_.factorize(Sparse(lt * zz_ * l) + identity);
  const auto lower = factor_.matrixL();
  const Vector cu = lower.solve(Vector(factor_.permutationP() * Vector(lt * zy_)));
  const Matrix rzx = lower.solve(Matrix(factor_.permutationP() * Matrix(lt * zx_)));
  const Eigen::LLT<Matrix> rx(xx_ - rzx.transpose() * rzx);
  At out;
  out.beta = rx.solve(Vector(xy_ - rzx.transpose() * cu));
  const Vector cb = rx.matrixU() * out.beta;
  out.rss = yy_ - cu.squaredNorm() - cb.squaredNorm();
  const Sparse& factor = lower.nestedExpression();
  for (Eigen::Index c = 0; c < q_; ++c) out.log_det_L += 2.0 * std::log(factor.coeff(c, c));
  out.log_det_RX =
      2.0 * (rx.matrixLLT().diagonal().array().log().sum() + column_scale_.array().log().sum());
  if (!whole) return out;
  out.covariance = rx.solve(Matrix::Identity(p_, p_));
  out.u = factor_.permutationPinv() * Vector(factor_.matrixU().solve(Vector(cu - rzx * out.beta)));
  return out;
}

double Problem::criterion(const Vector& theta, Likelihood how) const {
  const At at = solve(theta, false);
  const double left = df(how);
  const double out = at.log_det_L + left * (1.0 + std::log(2.0 * std::numbers::pi * at.rss / left));
  return how == Likelihood::reml ? out + at.log_det_RX : out;
}

Error bad(const std::string& what) { return {Errc::bad_input, what}; }

core::Result<void> check_terms(const Design& design, const Vector& y,
                               const std::vector<RandomTerm>& terms) {
  core::require(!terms.empty(), "a mixed model has a random term");
  Eigen::Index total = 0;
  for (const auto& term : terms) {
    core::require(Eigen::Index(term.labels.size()) == y.size() && term.columns.rows() == y.size() &&
                      term.columns.cols() == Eigen::Index(term.names.size()),
                  "a random term has a label and a row for each observation");
    const auto levels = Eigen::Index(scaled(term).levels.size());
    if (levels < 2)
      return bad(term.group + ": one level: the spread between its levels cannot be estimated");
    if (levels * term.columns.cols() >= y.size())
      return bad(term.group +
                 ": as many effects as observations: they cannot be told from the "
                 "residual");
    for (Eigen::Index e = 0; e < term.columns.cols(); ++e)
      if (!(term.columns.col(e).squaredNorm() > 0.0) || !term.columns.col(e).allFinite())
        return bad(term.group + ": the slope's column " + term.names[std::size_t(e)] +
                   " is 0 or not finite throughout");
    total += levels * term.columns.cols();
  }
  if (total > kMostEffects)
    return bad("more random effects than " + std::to_string(kMostEffects) + ": group less finely");
  TRY(check(design, y));
  if (!collinear_columns(design).empty()) return collinear_error(design);
  return {};
}

/// A variance at 0 may be a local minimum: θ² is tried at some sizes there.
Vector least(const Problem& problem, Likelihood how, const ScalarField& f, bool& converged) {
  Minimum best = minimise(f, problem.start(), kStep);
  for (Eigen::Index i = 0; i < best.x.size(); ++i) {
    if (std::abs(best.x[i]) > 1e-3) continue;
    for (const double size : {0.03, 0.3}) {
      Vector from = best.x;
      from[i] = size;
      if (problem.criterion(from, how) < best.value - 1e-8) {
        const Minimum again = minimise(f, from, kStep);
        if (again.value < best.value) best = again;
      }
    }
  }
  converged = best.converged;
  return best.x;
}

void add_random(const Problem& problem, const Vector& theta, const At& at, MixedModel& out) {
  Eigen::Index place = 0;
  for (const auto& term : problem.terms()) {
    const Matrix block = triangle(term, theta, place);
    const Matrix unscaled = term.scale.cwiseInverse().asDiagonal() * block;
    RandomPart part;
    part.group = term.from->group;
    part.names = term.from->names;
    part.levels = term.levels;
    part.covariance = out.sigma_squared * unscaled * unscaled.transpose();
    const Eigen::JacobiSVD<Matrix> svd(block);
    part.singular = svd.singularValues().minCoeff() < kSingular;
    const auto k = term.effects();
    part.effects.resize(Eigen::Index(term.levels.size()), k);
    for (Eigen::Index level = 0; level < part.effects.rows(); ++level)
      part.effects.row(level) = (unscaled * at.u.segment(term.first + level * k, k)).transpose();
    out.singular = out.singular || part.singular;
    out.random.push_back(std::move(part));
  }
}

Matrix unscaled_covariance(const Problem& problem, const At& at) {
  const auto inverse = problem.column_scale().cwiseInverse();
  return inverse.asDiagonal() * at.covariance * inverse.asDiagonal();
}

/// Twice the inverse of a Hessian; directions of no or negative curvature have no covariance.
Matrix twice_inverse(const Matrix& hessian) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(hessian);
  Vector inverse = Vector::Zero(hessian.rows());
  const double most = eigen.eigenvalues().cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < inverse.size(); ++k)
    if (eigen.eigenvalues()[k] > 1e-8 * most) inverse[k] = 2.0 / eigen.eigenvalues()[k];
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

/// Hessian of the criterion in (θ, σ), not profiled: ln|L|² (+ ln|R_X|²) + r²/σ² + df ln(2πσ²).
void add_curvature(const Problem& problem, Likelihood how, const Vector& theta, MixedModel& out) {
  const auto m = theta.size();
  const double sigma2 = out.sigma_squared, sigma = std::sqrt(sigma2), df = problem.df(how);
  const auto fixed_sigma = [&](const Vector& at) {
    const At here = problem.solve(at, false);
    return here.log_det_L + (how == Likelihood::reml ? here.log_det_RX : 0.0) + here.rss / sigma2;
  };
  const auto rss = [&](const Vector& at) { return problem.solve(at, false).rss; };
  Matrix hessian(m + 1, m + 1);
  hessian.topLeftCorner(m, m) = numeric_hessian(fixed_sigma, theta, 4.0 * kStep);
  const Vector cross = -2.0 / (sigma2 * sigma) * numeric_gradient(rss, theta, kStep);
  hessian.col(m).head(m) = cross;
  hessian.row(m).head(m) = cross.transpose();
  hessian(m, m) = 6.0 * rss(theta) / (sigma2 * sigma2) - 2.0 * df / sigma2;
  out.parameter_covariance = twice_inverse(hessian);
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto covariance_at = [&](double shift) {
      Vector at = theta;
      at[i] += shift;
      return Matrix(sigma2 * unscaled_covariance(problem, problem.solve(at, true)));
    };
    const double h = kStep;
    out.covariance_slope.push_back((covariance_at(-2 * h) - 8.0 * covariance_at(-h) +
                                    8.0 * covariance_at(h) - covariance_at(2 * h)) /
                                   (12.0 * h));
  }
  out.covariance_slope.push_back(2.0 / sigma * out.covariance);
}

void add_tests(MixedModel& out) {
  out.standard_errors = out.covariance.diagonal().cwiseSqrt();
  out.t = out.coefficients.cwiseQuotient(out.standard_errors);
  out.df.resize(out.t.size());
  out.p.resize(out.t.size());
  for (Eigen::Index j = 0; j < out.t.size(); ++j) {
    out.df[j] = mixed_df(out, Vector::Unit(out.t.size(), j));
    out.p[j] = student_t_two_sided(out.t[j], out.df[j]);
  }
}

}  // namespace

core::Result<MixedModel> mixed_model(const Design& design, const Vector& response,
                                     const std::vector<RandomTerm>& terms, Likelihood likelihood,
                                     const core::Progress& progress) {
  TRY(check_terms(design, response, terms));
  const Problem problem(design, response, terms);
  bool stopped = false;
  int evaluations = 0;
  const ScalarField f = [&](const Vector& theta) {
    if (progress && !stopped) stopped = !progress(1.0 - 1.0 / (1.0 + 0.01 * ++evaluations));
    return stopped ? std::numeric_limits<double>::quiet_NaN()
                   : problem.criterion(theta, likelihood);
  };
  MixedModel out;
  const Vector theta = least(problem, likelihood, f, out.converged);
  if (stopped) return Error{Errc::cancelled, "stopped"};
  const At at = problem.solve(theta, true);
  out.names = design.names;
  out.sigma_squared = at.rss / problem.df(likelihood);
  out.criterion = problem.criterion(theta, likelihood);
  out.covariance = out.sigma_squared * unscaled_covariance(problem, at);
  out.coefficients = at.beta.cwiseQuotient(problem.column_scale());
  if (design.intercept) out.coefficients[0] += problem.centre();
  out.parameters = int(out.coefficients.size() + theta.size()) + 1;
  if (!std::isfinite(out.criterion) || !out.covariance.allFinite() || !(out.sigma_squared > 0.0))
    return Error{Errc::out_of_range,
                 "the numbers leave no residual, or are too large or too small: rescale them"};
  add_random(problem, theta, at, out);
  add_curvature(problem, likelihood, theta, out);
  add_tests(out);
  return out;
}

double mixed_df(const MixedModel& fit, const Vector& contrast) {
  const double variance = contrast.dot(fit.covariance * contrast);
  Vector gradient(Eigen::Index(fit.covariance_slope.size()));
  for (std::size_t k = 0; k < fit.covariance_slope.size(); ++k)
    gradient[Eigen::Index(k)] = contrast.dot(fit.covariance_slope[k] * contrast);
  return 2.0 * variance * variance / gradient.dot(fit.parameter_covariance * gradient);
}

JointTest joint_test(const MixedModel& fit, const std::vector<Eigen::Index>& columns) {
  return joint_test_by_contrasts(fit.coefficients, fit.covariance, columns,
                                 [&](const Vector& contrast) { return mixed_df(fit, contrast); });
}

}  // namespace statistics
}  // namespace tractus
