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
  find_pairs();
  weigh(Vector::Ones(rows()));
}

/// The rows of Z, which columns of Z₂ each level of Z₁ meets, and where each row adds to.
void PenalisedLeastSquares::find_pattern() {
  const auto& group_of = terms_[main_].level_of;
  rows_of_.resize(std::size_t(groups_));
  for (std::size_t i = 0; i < group_of.size(); ++i)
    rows_of_[std::size_t(group_of[i])].push_back(int(i));
  Eigen::Index entries = 0;
  for (const auto& term : terms_) entries += term.effects();
  z_.resize(entries, rows());
  slot_.resize(entries - k_, rows());
  begin_.assign(std::size_t(groups_) + 1, 0);
  Eigen::Index behind = k_;
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    const ScaledTerm& term = terms_[t];
    const Eigen::Index at = eliminated_[t] ? first_[t] : behind;
    z_.middleRows(at, term.effects()) =
        (term.from->columns.array().rowwise() / term.scale.transpose().array()).transpose();
    if (eliminated_[t]) continue;
    term_of_.insert(term_of_.end(), std::size_t(term.size()), int(t));
    behind += term.effects();
  }
  for (std::size_t g = 0; g < rows_of_.size(); ++g) {
    behind = 0;
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      if (eliminated_[t]) continue;
      const auto& level_of = terms_[t].level_of;
      std::vector<int> met;
      for (const int i : rows_of_[g]) met.push_back(level_of[std::size_t(i)]);
      std::ranges::sort(met);
      met.erase(std::unique(met.begin(), met.end()), met.end());
      const int effects = int(terms_[t].effects()), from = int(column_.size());
      for (const int i : rows_of_[g])
        for (int e = 0; e < effects; ++e)
          slot_(behind + e, i) =
              from + e +
              effects * int(std::ranges::lower_bound(met, level_of[std::size_t(i)]) - met.begin());
      for (const int level : met)
        for (int e = 0; e < effects; ++e) column_.push_back(int(first_[t]) + level * effects + e);
      behind += effects;
    }
    begin_[g + 1] = column_.size();
  }
}

/// Where S has entries, in its lower half: two columns of Z₂ that a level of Z₁ both meets.
void PenalisedLeastSquares::find_pairs() {
  meetings_.resize(std::size_t(q2_));
  for (std::size_t g = 0; g < rows_of_.size(); ++g)
    for (std::size_t c = begin_[g]; c < begin_[g + 1]; ++c)
      meetings_[std::size_t(column_[c])].push_back({g, c});
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<int> last(std::size_t(q2_), -1);  // the column in which a row was seen last
  for (int j = 0; j < int(q2_); ++j)
    for (const auto& [g, c] : meetings_[std::size_t(j)])
      for (std::size_t r = c; r < begin_[g + 1]; ++r)
        if (std::exchange(last[std::size_t(column_[r])], j) != j)
          entries.emplace_back(column_[r], j, 0.0);
  zz_.resize(q2_, q2_);
  zz_.setFromTriplets(entries.begin(), entries.end());
  factor_.s = zz_;
  const Eigen::Index n = slot_.rows();
  pair_.resize(n * (n + 1) / 2, rows());
  for (Eigen::Index i = 0; i < rows(); ++i) {
    Eigen::Index at = 0;
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = a; b < n; ++b) {
        const int column = column_[std::size_t(slot_(a, i))];
        const int* const first = zz_.innerIndexPtr();
        pair_(at++, i) = int(std::lower_bound(first + zz_.outerIndexPtr()[column],
                                              first + zz_.outerIndexPtr()[column + 1],
                                              column_[std::size_t(slot_(b, i))]) -
                             first);
      }
  }
}

void PenalisedLeastSquares::weigh(const Vector& weights) {
  weights_ = weights;
  sized([&]<int K>() { sum_weights<K>(); });
}

