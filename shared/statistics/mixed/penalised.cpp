#include "statistics/mixed/penalised.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tractus {
namespace statistics {
namespace {

using core::Errc;
using core::Error;

constexpr Eigen::Index kMostEffects = 200'000;
constexpr Eigen::Index kMostDense = 3000;  // columns of Z₂: K and S of 72 MB each

constexpr double kSingular = 1e-4;  // as lme4's isSingular: of Λ

Error bad(const std::string& what) { return {Errc::bad_input, what}; }

double sum_of_logs(const Vector& diagonal) { return diagonal.array().log().sum(); }

}  // namespace

ScaledTerm scaled(const RandomTerm& term) {
  ScaledTerm out;
  out.from = &term;
  std::unordered_map<std::string_view, int> place;
  out.level_of.reserve(term.labels.size());
  for (const auto& label : term.labels) {
    const auto [at, fresh] = place.try_emplace(label, int(out.levels.size()));
    if (fresh) out.levels.push_back(label);
    out.level_of.push_back(at->second);
  }
  out.scale = (term.columns.colwise().squaredNorm() / double(term.columns.rows())).cwiseSqrt();
  return out;
}

core::Result<void> check_terms(const std::vector<RandomTerm>& terms, Eigen::Index rows,
                               double outcomes) {
  core::require(!terms.empty(), "a mixed model has a random term");
  Eigen::Index total = 0;
  for (const auto& term : terms) {
    core::require(Eigen::Index(term.labels.size()) == rows && term.columns.rows() == rows &&
                      term.columns.cols() == Eigen::Index(term.names.size()),
                  "a random term has a label and a row for each observation");
    const auto levels = Eigen::Index(scaled(term).levels.size());
    if (levels < 2)
      return bad(term.group + ": one level: the spread between its levels cannot be estimated");
    if (double(levels * term.columns.cols()) >= outcomes)
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
  return {};
}

Matrix triangle(const ScaledTerm& term, const Vector& theta, Eigen::Index& at) {
  Matrix out = Matrix::Zero(term.effects(), term.effects());
  for (Eigen::Index c = 0; c < term.effects(); ++c)
    for (Eigen::Index r = c; r < term.effects(); ++r) out(r, c) = theta[at++];
  return out;
}

RandomPart random_part(const ScaledTerm& term, const Matrix& block, const Matrix& effects,
                       double sigma_squared) {
  const Matrix unscaled = term.scale.cwiseInverse().asDiagonal() * block;
  RandomPart out;
  out.group = term.from->group;
  out.names = term.from->names;
  out.levels = term.levels;
  out.covariance = sigma_squared * unscaled * unscaled.transpose();
  const Eigen::JacobiSVD<Matrix> svd(block);
  out.singular = svd.singularValues().minCoeff() < kSingular;
  out.effects = effects * term.scale.cwiseInverse().asDiagonal();
  return out;
}

PenalisedLeastSquares::PenalisedLeastSquares(const Matrix& x,
                                             const std::vector<RandomTerm>& terms) {
  column_scale_ = (x.colwise().squaredNorm() / double(x.rows())).cwiseSqrt();
  x_ = x * column_scale_.cwiseInverse().asDiagonal();
  for (const auto& term : terms) terms_.push_back(scaled(term));
  const auto effects_of = [&](std::size_t t) {
    Eigen::Index out = 0;
    for (const auto& term : terms_)
      if (term.level_of == terms_[t].level_of) out += term.size();
    return out;
  };
  for (std::size_t t = 1; t < terms_.size(); ++t)
    if (effects_of(t) > effects_of(main_)) main_ = t;
  groups_ = std::ssize(terms_[main_].levels);
  for (const auto& term : terms_) {
    eliminated_.push_back(term.level_of == terms_[main_].level_of);
    Eigen::Index& behind = eliminated_.back() ? k_ : q2_;
    first_.push_back(behind);
    behind += eliminated_.back() ? term.effects() : term.size();
  }
  dense_ = q2_ <= kMostDense;
  find_pattern();
}

/// Which columns of Z₂ each level of Z₁ meets, and where each row adds to.
void PenalisedLeastSquares::find_pattern() {
  const auto& group_of = terms_[main_].level_of;
  rows_of_.resize(std::size_t(groups_));
  for (std::size_t i = 0; i < group_of.size(); ++i)
    rows_of_[std::size_t(group_of[i])].push_back(int(i));
  slot_.assign(terms_.size(), {});
  for (std::size_t t = 0; t < terms_.size(); ++t)
    if (!eliminated_[t]) slot_[t].resize(group_of.size());
  begin_ = {0};
  for (const auto& of_group : rows_of_) {
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      if (eliminated_[t]) continue;
      const auto& level_of = terms_[t].level_of;
      std::vector<int> met;
      for (const int i : of_group) met.push_back(level_of[std::size_t(i)]);
      std::ranges::sort(met);
      met.erase(std::unique(met.begin(), met.end()), met.end());
      const auto effects = std::size_t(terms_[t].effects()), from = column_.size();
      for (const int i : of_group)
        slot_[t][std::size_t(i)] =
            from + effects * std::size_t(std::ranges::lower_bound(met, level_of[std::size_t(i)]) -
                                         met.begin());
      for (const int level : met)
        for (std::size_t e = 0; e < effects; ++e)
          column_.push_back(int(first_[t]) + level * int(effects) + int(e));
    }
    begin_.push_back(column_.size());
  }
}

void PenalisedLeastSquares::observe(const Vector& y, const Vector& weights) {
  const auto p = x_.cols();
  cross_.assign(column_.size() * std::size_t(k_), 0.0);
  own_.assign(std::size_t(groups_), Matrix::Zero(k_, k_));
  with_xy_.assign(std::size_t(groups_), Matrix::Zero(k_, p + 1));
  zz_ = Matrix::Zero(dense_ ? q2_ : 0, dense_ ? q2_ : 0);
  ze_ = Matrix::Zero(q2_, p + 1);
  weights_ = weights.size() == 0 ? Vector::Ones(y.size()) : weights;
  Matrix xy(y.size(), p + 1);
  xy << x_, y;
  ee_ = xy.transpose() * weights_.asDiagonal() * xy;
  sum_rows(xy, weights_);
}

/// Adds each row to the cross products with Z.
void PenalisedLeastSquares::sum_rows(const Matrix& xy, const Vector& weights) {
  Vector one(k_);
  std::vector<std::pair<Eigen::Index, double>> rest;  // entries of the row in Z₂
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < xy.rows(); ++i) {
    const auto row = std::size_t(i);
    const auto group = std::size_t(terms_[main_].level_of[row]);
    rest.clear();
    for (std::size_t t = 0; t < terms_.size(); ++t)
      for (Eigen::Index e = 0; e < terms_[t].effects(); ++e) {
        const double value = terms_[t].from->columns(i, e) / terms_[t].scale[e];
        if (eliminated_[t])
          one[first_[t] + e] = value;
        else
          rest.emplace_back(first_[t] + terms_[t].level_of[row] * terms_[t].effects() + e, value);
      }
    const double w = weights[i];
    own_[group].noalias() += w * one * one.transpose();
    with_xy_[group].noalias() += w * one * xy.row(i);
    std::size_t n = 0;
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      if (eliminated_[t]) continue;
      for (Eigen::Index e = 0; e < terms_[t].effects(); ++e, ++n) {
        double* const at = &cross_[(slot_[t][row] + std::size_t(e)) * std::size_t(k_)];
        for (Eigen::Index a = 0; a < k_; ++a) at[a] += w * one[a] * rest[n].second;
      }
    }
    for (const auto& [column, value] : rest) {
      ze_.row(column) += w * value * xy.row(i);
      for (const auto& [other, factor] : rest) {
        if (other < column) continue;
        if (dense_)
          zz_(other, column) += w * value * factor;
        else
          entries.emplace_back(int(other), int(column), w * value * factor);
      }
    }
  }
  if (dense_) return;
  sparse_zz_.resize(q2_, q2_);
  sparse_zz_.setFromTriplets(entries.begin(), entries.end());
}

