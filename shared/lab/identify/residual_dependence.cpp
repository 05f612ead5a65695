#include "lab/identify/residual_dependence.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "lab/identify/parallel.hpp"
#include "lab/settings.hpp"
#include "lab/signal/fading_memory.hpp"
#include "lab/signal/knots.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kDependence = kSettings.dependence;

using Columns = std::vector<std::vector<double>>;

/// A trial (or, of fewer than four, a stretch of one) in blocks of neighbouring judged samples: the means of the signals
/// and of the error's components there.
struct Blocks {
  Columns signals, errors;    // [signal][block], [component][block]
  std::vector<double> count;  // samples of a block
  double squares = 0.0;       // of the error's components over the judged samples of all blocks
};

/// How far the motion has come since it last turned.
std::vector<double> since_reversal(const std::vector<double>& x, const std::vector<double>& v) {
  std::vector<double> out(x.size(), 0.0);
  double turned = x.empty() ? 0.0 : x.front(), last = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (v[k] * last < 0.0) turned = x[k];
    if (v[k] != 0.0) last = v[k];
    out[k] = x[k] - turned;
  }
  return out;
}

/// The states and what they leave behind.
States with_memory(States states, std::span<const double> t_s) {
  const auto at = [&](std::string_view name) {
    return std::size_t(std::ranges::find(states.names, name) - states.names.begin());
  };
  const std::size_t depth = at("depth_m"), velocity = at("velocity_m_s");
  if (depth == states.names.size() || velocity == states.names.size()) return states;
  const std::vector<double> x = states.values[depth], v = states.values[velocity];
  for (const double time_s : kDependence.memories_s) {
    states.names.push_back("earlier velocity");
    states.values.push_back(fading_memory(t_s, v, time_s));
  }
  states.names.push_back("way since reversal");
  states.values.push_back(since_reversal(x, v));
  return states;
}

double mean_square(std::span<const double> y) {
  return std::inner_product(y.begin(), y.end(), y.begin(), 0.0) / double(y.size());
}

/// Within how many samples the velocity hardly changes; no bound where it is not among the states.
std::size_t steady_samples(const States& states) {
  const auto at = std::ranges::find(states.names, "velocity_m_s");
  constexpr std::size_t kNoBound = std::numeric_limits<std::size_t>::max();
  if (at == states.names.end()) return kNoBound;
  const auto& v = states.values[std::size_t(at - states.names.begin())];
  std::vector<double> step(v.size());
  std::adjacent_difference(v.begin(), v.end(), step.begin());
  if (step.size() < 2) return kNoBound;
  const double square = mean_square(std::span(step).subspan(1));
  if (!(square > 0.0)) return kNoBound;
  const double samples = kDependence.longest_block_rad * std::sqrt(mean_square(v) / square);
  return samples < double(v.size()) ? std::max<std::size_t>(1, std::size_t(samples)) : kNoBound;
}

/// Blocks of so many samples, and from the start of one to that of the next: of a fast motion that is sampled for long,
/// a part is looked at, for means over its periods would show nothing.
struct BlockPlan {
  std::size_t length, spacing;
};

/// The blocks of a trial's samples from `from` to `end`.
Blocks blocks_of(const Residuals& r, const States& states, std::span<const std::size_t> components,
                 std::size_t from, std::size_t end, BlockPlan plan) {
  Blocks out;
  out.signals.resize(states.names.size());
  out.errors.resize(components.size());
  for (std::size_t first = from; first < end; first += plan.spacing) {
    const std::size_t last = std::min(end, first + plan.length);
    double count = 0.0;
    std::vector<double> signal(states.names.size(), 0.0), error(components.size(), 0.0);
    for (std::size_t k = first; k < last; ++k) {
      if (r.judgement[k] != Judgement::judged) continue;
      count += 1.0;
      for (std::size_t s = 0; s < signal.size(); ++s) signal[s] += states.values[s][k];
      for (std::size_t c = 0; c < components.size(); ++c) {
        const double e = r.channels[components[c]][k];
        error[c] += e;
        out.squares += e * e;
      }
    }
    if (count == 0.0) continue;
    for (std::size_t s = 0; s < signal.size(); ++s) out.signals[s].push_back(signal[s] / count);
    for (std::size_t c = 0; c < error.size(); ++c) out.errors[c].push_back(error[c] / count);
    out.count.push_back(count);
  }
  return out;
}

struct Set {
  std::vector<std::string> names;
  std::vector<Blocks> folds;
};