/// Zᵀ W Z, row by row.
template <int K>
void PenalisedLeastSquares::sum_weights() {
  using Column = Eigen::Matrix<double, K, 1>;
  cross_.assign(column_.size() * std::size_t(k_), 0.0);
  own_ = Matrix::Zero(k_, k_ * groups_);
  zz_.coeffs().setZero();
  const auto& group_of = terms_[main_].level_of;
  for (Eigen::Index i = 0; i < rows(); ++i) {
    const double* const z = &z_(0, i);
    const double* const z2 = z + k_;
    const Eigen::Map<const Column> z1(z, k_);
    const Column weighted = weights_[i] * z1;
    own_.middleCols(group_of[std::size_t(i)] * k_, k_).noalias() +=
        weighted.lazyProduct(z1.transpose());
    Eigen::Index pair = 0;
    for (Eigen::Index a = 0; a < slot_.rows(); ++a) {
      Eigen::Map<Column>(&cross_[std::size_t(slot_(a, i) * k_)], k_) += z2[a] * weighted;
      for (Eigen::Index b = a; b < slot_.rows(); ++b)
        zz_.valuePtr()[pair_(pair++, i)] += weights_[i] * z2[a] * z2[b];
    }
  }
}

void PenalisedLeastSquares::observe(const Vector& y) {
  Matrix xy(y.size(), x_.cols() + 1);
  xy << x_, y;
  right_ = cross_products(xy);
}

PenalisedLeastSquares::Right PenalisedLeastSquares::cross_products(const Matrix& right) const {
  Right out;
  sized([&]<int K>() { sum_right<K>(right, out); });
  out.ee = right.transpose() * weights_.asDiagonal() * right;
  return out;
}