Vector PenalisedLeastSquares::start() const {
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

std::vector<Matrix> PenalisedLeastSquares::triangles(const Vector& theta) const {
  std::vector<Matrix> out;
  Eigen::Index at = 0;
  for (const auto& term : terms_) out.push_back(triangle(term, theta, at));
  return out;
}

/// Λ₁ of one level: the blocks of all terms of the first grouping.
Matrix PenalisedLeastSquares::lambda1(const std::vector<Matrix>& lambda) const {
  Matrix out = Matrix::Zero(k_, k_);
  for (std::size_t t = 0; t < terms_.size(); ++t)
    if (eliminated_[t])
      out.block(first_[t], first_[t], lambda[t].rows(), lambda[t].rows()) = lambda[t];
  return out;
}

PenalisedLeastSquares::Eliminated PenalisedLeastSquares::eliminate(
    const std::vector<Matrix>& lambda) const {
  Eliminated out;
  const Matrix of_level = lambda1(lambda);
  out.zz = zz_;
  out.ze = ze_;
  out.ee = ee_;
  out.p.reserve(std::size_t(groups_));
  for (const auto& own : own_) {
    const Eigen::LLT<Matrix> a(of_level.transpose() * own * of_level + Matrix::Identity(k_, k_));
    out.log_det += 2.0 * sum_of_logs(a.matrixLLT().diagonal());
    const Matrix half = a.matrixL().solve(of_level.transpose());
    out.p.push_back(half.transpose() * half);
  }
  if (k_ == 1)
    subtract<1>(out);
  else if (k_ == 2)
    subtract<2>(out);
  else
    subtract<Eigen::Dynamic>(out);
  return out;
}

/// K = EᵀWE − EᵀWZ₁ P Z₁ᵀWE, the lower half of K_ZZ where it is dense.
template <int K>
void PenalisedLeastSquares::subtract(Eliminated& out) const {
  using Column = Eigen::Matrix<double, K, 1>;
  const auto k = std::size_t(k_);
  for (std::size_t g = 0; g < out.p.size(); ++g) {
    const Eigen::Matrix<double, K, K> p = out.p[g];
    const Matrix shrunk = out.p[g] * with_xy_[g];
    out.ee.noalias() -= with_xy_[g].transpose() * shrunk;
    for (std::size_t c = begin_[g]; c < begin_[g + 1]; ++c) {
      const Eigen::Map<const Column> here(&cross_[c * k], k_);
      out.ze.row(column_[c]).noalias() -= here.transpose() * shrunk;
      if (!dense_) continue;
      const Column there = p * here;
      double* const into = &out.zz(0, column_[c]);
      for (std::size_t r = c; r < begin_[g + 1]; ++r)
        into[column_[r]] -= Eigen::Map<const Column>(&cross_[r * k], k_).dot(there);
    }
  }
}

/// K_ZZ of a large Z₂, both halves.
PenalisedLeastSquares::Sparse PenalisedLeastSquares::sparse_zz(const Eliminated& at) const {
  std::vector<Eigen::Triplet<double>> cross, shrunk;
  for (std::size_t g = 0; g < at.p.size(); ++g)
    for (std::size_t c = begin_[g]; c < begin_[g + 1]; ++c) {
      const Eigen::Map<const Vector> here(&cross_[c * std::size_t(k_)], k_);
      const Vector there = at.p[g] * here;
      for (Eigen::Index a = 0; a < k_; ++a) {
        const auto row = int(Eigen::Index(g) * k_ + a);
        cross.emplace_back(column_[c], row, here[a]);
        shrunk.emplace_back(row, column_[c], there[a]);
      }
    }
  Sparse left(q2_, groups_ * k_), right(groups_ * k_, q2_);
  left.setFromTriplets(cross.begin(), cross.end());
  right.setFromTriplets(shrunk.begin(), shrunk.end());
  return Sparse(sparse_zz_.selfadjointView<Eigen::Lower>()) - Sparse(left * right);
}

/// Λ₂ᵀ · rows.
Matrix PenalisedLeastSquares::turned(const std::vector<Matrix>& lambda, Matrix rows) const {
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    if (eliminated_[t]) continue;
    const auto k = terms_[t].effects();
    for (Eigen::Index level = 0; level < std::ssize(terms_[t].levels); ++level)
      rows.middleRows(first_[t] + level * k, k) =
          (lambda[t].transpose() * rows.middleRows(first_[t] + level * k, k)).eval();
  }
  return rows;
}