Set set_of(const Residual& residual, const Solution& at) {
  const Problem& problem = residual.problem();
  std::vector<std::size_t> components;
  const std::size_t of_norm = problem.channels().front().components;
  for (std::size_t c = 0; c < std::max<std::size_t>(1, of_norm); ++c)
    components.push_back(of_norm > 0 ? c + 1 : c);
  const int pieces = problem.trials() >= kSettings.validation.fewest_trials
                         ? 1
                         : kSettings.validation.stretches / problem.trials();
  std::vector<std::vector<Blocks>> folds(std::size_t(problem.trials()));
  Set out;
  out.names =
      with_memory(problem.predictors(0), problem.full_rate(at.structure, at.values, 0).t_s).names;
  parallel(problem.trials(), residual.threads(), [&](int k) {
    const Residuals r = problem.full_rate(at.structure, at.values, k);
    const States states = with_memory(problem.predictors(k), r.t_s);
    const std::size_t n = r.t_s.size(), spacing = 1 + n / kDependence.blocks_per_trial;
    const BlockPlan plan{std::min(spacing, steady_samples(states)), spacing};
    for (int p = 0; p < pieces; ++p)
      folds[std::size_t(k)].push_back(
          blocks_of(r, states, components, n * std::size_t(p) / std::size_t(pieces),
                    n * std::size_t(p + 1) / std::size_t(pieces), plan));
  });
  for (auto& of_trial : folds)
    for (Blocks& fold : of_trial) out.folds.push_back(std::move(fold));
  return out;
}

/// Quantiles of a signal over all folds.
std::vector<double> knots_of(const Set& set, std::size_t signal, int count) {
  std::vector<double> all;
  for (const Blocks& fold : set.folds)
    all.insert(all.end(), fold.signals[signal].begin(), fold.signals[signal].end());
  std::ranges::sort(all);
  std::vector<double> out;
  if (all.empty()) return out;
  for (int k = 0; k < count; ++k) {
    const double v = all[std::size_t(double(all.size() - 1) * k / (count - 1))];
    if (out.empty() || v > out.back()) out.push_back(v);
  }
  return out;
}

/// Hats over one signal, or products of hats over two: the columns that differ from 0 at a block.
class Hats {
 public:
  Hats(const Set& set, std::size_t a) : a_(a), knots_a_(knots_of(set, a, kDependence.knots)) {}
  Hats(const Set& set, std::size_t a, std::size_t b)
      : a_(a),
        b_(b),
        pair_(true),
        knots_a_(knots_of(set, a, kDependence.knots_of_pair)),
        knots_b_(knots_of(set, b, kDependence.knots_of_pair)) {}

  bool any() const { return knots_a_.size() > 2 && (!pair_ || knots_b_.size() > 2); }
  Eigen::Index size() const {
    return Eigen::Index(knots_a_.size() * (pair_ ? knots_b_.size() : 1));
  }
  /// take(column, value).
  template <class Take>
  void at(const Blocks& fold, std::size_t block, const Take& take) const {
    const auto [first, u] = place_between(knots_a_, fold.signals[a_][block]);
    const auto i = Eigen::Index(first);
    if (!pair_) {
      take(i, 1.0 - u), take(i + 1, u);
      return;
    }
    const auto [second, w] = place_between(knots_b_, fold.signals[b_][block]);
    const auto j = Eigen::Index(second), n = Eigen::Index(knots_b_.size());
    take(i * n + j, (1.0 - u) * (1.0 - w)), take(i * n + j + 1, (1.0 - u) * w);
    take((i + 1) * n + j, u * (1.0 - w)), take((i + 1) * n + j + 1, u * w);
  }

 private:
  std::size_t a_ = 0, b_ = 0;
  bool pair_ = false;
  std::vector<double> knots_a_, knots_b_;
};

using Row = std::vector<std::pair<Eigen::Index, double>>;

/// The functions' values at a block, those that differ from 0.
Row row_of(const std::vector<Hats>& all, const Blocks& fold, std::size_t block) {
  Row row;
  Eigen::Index first = 0;
  for (const Hats& hats : all) {
    hats.at(fold, block, [&](Eigen::Index c, double v) { row.emplace_back(first + c, v); });
    first += hats.size();
  }
  return row;
}

/// A sum of functions and its normal equations, fold by fold.
class Sum {
 public:
  Sum(const Set& set, std::vector<Hats> all) : set_(set), all_(std::move(all)) {
    Eigen::Index size = 0;
    for (const Hats& hats : all_) size += hats.size();
    const auto components = Eigen::Index(set.folds.front().errors.size());
    for (const Blocks& fold : set.folds) {
      Eigen::MatrixXd& a = a_.emplace_back(Eigen::MatrixXd::Zero(size, size));
      Eigen::MatrixXd& b = b_.emplace_back(Eigen::MatrixXd::Zero(size, components));
      for (std::size_t k = 0; k < fold.count.size(); ++k) {
        const Row row = row_of(all_, fold, k);
        for (const auto& [i, u] : row) {
          for (const auto& [j, w] : row) a(i, j) += u * w;
          for (Eigen::Index c = 0; c < components; ++c)
            b(i, c) += u * fold.errors[std::size_t(c)][k];
        }
      }
    }
  }

