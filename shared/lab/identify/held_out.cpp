#include "lab/identify/held_out.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/identify/parallel.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kHeldOut = kSettings.validation;

/// The sums of squares of each fold under values that were fitted without it.
std::vector<Squares> held_out_sums(const Residual& residual, const Solution& at) {
  const auto folds = folds_of(residual);
  const LeftOut left_out(residual, at);
  std::vector<Squares> out(folds.size());
  parallel(int(folds.size()), residual.threads(), [&](int f) {
    const Fold& fold = folds[std::size_t(f)];
    out[std::size_t(f)] = squares_between(residual.problem(), at.structure, left_out.values(fold),
                                          fold.trial, fold.from_s, fold.to_s);
  });
  return out;
}

}  // namespace

std::vector<Fold> folds_of(const Residual& residual) {
  const Problem& problem = residual.problem();
  std::vector<Fold> out;
  const int pieces =
      residual.trials() >= kHeldOut.fewest_trials ? 1 : kHeldOut.stretches / residual.trials();
  for (int k = 0; k < residual.trials(); ++k) {
    const Eigen::Index first = residual.offset(k), all = residual.offset(k + 1) - first;
    for (int p = 0; p < pieces; ++p) {
      const Eigen::Index from = all * p / pieces, to = all * (p + 1) / pieces;
      const double length = problem.seconds(k);
      out.push_back({k, length * p / pieces, length * (p + 1) / pieces, first + from, to - from});
    }
  }
  return out;
}

LeftOut::LeftOut(const Residual& residual, const Solution& at)
    : at_(at),
      weights_(robust_weights(at.residual, at.scale)),
      whole_(gram(at, weights_, 0, residual.size())) {
  add_prior(at, whole_);
}

std::vector<double> LeftOut::values(const Fold& left) const {
  const Solution& at = at_;
  const Gram fold = gram(at, weights_, left.first, left.count);
  std::vector<double> values = at.values;
  std::vector<Eigen::Index> moved;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!(at.parameters[k].rough > 0.0)) moved.push_back(Eigen::Index(k));
  if (moved.empty()) return values;
  const Eigen::MatrixXd all = whole_.a(moved, moved), part = fold.a(moved, moved);
  const Eigen::VectorXd unit = all.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd a = unit.asDiagonal() * all * unit.asDiagonal();
  a.diagonal().array() += 1e-12;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      unit.asDiagonal() * part * unit.asDiagonal(), a);
  Eigen::VectorXd along = eigen.eigenvectors().transpose() * (unit.asDiagonal() * fold.b(moved));
  for (Eigen::Index k = 0; k < along.size(); ++k) {
    const double share = eigen.eigenvalues()(k);  // of what is known of this direction
    along(k) = share > kHeldOut.most_of_one_fold ? 0.0 : along(k) / (1.0 - share);
  }
  const Eigen::VectorXd step = unit.asDiagonal() * (eigen.eigenvectors() * along);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const auto k = std::size_t(moved[i]);
    const Parameter& p = at.parameters[k];
    values[k] =
        std::clamp(value_at(p, coordinate(p, values[k]) + step(Eigen::Index(i))), p.low, p.high);
  }
  return values;
}

Squares squares_between(const ResidualModel& model, const Structure& structure,
                        std::span<const double> values, int trial, double from_s, double to_s) {
  const Residuals r = model.full_rate(structure, values, trial);
  Squares out;
  out.channels.assign(r.channels.size(), 0.0);
  for (std::size_t k = 0; k < r.t_s.size(); ++k) {
    const double t = r.t_s[k] - r.t_s.front();
    if (t < from_s || t > to_s || r.judgement[k] != Judgement::judged) continue;
    for (std::size_t c = 0; c < r.channels.size(); ++c)
      out.channels[c] += r.channels[c][k] * r.channels[c][k];
    out.judged += r.channels[0][k] * r.channels[0][k];
    out.count += 1.0;
  }
  return out;
}

double root_mean(double sum, double count) {
  return count > 0.0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

double held_out_rmse(const Residual& residual, const Solution& at) {
  double sum = 0.0, count = 0.0;
  for (const Squares& s : held_out_sums(residual, at)) sum += s.judged, count += s.count;
  return root_mean(sum, count);
}

const Eigen::VectorXd& held_out_squares(const Residual& residual, const Solution& at) {
  if (at.held_out_squares.size() > 0) return at.held_out_squares;
  const auto sums = held_out_sums(residual, at);
  Eigen::VectorXd out(sums.size());
  for (std::size_t f = 0; f < sums.size(); ++f)
    out(Eigen::Index(f)) = sums[f].count > 0.0 ? sums[f].judged / sums[f].count
                                               : std::numeric_limits<double>::quiet_NaN();
  at.held_out_squares = std::move(out);
  return at.held_out_squares;
}

Eigen::VectorXd held_out_losses(const Residual& residual, const Solution& at, double scale) {
  const auto folds = folds_of(residual);
  const LeftOut left_out(residual, at);
  Eigen::VectorXd out(folds.size());
  parallel(int(folds.size()), residual.threads(), [&](int f) {
    const Fold& fold = folds[std::size_t(f)];
    const auto values = left_out.values(fold);
    Eigen::VectorXd step(at.values.size());
    for (std::size_t k = 0; k < at.values.size(); ++k)
      step(Eigen::Index(k)) =
          coordinate(at.parameters[k], values[k]) - coordinate(at.parameters[k], at.values[k]);
    const Eigen::Index begin = residual.offset(fold.trial),
                       all = residual.offset(fold.trial + 1) - begin;
    Eigen::VectorXd trial =
        at.residual.segment(begin, all) + at.jacobian.middleRows(begin, all) * step;
    residual.problem().leave_stretches_out(at.structure, fold.trial, kHeldOut.stretches_of_trial,
                                           trial);
    const auto here = at.residual.segment(fold.first, fold.count);
    const Eigen::VectorXd there = trial.segment(fold.first - begin, fold.count);
    // Exactly 0 is that of which the structure says nothing (dry friction at rest).
    const auto judged = (here.array() != 0.0).eval();
    out(f) = robust_loss(judged.select(there, 0.0), scale) / std::max(1.0, double(judged.count()));
  });
  return out;
}

}  // namespace lab
}  // namespace tractus