PenalisedLeastSquares::Sparse PenalisedLeastSquares::lambda2(
    const std::vector<Matrix>& lambda) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    if (eliminated_[t]) continue;
    const auto k = terms_[t].effects();
    for (Eigen::Index at = first_[t]; at < first_[t] + terms_[t].size(); at += k)
      for (Eigen::Index c = 0; c < k; ++c)
        for (Eigen::Index r = c; r < k; ++r)
          entries.emplace_back(int(at + r), int(at + c), lambda[t](r, c));
  }
  Sparse out(q2_, q2_);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

/// Factorises S = Λ₂ᵀ K_ZZ Λ₂ + I; returns ln|S|.
double PenalisedLeastSquares::factorise(const std::vector<Matrix>& lambda,
                                        const Eliminated& at) const {
  if (q2_ == 0) return 0.0;
  if (dense_) {
    const Matrix whole = at.zz.selfadjointView<Eigen::Lower>();
    Matrix s = turned(lambda, turned(lambda, whole).transpose());
    s.diagonal().array() += 1.0;
    factor_.dense.compute(s);
    return 2.0 * sum_of_logs(factor_.dense.matrixLLT().diagonal());
  }
  const Sparse l = lambda2(lambda);
  Sparse identity(q2_, q2_);
  identity.setIdentity();
  const Sparse s = Sparse(Sparse(l.transpose()) * sparse_zz(at) * l) + identity;
  if (!factor_.analysed) factor_.sparse.analyzePattern(s);
  factor_.analysed = true;
  factor_.sparse.factorize(s);
  const Sparse& lower = factor_.sparse.matrixL().nestedExpression();
  return 2.0 * sum_of_logs(lower.diagonal());
}

