#include "assessment/cohort_progress.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/distributions/distributions.hpp"
#include "statistics/distributions/proportions.hpp"

namespace tractus {
namespace assessment {
namespace {

constexpr std::size_t kBinTrials = 5, kPaceTrials = 10;
constexpr double kBehindAlpha = 0.05;

/// Correct answers of the trials [from, to), counted from 0.
double right_between(const Answers& of, std::size_t from, std::size_t to) {
  return static_cast<double>(
      std::count(of.begin() + std::ptrdiff_t(from), of.begin() + std::ptrdiff_t(to), true));
}

ProgressBin bin_of(const std::vector<Answers>& trainees, std::size_t from, std::size_t to) {
  std::vector<double> shares;
  for (const Answers& one : trainees)
    if (one.size() >= to) shares.push_back(right_between(one, from, to) / double(to - from));
  ProgressBin out{from + 1, to, shares.size()};
  const double n = double(shares.size());
  for (const double share : shares) out.share += share / n;
  double squares = 0.0;
  for (const double share : shares) squares += std::pow(share - out.share, 2);
  const double reach = shares.size() < 2 ? std::nan("")
                                         : statistics::student_t_quantile(0.975, n - 1.0) *
                                               std::sqrt(squares / (n - 1.0) / n);
  out.low = out.share - reach;
  out.high = out.share + reach;
  return out;
}

}  // namespace

std::vector<ProgressBin> progress_bins(const std::vector<Answers>& trainees) {
  std::size_t most = 0;
  for (const Answers& one : trainees) most = std::max(most, one.size());
  std::vector<ProgressBin> out;
  for (std::size_t to = kBinTrials; to <= most; to += kBinTrials)
    out.push_back(bin_of(trainees, to - kBinTrials, to));
  return out;
}

Pace pace_of(const std::vector<Answers>& trainees, std::size_t trainee) {
  const Answers& own = trainees[trainee];
  const std::size_t to = own.size(), from = to - std::min(to, kPaceTrials);
  Pace out{.trials = to - from, .right = std::size_t(right_between(own, from, to))};
  statistics::Proportion others;
  for (std::size_t k = 0; k < trainees.size(); ++k) {
    const std::size_t end = std::min(to, trainees[k].size());
    if (k == trainee || end <= from) continue;
    others.trials += double(end - from);
    others.successes += right_between(trainees[k], from, end);
  }
  if (others.trials == 0.0 || out.trials == 0) return out;
  const statistics::Proportion mine{double(out.right), double(out.trials)};
  out.others = others.share();
  out.p = statistics::fisher_exact(mine, others);
  out.behind = mine.share() < *out.others && out.p <= kBehindAlpha;
  return out;
}

}  // namespace assessment
}  // namespace tractus
