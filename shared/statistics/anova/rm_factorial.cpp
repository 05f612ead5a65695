#include "statistics/anova/rm_factorial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

/// Orthonormal contrasts of k levels, or the weights of their mean scaled to length one.
Matrix weights(Eigen::Index k, bool of_contrasts) {
  return of_contrasts ? contrasts(k)
                      : Matrix(Matrix::Constant(k, 1, 1.0 / std::sqrt(static_cast<double>(k))));
}

Matrix kronecker(const Matrix& a, const Matrix& b) {
  Matrix out(a.rows() * b.rows(), a.cols() * b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      out.block(i * b.rows(), j * b.cols(), b.rows(), b.cols()) = a(i, j) * b;
  return out;
}

/// Which factors a bit mask names.
std::vector<std::size_t> members(unsigned mask) {
  std::vector<std::size_t> out;
  for (std::size_t f = 0; f < 32; ++f)
    if (mask >> f & 1u) out.push_back(f);
  return out;
}

/// Scores on one set of contrasts, by group.
struct Scores {
  Matrix means;  // [group][contrast]
  Vector sizes;
  Matrix error;  // [contrast][contrast], sums of products about the group's mean
  double n = 0.0;
};

Scores scores(const RmDesign& design, unsigned mask, std::size_t groups) {
  Matrix c = Matrix::Ones(1, 1);
  for (std::size_t f = 0; f < design.levels.size(); ++f)
    c = kronecker(c, weights(design.levels[f], (mask >> f & 1u) != 0));
  // About the grand mean first: the contrasts do not see it, digits do.
  const double shift = mask ? design.values.mean() : 0.0;
  const Matrix z = (design.values.array() - shift).matrix() * c;
  const auto g = static_cast<Eigen::Index>(groups);
  Scores out{Matrix::Zero(g, z.cols()), Vector::Zero(g), {}, static_cast<double>(z.rows())};
  const auto group_of = [&](Eigen::Index i) {
    return design.group.empty()
               ? Eigen::Index{0}
               : static_cast<Eigen::Index>(design.group[static_cast<std::size_t>(i)]);
  };
  for (Eigen::Index i = 0; i < z.rows(); ++i) {
    out.sizes[group_of(i)] += 1.0;
    out.means.row(group_of(i)) += z.row(i);
  }
  out.means = out.sizes.cwiseInverse().asDiagonal() * out.means;
  Matrix rest = z;
  for (Eigen::Index i = 0; i < z.rows(); ++i) rest.row(i) -= out.means.row(group_of(i));
  out.error = rest.transpose() * rest;
  return out;
}

RmEffect effect(const Scores& s, bool with_group) {
  const double q = static_cast<double>(s.error.rows()), g = static_cast<double>(s.sizes.size());
  RmEffect out;
  out.with_group = with_group;
  if (with_group) {
    const Eigen::RowVectorXd mean = (s.sizes.transpose() * s.means) / s.n;
    out.ss = ((s.means.rowwise() - mean).rowwise().squaredNorm().transpose() * s.sizes).value();
    out.df1 = q * (g - 1.0);
  } else {
    const double weight = s.sizes.cwiseInverse().sum() / (g * g);
    out.ss = s.means.colwise().mean().squaredNorm() / weight;
    out.df1 = q;
  }
  out.ss_error = s.error.trace();
  out.df2 = q * (s.n - g);
  out.f = (out.ss / out.df1) / (out.ss_error / out.df2);
  out.p = out.p_gg = out.p_hf = f_upper(out.f, out.df1, out.df2);
  out.mauchly = mauchly(s.error, s.n - g);
  out.partial_eta_squared = out.ss / (out.ss + out.ss_error);
  if (q < 2.0) return out;
  out.epsilon_gg = s.error.trace() * s.error.trace() / (q * s.error.squaredNorm());
  out.epsilon_hf =
      ((s.n - g + 1.0) * q * out.epsilon_gg - 2.0) / (q * (s.n - g - q * out.epsilon_gg));
  const auto corrected = [&](double e) { return f_upper(out.f, out.df1 * e, out.df2 * e); };
  out.p_gg = corrected(std::min(1.0, out.epsilon_gg));
  // With few subjects the estimate can pass through infinity: it then means "above 1".
  const bool above = !(out.epsilon_hf >= 1.0 / q && out.epsilon_hf <= 1.0);
  out.p_hf = corrected(above ? 1.0 : out.epsilon_hf);
  return out;
}

core::Result<std::size_t> checked_groups(const RmDesign& design) {
  Eigen::Index cells = 1;
  for (const auto levels : design.levels) cells *= levels;
  core::require(cells == design.values.cols(), "a cell for every combination of levels");
  if (design.levels.size() > 6)
    return core::Error{core::Errc::too_large, "at most six within-subject factors"};
  if (design.values.rows() < 2 || cells < 2)
    return core::bad_input("repeated measures need at least two subjects and two levels");
  if (!design.values.allFinite())
    return core::bad_input("a value is missing or not a finite number");
  TRY(check_range(design.values.reshaped(), "the response"));
  std::vector<std::size_t> sizes(1, static_cast<std::size_t>(design.values.rows()));
  if (!design.group.empty()) {
    core::require(std::ssize(design.group) == design.values.rows(), "every subject has a group");
    sizes.assign(std::ranges::max(design.group) + 1, 0);
    for (const std::size_t g : design.group) ++sizes[g];
  }
  if (std::ranges::min(sizes) < 2)
    return core::bad_input("every group of subjects needs at least two of them");
  return sizes.size();
}

}  // namespace

core::Result<std::vector<RmEffect>> rm_factorial(const RmDesign& design) {
  const auto groups = TRY(checked_groups(design));
  std::vector<RmEffect> out;
  double all_error = 0.0;
  for (unsigned mask = 0; mask < 1u << design.levels.size(); ++mask) {
    const Scores s = scores(design, mask, groups);
    const double error = s.error.trace();
    all_error += error;
    if (!(error > 1e-28 * s.means.squaredNorm()))
      return core::bad_input(
          "subjects differ by constants alone: there is no error to judge the levels by");
    if (!std::isfinite(error) || !std::isfinite(s.means.squaredNorm()))
      return core::Error{core::Errc::out_of_range,
                         "the numbers are too large for sums of squares: rescale them"};
    for (const bool with_group : {false, true}) {
      if ((mask == 0 && !with_group) || (with_group && groups == 1)) continue;
      out.push_back(effect(s, with_group));
      out.back().within = members(mask);
    }
  }
  for (auto& one : out) one.generalized_eta_squared = one.ss / (one.ss + all_error);
  std::ranges::stable_sort(
      out, {}, [](const RmEffect& e) { return e.within.size() + (e.with_group ? 1u : 0u); });
  return out;
}

}  // namespace statistics
}  // namespace tractus
