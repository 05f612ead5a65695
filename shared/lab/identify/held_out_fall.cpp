#include "lab/identify/held_out_fall.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "lab/identify/held_out.hpp"
#include "lab/identify/parallel.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kFall = kSettings.selection;

/// A held-out sample that both structures judge: squares of their difference and of what each leaves.
struct Compared {
  double difference, smaller, larger;
};

std::vector<Compared> compared_samples(std::size_t of_norm, const Fold& fold,
                                       const Residuals& smaller, const Residuals& larger) {
  const std::size_t first = of_norm > 0 ? 1 : 0, end = first + std::max<std::size_t>(1, of_norm);
  std::vector<Compared> out;
  for (std::size_t k = 0; k < smaller.t_s.size(); ++k) {
    const double t_s = smaller.t_s[k] - smaller.t_s.front();
    if (t_s < fold.from_s || t_s > fold.to_s || smaller.judgement[k] != Judgement::judged ||
        larger.judgement[k] != Judgement::judged)
      continue;
    Compared now{};
    for (std::size_t c = first; c < end; ++c) {
      const double a = smaller.channels[c][k], b = larger.channels[c][k];
      now.difference += (a - b) * (a - b);
      now.smaller += a * a;
      now.larger += b * b;
    }
    out.push_back(now);
  }
  return out;
}

/// By fold.
std::vector<std::vector<Compared>> held_out_samples(const Residual& residual,
                                                    const Solution& smaller,
                                                    const Solution& larger) {
  const Problem& problem = residual.problem();
  const auto folds = folds_of(residual);
  const LeftOut of_smaller(residual, smaller), of_larger(residual, larger);
  std::vector<std::vector<Compared>> out(folds.size());
  parallel(int(folds.size()), residual.threads(), [&](int f) {
    const Fold& fold = folds[std::size_t(f)];
    const auto left = [&](const Solution& at, const LeftOut& of) {
      return problem.full_rate(at.structure, of.values(fold), fold.trial);
    };
    out[std::size_t(f)] = compared_samples(problem.channels().front().components, fold,
                                           left(smaller, of_smaller), left(larger, of_larger));
  });
  return out;
}

}  // namespace

double large_from(std::vector<double> squares) {
  std::ranges::sort(squares, std::greater<>());
  const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
  const double fewest = kFall.least_region * double(squares.size());
  double held = 0.0, count = 0.0;
  for (const double square : squares) {
    held += square, count += 1.0;
    if (count >= fewest && held >= kFall.most_of_difference * sum) return square;
  }
  return squares.empty() ? 0.0 : squares.back();
}

HeldOutFall held_out_fall_where_different(const Residual& residual, const Solution& smaller,
                                          const Solution& larger) {
  const auto folds = held_out_samples(residual, smaller, larger);
  std::vector<double> differences;
  for (const auto& fold : folds)
    for (const Compared& sample : fold) differences.push_back(sample.difference);
  const double large = large_from(std::move(differences));
  double before = 0.0, after = 0.0, trials = 0.0, better = 0.0;
  for (const auto& fold : folds) {
    double fold_before = 0.0, fold_after = 0.0;
    for (const Compared& sample : fold)
      if (sample.difference >= large) fold_before += sample.smaller, fold_after += sample.larger;
    if (!(fold_before > 0.0)) continue;
    before += fold_before, after += fold_after, trials += 1.0, better += fold_after < fold_before;
  }
  return trials > 0.0 ? HeldOutFall{1.0 - std::sqrt(after / before), better / trials}
                      : HeldOutFall{};
}

bool predicts_better(const Residual& residual, const Solution& smaller, double rmse_smaller,
                     const Solution& larger, double rmse_larger) {
  if (rmse_larger < (1.0 - kFall.least_fall) * rmse_smaller) return true;
  if (!(rmse_larger < rmse_smaller)) return false;
  // What is free in each trial follows the trial's own noise, and acts everywhere.
  const Problem& problem = residual.problem();
  if (problem.free_per_trial(larger.structure) > problem.free_per_trial(smaller.structure))
    return false;
  const HeldOutFall there = held_out_fall_where_different(residual, smaller, larger);
  return there.share >= kFall.least_fall_there && there.trials >= kSettings.diagnosis.most_trials;
}

}  // namespace lab
}  // namespace tractus