Matrix PenalisedLeastSquares::forward(const Matrix& right) const {
  if (q2_ == 0) return right;
  if (dense_) return factor_.dense.matrixL().solve(right);
  return factor_.sparse.matrixL().solve(Matrix(factor_.sparse.permutationP() * right));
}

Vector PenalisedLeastSquares::backward(const Vector& right) const {
  if (q2_ == 0) return right;
  if (dense_) return factor_.dense.matrixU().solve(right);
  return factor_.sparse.permutationPinv() * Vector(factor_.sparse.matrixU().solve(right));
}

Penalised PenalisedLeastSquares::solve(const Vector& theta, Want want) const {
  const auto p = x_.cols();
  const std::vector<Matrix> lambda = triangles(theta);
  const Eliminated at = eliminate(lambda);
  Penalised out;
  out.log_det_L = at.log_det + factorise(lambda, at);
  const Matrix c = forward(turned(lambda, at.ze));  // [R_ZX c_u]
  const Matrix left = at.ee - c.transpose() * c;
  const Eigen::LLT<Matrix> rx(left.topLeftCorner(p, p));
  out.beta = rx.solve(left.col(p).head(p));
  out.rss = left(p, p) - Vector(rx.matrixU() * out.beta).squaredNorm();
  out.log_det_RX = 2.0 * (sum_of_logs(rx.matrixLLT().diagonal()) + sum_of_logs(column_scale_));
  if (want == Want::criterion) return out;
  out.covariance = rx.solve(Matrix::Identity(p, p));
  Vector residual(p + 1);  // [X y] · residual is y − X β
  residual << -out.beta, 1.0;
  add_effects(lambda, at, backward(c * residual), residual, out);
  return out;
}

Penalised PenalisedLeastSquares::solve_effects(const Vector& theta) const {
  const auto p = x_.cols();
  const std::vector<Matrix> lambda = triangles(theta);
  const Eliminated at = eliminate(lambda);
  Penalised out;
  out.log_det_L = at.log_det + factorise(lambda, at);
  const Vector c = forward(turned(lambda, at.ze.col(p)));
  add_effects(lambda, at, backward(c), Vector::Unit(p + 1, p), out);
  return out;
}

/// u and Λ u of both parts: of Z₂ from u₂, of Z₁ from what Z₂ leaves, level by level.
void PenalisedLeastSquares::add_effects(const std::vector<Matrix>& lambda, const Eliminated& at,
                                        const Vector& u2, const Vector& residual,
                                        Penalised& out) const {
  Vector b2(q2_);
  const Matrix of_level = lambda1(lambda);
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    const auto k = terms_[t].effects();
    out.effects.emplace_back(std::ssize(terms_[t].levels), k);
    out.u.emplace_back(std::ssize(terms_[t].levels), k);
    if (eliminated_[t]) continue;
    for (Eigen::Index level = 0; level < out.effects[t].rows(); ++level) {
      const auto from = first_[t] + level * k;
      b2.segment(from, k) = lambda[t] * u2.segment(from, k);
      out.effects[t].row(level) = b2.segment(from, k).transpose();
      out.u[t].row(level) = u2.segment(from, k).transpose();
    }
  }
  for (std::size_t g = 0; g < at.p.size(); ++g) {
    Vector left = with_xy_[g] * residual;
    for (std::size_t c = begin_[g]; c < begin_[g + 1]; ++c)
      left -= b2[column_[c]] * Eigen::Map<const Vector>(&cross_[c * std::size_t(k_)], k_);
    const Vector b1 = at.p[g] * left;
    const Vector u1 = of_level.transpose() * (left - own_[g] * b1);  // A u = Λᵀ left
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      if (!eliminated_[t]) continue;
      out.effects[t].row(Eigen::Index(g)) = b1.segment(first_[t], terms_[t].effects());
      out.u[t].row(Eigen::Index(g)) = u1.segment(first_[t], terms_[t].effects());
    }
  }
}

}  // namespace statistics
}  // namespace tractus