template <int K>
void PenalisedLeastSquares::sum_right(const Matrix& right, Right& out) const {
  using Column = Eigen::Matrix<double, K, 1>;
  const Eigen::Index columns = right.cols();
  out.with = Matrix::Zero(k_, columns * groups_);
  out.ze = Matrix::Zero(q2_, columns);
  const auto& group_of = terms_[main_].level_of;
  for (Eigen::Index i = 0; i < rows(); ++i) {
    const Eigen::Map<const Column> z1(&z_(0, i), k_);
    for (Eigen::Index c = 0; c < columns; ++c) {
      const double value = weights_[i] * right(i, c);
      out.with.col(group_of[std::size_t(i)] * columns + c) += value * z1;
      for (Eigen::Index a = 0; a < slot_.rows(); ++a)
        out.ze(column_[std::size_t(slot_(a, i))], c) += value * z_(k_ + a, i);
    }
  }
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

void PenalisedLeastSquares::factorise_levels(const std::vector<Matrix>& lambda) const {
  const Matrix of_level = lambda1(lambda);
  factor_.log_det = 0.0;
  factor_.p.resize(k_, k_ * groups_);
  for (Eigen::Index at = 0; at < k_ * groups_; at += k_) {
    const Eigen::LLT<Matrix> a(of_level.transpose() * own_.middleCols(at, k_) * of_level +
                               Matrix::Identity(k_, k_));
    factor_.log_det += 2.0 * sum_of_logs(a.matrixLLT().diagonal());
    const Matrix half = a.matrixL().solve(of_level.transpose());
    factor_.p.middleCols(at, k_) = half.transpose() * half;
  }
}

/// S = Λ₂ᵀ K_ZZ Λ₂ + I, K_ZZ = Z₂ᵀWZ₂ − Z₂ᵀWZ₁ P Z₁ᵀWZ₂, one level's columns after the other.
template <int K>
void PenalisedLeastSquares::fill_levels(const std::vector<Matrix>& lambda) const {
  using Column = Eigen::Matrix<double, K, 1>;
  Matrix columns(q2_, 0);
  const auto row_of = zz_.innerIndexPtr();
  for (Eigen::Index from = 0; from < q2_;) {
    const Matrix& here = lambda[std::size_t(term_of_[std::size_t(from)])];
    const auto k = here.rows();
    columns.resize(q2_, k);
    for (Eigen::Index e = 0; e < k; ++e) {
      double* const into = columns.col(e).data();
      for (Sparse::InnerIterator at(zz_, from + e); at; ++at) into[at.row()] = at.value();
      for (const auto& [g, c] : meetings_[std::size_t(from + e)]) {
        const Column there =
            factor_.p.middleCols(Eigen::Index(g) * k_, k_)
                .lazyProduct(Eigen::Map<const Column>(&cross_[c * std::size_t(k_)], k_));
        for (std::size_t r = c; r < begin_[g + 1]; ++r)
          into[column_[r]] -= Eigen::Map<const Column>(&cross_[r * std::size_t(k_)], k_).dot(there);
      }
      for (Eigen::Index above = 0; above < e; ++above)
        columns(from + above, e) = columns(from + e, above);
    }
    const int end = zz_.outerIndexPtr()[from + 1];
    for (int at = zz_.outerIndexPtr()[from]; at < end;) {
      const Matrix& there = lambda[std::size_t(term_of_[std::size_t(row_of[at])])];
      auto block = columns.middleRows(row_of[at], there.rows());
      if (k == 1 && there.rows() == 1)
        block *= there(0, 0) * here(0, 0);
      else
        block = (there.transpose() * block * here).eval();
      at += int(there.rows());
    }
    for (Eigen::Index e = 0; e < k; ++e) {
      columns(from + e, e) += 1.0;
      for (Sparse::InnerIterator at(factor_.s, from + e); at; ++at)
        at.valueRef() = columns(at.row(), e);
    }
    from += k;
  }
}

void PenalisedLeastSquares::factorise(const std::vector<Matrix>& lambda) const {
  factorise_levels(lambda);
  if (q2_ == 0) return;
  sized([&]<int K>() { fill_levels<K>(lambda); });
  if (dense_) {
    factor_.dense.compute(Matrix(factor_.s));
    factor_.log_det += 2.0 * sum_of_logs(factor_.dense.matrixLLT().diagonal());
    return;
  }
  if (!factor_.analysed) factor_.sparse.analyzePattern(factor_.s);
  factor_.analysed = true;
  factor_.sparse.factorize(factor_.s);
  const Sparse& lower = factor_.sparse.matrixL().nestedExpression();
  factor_.log_det += 2.0 * sum_of_logs(lower.diagonal());
}

PenalisedLeastSquares::Right PenalisedLeastSquares::eliminated(const Right& of) const {
  Right out = of;
  sized([&]<int K>() { out = eliminate<K>(std::move(out)); });
  return out;
}

/// K_Ze and K_ee: EᵀWE − EᵀWZ₁ P Z₁ᵀWE.
template <int K>
PenalisedLeastSquares::Right PenalisedLeastSquares::eliminate(Right of) const {
  using Column = Eigen::Matrix<double, K, 1>;
  const Eigen::Index columns = of.ee.cols();
  for (std::size_t g = 0; g < rows_of_.size(); ++g) {
    const auto with = of.with.middleCols(Eigen::Index(g) * columns, columns);
    const Eigen::Matrix<double, K, Eigen::Dynamic> shrunk =
        factor_.p.middleCols(Eigen::Index(g) * k_, k_) * with;
    of.ee.noalias() -= with.transpose() * shrunk;
    for (std::size_t r = begin_[g]; r < begin_[g + 1]; ++r) {
      const Eigen::Map<const Column> here(&cross_[r * std::size_t(k_)], k_);
      for (Eigen::Index c = 0; c < columns; ++c) of.ze(column_[r], c) -= here.dot(shrunk.col(c));
    }
  }
  return of;
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
  factorise(lambda);
  const Right at = eliminated(right_);
  Penalised out;
  out.log_det_L = factor_.log_det;
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

Penalised PenalisedLeastSquares::solve_effects(const Vector& theta, const Vector& y) const {
  factorise(triangles(theta));
  return solve_effects_again(theta, y);
}

Penalised PenalisedLeastSquares::solve_effects_again(const Vector& theta, const Vector& y) const {
  const std::vector<Matrix> lambda = triangles(theta);
  const Right at = eliminated(cross_products(y));
  Penalised out;
  out.log_det_L = factor_.log_det;
  const Vector c = forward(turned(lambda, at.ze));
  add_effects(lambda, at, backward(c), Vector::Ones(1), out);
  return out;
}

/// u and Λ u of both parts: of Z₂ from u₂, of Z₁ from what Z₂ leaves, level by level.
void PenalisedLeastSquares::add_effects(const std::vector<Matrix>& lambda, const Right& at,
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
  for (Eigen::Index g = 0; g < groups_; ++g) {
    Vector left = at.with.middleCols(g * residual.size(), residual.size()) * residual;
    for (std::size_t c = begin_[std::size_t(g)]; c < begin_[std::size_t(g) + 1]; ++c)
      left -= b2[column_[c]] * Eigen::Map<const Vector>(&cross_[c * std::size_t(k_)], k_);
    const Vector b1 = factor_.p.middleCols(g * k_, k_) * left;
    const Vector u1 =
        of_level.transpose() * (left - own_.middleCols(g * k_, k_) * b1);  // A u = Λᵀ left
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      if (!eliminated_[t]) continue;
      out.effects[t].row(g) = b1.segment(first_[t], terms_[t].effects());
      out.u[t].row(g) = u1.segment(first_[t], terms_[t].effects());
    }
  }
}

}  // namespace statistics
}  // namespace tractus