  const std::vector<Hats>& functions() const { return all_; }
  /// By how much the squares of a fold fall if the sum is fitted to the folds of `to`, but for that one.
  double taken(std::size_t fold, const std::vector<std::size_t>& to) const {
    const Eigen::Index size = a_.front().rows();
    Eigen::MatrixXd a = kDependence.ridge * Eigen::MatrixXd::Identity(size, size);
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(size, b_.front().cols());
    for (const std::size_t f : to)
      if (f != fold) a += a_[f], b += b_[f];
    const Eigen::MatrixXd x = a.llt().solve(b);
    const Blocks& of = set_.folds[fold];
    double sum = 0.0;
    for (std::size_t k = 0; k < of.count.size(); ++k) {
      const Row row = row_of(all_, of, k);
      for (Eigen::Index c = 0; c < x.cols(); ++c) {
        double value = 0.0;
        for (const auto& [i, u] : row) value += u * x(i, c);
        const double e = of.errors[std::size_t(c)][k];
        sum += of.count[k] * (e * e - (e - value) * (e - value));
      }
    }
    return sum;
  }
  /// Share of the squares of some folds that it takes away, each fitted to the others of them.
  double share(const std::vector<std::size_t>& of) const {
    double sum = 0.0, squares = 0.0;
    for (const std::size_t f : of) sum += taken(f, of), squares += set_.folds[f].squares;
    return squares > 0.0 ? std::clamp(sum / squares, 0.0, 1.0) : 0.0;
  }

 private:
  const Set& set_;
  std::vector<Hats> all_;
  std::vector<Eigen::MatrixXd> a_, b_;  // by fold
};

/// Forward selection, on some folds alone, of the functions that take away most of their squares. Empty if none does.
std::optional<Sum> best_sum(const Set& set, const std::vector<Hats>& all,
                            const std::vector<std::size_t>& of, int threads) {
  std::optional<Sum> best;
  double taken = 0.0;
  for (std::size_t size = 0; size < kDependence.most_functions; ++size) {
    std::vector<double> with(all.size());
    const auto larger = [&](std::size_t k) {
      std::vector<Hats> sum = best ? best->functions() : std::vector<Hats>{};
      sum.push_back(all[k]);
      return Sum(set, std::move(sum));
    };
    parallel(int(all.size()), threads,
             [&](int k) { with[std::size_t(k)] = larger(std::size_t(k)).share(of); });
    const auto most = std::ranges::max_element(with);
    if (most == with.end() || *most < taken + kDependence.least_more) break;
    taken = *most;
    best.emplace(larger(std::size_t(most - with.begin())));
  }
  return best;
}

/// What functions take away that were chosen and fitted without the folds that they are judged by.
void judge(const Set& set, const std::vector<Hats>& all, int threads, ResidualDependence& out) {
  const std::size_t n = set.folds.size(), groups = std::min(n, kDependence.groups);
  double sum = 0.0, squares = 0.0, better = 0.0;
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<std::size_t> others;
    for (std::size_t f = 0; f < n; ++f)
      if (f % groups != g) others.push_back(f);
    const auto best = best_sum(set, all, others, threads);
    for (std::size_t f = g; f < n; f += groups) {
      const double taken = best ? best->taken(f, others) : 0.0;
      sum += taken, squares += set.folds[f].squares, better += taken > 0.0;
    }
  }
  out.predictable = squares > 0.0 ? std::clamp(sum / squares, 0.0, 1.0) : 0.0;
  out.trials_better = better / double(n);
}

/// "velocity_m_s" → "velocity".
std::string readable(std::string name) {
  for (const char* unit : {"_rad_s", "_m_s2", "_m_s", "_rad", "_Nm", "_N", "_m", "_s"})
    if (name.ends_with(unit)) {
      name.resize(name.size() - std::string_view(unit).size());
      break;
    }
  std::ranges::replace(name, '_', ' ');
  return name;
}

}  // namespace

ResidualDependence residual_dependence(const Residual& residual, const Solution& solution) {
  const Set set = set_of(residual, solution);
  ResidualDependence out;
  std::vector<std::pair<double, std::size_t>> alone;
  std::vector<Hats> all;
  std::vector<std::size_t> every(set.folds.size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  for (std::size_t s = 0; s < set.names.size(); ++s) {
    const Hats hats(set, s);
    if (!hats.any()) continue;
    alone.emplace_back(Sum(set, {hats}).share(every), s);
    all.push_back(hats);
  }
  std::ranges::stable_sort(alone, std::greater<>(), &std::pair<double, std::size_t>::first);
  for (std::size_t i = 0; i < std::min(kDependence.paired, alone.size()); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const Hats hats(set, alone[j].second, alone[i].second); hats.any()) all.push_back(hats);
  judge(set, all, residual.threads(), out);
  for (std::size_t k = 0; k < std::min(kDependence.named, alone.size()); ++k) {
    const auto& [share, signal] = alone[k];
    if (share < kDependence.worth_naming) break;
    out.explained = std::max(out.explained, share);
    out.words += fmt::format("{}{} ({:.0f} %)", out.words.empty() ? "" : ", ",
                             readable(set.names[signal]), 100.0 * share);
  }
  if (out.words.empty())
    out.words =
        "no recorded signal by itself predicts it: an influence that was not measured, or a "
        "combination";
  return out;
}

}  // namespace lab
}  // namespace tractus
