#include "statistics/ranks/rank_tests.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/ranks/permutation.hpp"
#include "statistics/summary/modified_z.hpp"

namespace tractus {
namespace statistics {
namespace {

/// Σ over tied groups of a function of their size.
template <class F>
double over_ties(const Vector& values, F of_size) {
  std::map<double, double> sizes;
  for (const double v : values) sizes[v] += 1.0;
  double sum = 0.0;
  for (const auto& [_, size] : sizes) sum += of_size(size);
  return sum;
}

double cubes_of_ties(const Vector& values) {
  return over_ties(values, [](double t) { return t * t * t - t; });
}

/// All values in one vector, and which group each is of.
struct Pooled {
  Vector values;
  std::vector<std::size_t> group;
};

core::Result<Pooled> pooled(const Groups& groups) {
  std::vector<double> all;
  Pooled out;
  for (std::size_t j = 0; j < groups.values.size(); ++j) {
    if (groups.values[j].size() == 0)
      return core::Error{core::Errc::bad_input, "group '" + groups.names[j] + "' is empty"};
    for (const double v : groups.values[j]) {
      all.push_back(v);
      out.group.push_back(j);
    }
  }
  out.values = Eigen::Map<const Vector>(all.data(), std::ssize(all));
  if (groups.values.size() < 2 || !out.values.allFinite())
    return core::bad_input("rank tests need two groups of finite numbers");
  if (out.values.maxCoeff() == out.values.minCoeff())
    return core::bad_input("the values are all equal");
  return out;
}

std::vector<double> sums_by_group(const Vector& scores, const Pooled& of, std::size_t groups) {
  std::vector<double> out(groups, 0.0);
  for (std::size_t i = 0; i < of.group.size(); ++i)
    out[of.group[i]] += scores[static_cast<Eigen::Index>(i)];
  return out;
}

/// Number of subsets of the doubled ranks by [size][sum], all sizes folded into one when not asked.
std::vector<std::vector<double>> subset_counts(const std::vector<int>& doubled, bool by_size) {
  const auto total = static_cast<std::size_t>(std::accumulate(doubled.begin(), doubled.end(), 0));
  const std::size_t sizes = by_size ? doubled.size() + 1 : 1;
  std::vector<std::vector<double>> count(sizes, std::vector<double>(total + 1, 0.0));
  count[0][0] = 1.0;
  for (const int rank : doubled) {
    const auto r = static_cast<std::size_t>(rank);
    for (std::size_t size = sizes; size-- > 0;) {
      if (by_size && size == 0) break;
      const auto& from = count[by_size ? size - 1 : 0];
      for (std::size_t sum = total; sum >= r; --sum) count[size][sum] += from[sum - r];
    }
  }
  return count;
}

std::vector<int> doubled_ranks(const Vector& values) {
  std::vector<int> out;
  for (const double r : ranks(values)) out.push_back(static_cast<int>(std::lround(2.0 * r)));
  return out;
}

/// 2 min(P(S ≤ s), P(S ≥ s)), at most 1.
double two_sided(const std::vector<double>& count, std::size_t at) {
  double low = 0.0, high = 0.0, all = 0.0;
  for (std::size_t sum = 0; sum < count.size(); ++sum) {
    all += count[sum];
    if (sum <= at) low += count[sum];
    if (sum >= at) high += count[sum];
  }
  return std::min(1.0, 2.0 * std::min(low, high) / all);
}

core::Result<void> check_pairs(const Vector& x, const Vector& y) {
  core::require(x.size() == y.size(), "a correlation is of pairs");
  if (x.size() < 3 || !x.allFinite() || !y.allFinite())
    return core::bad_input("a correlation needs three pairs of finite numbers");
  if (x.maxCoeff() == x.minCoeff() || y.maxCoeff() == y.minCoeff())
    return core::bad_input("x or y is the same everywhere: nothing can go with it");
  return {};
}

core::Result<Matrix> row_ranks(const Matrix& values) {
  if (values.rows() < 2 || values.cols() < 2 || !values.allFinite())
    return core::bad_input("two subjects, two levels and every value are needed");
  Matrix out(values.rows(), values.cols());
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    out.row(i) = ranks(values.row(i).transpose()).transpose();
  return out;
}

constexpr Eigen::Index kMostExactKendall = 50;

/// Pairs that x and y order differently, and pairs tied in both.
struct Crossings {
  double discordant = 0.0, tied_in_both = 0.0;
};

/// By a merge sort of y in the order of x, ties of x in the order of y (Knight 1966).
Crossings crossings(const Vector& x, const Vector& y) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(x.size()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Eigen::Index i) { return std::pair(x[i], y[i]); });
  Crossings out;
  double run = 0.0;
  std::vector<double> now;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && x[order[i]] == x[order[i - 1]] && y[order[i]] == y[order[i - 1]];
    run = same ? run + 1.0 : 0.0;
    out.tied_in_both += run;
    now.push_back(y[order[i]]);
  }
  std::vector<double> merged(now.size());
  for (std::size_t width = 1; width < now.size(); width *= 2) {
    for (std::size_t from = 0; from < now.size(); from += 2 * width) {
      const std::size_t middle = std::min(from + width, now.size());
      const std::size_t end = std::min(from + 2 * width, now.size());
      for (std::size_t l = from, r = middle, to = from; to < end; ++to) {
        const bool right = l == middle || (r < end && now[r] < now[l]);
        if (right && l < middle) out.discordant += static_cast<double>(middle - l);
        merged[to] = now[right ? r++ : l++];
      }
    }
    std::swap(now, merged);
  }
  return out;
}

/// Two-sided: how many orders of n have so few, or so many, discordant pairs.
double kendall_exact(Eigen::Index n, double discordant) {
  std::vector<double> chance{1.0};  // of each number of discordant pairs
  for (Eigen::Index k = 2; k <= n; ++k) {
    std::vector<double> next(chance.size() + static_cast<std::size_t>(k) - 1, 0.0);
    for (std::size_t i = 0; i < chance.size(); ++i)
      for (std::size_t j = 0; j < static_cast<std::size_t>(k); ++j)
        next[i + j] += chance[i] / static_cast<double>(k);
    chance = std::move(next);
  }
  const auto tail = std::min(discordant, static_cast<double>(chance.size() - 1) - discordant);
  double sum = 0.0;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(tail); ++i) sum += chance[i];
  return std::min(1.0, 2.0 * sum);
}

}  // namespace

Vector ranks(const Vector& values) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::sort(order, {}, [&](Eigen::Index i) { return values[i]; });
  Vector out(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    const double mean = 0.5 * static_cast<double>(i + 1 + end);
    for (; i < end; ++i) out[order[i]] = mean;
  }
  return out;
}

core::Result<KruskalWallis> kruskal_wallis(const Groups& groups) {
  const auto all = TRY(pooled(groups));
  const double n = static_cast<double>(all.values.size());
  const auto sums = sums_by_group(ranks(all.values), all, groups.values.size());
  double h = 0.0;
  for (std::size_t j = 0; j < sums.size(); ++j) {
    const double size = static_cast<double>(groups.values[j].size());
    const double off = sums[j] / size - 0.5 * (n + 1.0);
    h += size * off * off;
  }
  KruskalWallis out;
  out.h = 12.0 * h / (n * (n + 1.0)) / (1.0 - cubes_of_ties(all.values) / (n * n * n - n));
  out.df = static_cast<double>(sums.size()) - 1.0;
  out.p = chi_squared_upper(out.h, out.df);
  out.epsilon_squared = out.h / (n - 1.0);
  return out;
}

namespace {

/// Deals ranks to groups in every way, the first rank left always to each group with room in turn.
struct Dealing {
  const Vector& ranks;
  std::vector<double> room, sizes, sums;
  double limit = 0.0, as_extreme = 0.0, arrangements = 0.0;

  void deal(Eigen::Index next) {
    if (next == ranks.size()) {
      double h = 0.0;
      for (std::size_t j = 0; j < sums.size(); ++j) h += sums[j] * sums[j] / sizes[j];
      arrangements += 1.0;
      as_extreme += h >= limit ? 1.0 : 0.0;
      return;
    }
    for (std::size_t j = 0; j < sums.size(); ++j) {
      if (room[j] == 0.0) continue;
      room[j] -= 1.0;
      sums[j] += ranks[next];
      deal(next + 1);
      sums[j] -= ranks[next];
      room[j] += 1.0;
    }
  }
};

}  // namespace

core::Result<ExactKruskal> kruskal_wallis_exact(const Groups& groups) {
  const auto all = TRY(pooled(groups));
  double log_ways = std::lgamma(static_cast<double>(all.values.size()) + 1.0);
  const Vector ranked = ranks(all.values);
  Dealing dealing{ranked, {}, {}, {}};
  double observed = 0.0;
  const auto sums = sums_by_group(ranked, all, groups.values.size());
  for (std::size_t j = 0; j < groups.values.size(); ++j) {
    const double size = static_cast<double>(groups.values[j].size());
    log_ways -= std::lgamma(size + 1.0);
    dealing.sizes.push_back(size);
    observed += sums[j] * sums[j] / size;
  }
  if (log_ways > std::log(2e7))
    return core::Error{core::Errc::too_large,
                       "over 20 million ways to deal the values: the exact test is for fewer"};
  dealing.room = dealing.sizes;
  dealing.sums.assign(dealing.sizes.size(), 0.0);
  dealing.limit = observed * (1.0 - 1e-12);  // ties with the observed count
  dealing.deal(0);
  return ExactKruskal{dealing.as_extreme, dealing.arrangements,
                      dealing.as_extreme / dealing.arrangements};
}

core::Result<SpreadTest> fligner_killeen(const Groups& groups) {
  Groups deviations = groups;
  for (auto& values : deviations.values)
    if (values.size() > 0) values = (values.array() - median({values.begin(), values.end()})).abs();
  const auto all = TRY(pooled(deviations));
  const double n = static_cast<double>(all.values.size());
  const Vector scores = ranks(all.values).unaryExpr([&](double r) {
    return normal_quantile(0.5 * (1.0 + r / (n + 1.0)));
  });
  const double mean = scores.mean();
  const double variance = (scores.array() - mean).square().sum() / (n - 1.0);
  const auto sums = sums_by_group(scores, all, groups.values.size());
  SpreadTest out;
  for (std::size_t j = 0; j < sums.size(); ++j) {
    const double size = static_cast<double>(groups.values[j].size());
    out.statistic += size * std::pow(sums[j] / size - mean, 2.0) / variance;
  }
  out.df1 = static_cast<double>(sums.size()) - 1.0;
  out.p = chi_squared_upper(out.statistic, out.df1);
  return out;
}

core::Result<Friedman> friedman(const Matrix& values) {
  const auto ranked = TRY(row_ranks(values));
  const double n = static_cast<double>(values.rows()), k = static_cast<double>(values.cols());
  double ties = 0.0;
  for (Eigen::Index i = 0; i < values.rows(); ++i) ties += cubes_of_ties(values.row(i).transpose());
  const double scale = n * k * (k + 1.0) - ties / (k - 1.0);
  if (!(scale > 0.0)) return core::bad_input("every subject is the same at every level");
  const Vector sums = ranked.colwise().sum();
  Friedman out;
  out.chi_squared = 12.0 * (sums.array() - 0.5 * n * (k + 1.0)).square().sum() / scale;
  out.df = k - 1.0;
  out.p = chi_squared_upper(out.chi_squared, out.df);
  out.kendall_w = out.chi_squared / (n * (k - 1.0));
  return out;
}

core::Result<Page> page_trend(const Matrix& values) {
  const auto ranked = TRY(row_ranks(values));
  const double n = static_cast<double>(values.rows()), k = static_cast<double>(values.cols());
  Page out;
  out.l = ranked.colwise().sum().transpose().dot(Vector::LinSpaced(values.cols(), 1.0, k));
  out.mean = n * k * (k + 1.0) * (k + 1.0) / 4.0;
  out.variance = n * k * k * (k + 1.0) * (k * k - 1.0) / 144.0;
  out.z = (out.l - out.mean) / std::sqrt(out.variance);
  out.p_rising = normal_upper(out.z);
  return out;
}

core::Result<RankTest> wilcoxon_signed_rank(const Vector& differences) {
  std::vector<double> kept;
  for (const double d : differences)
    if (d != 0.0) kept.push_back(d);
  const auto n = std::ssize(kept);
  if (n < 1 || !differences.allFinite())
    return core::bad_input("there is no difference other than 0");
  if (n > 200) return core::Error{core::Errc::too_large, "exact for up to 200 differences"};
  const Vector d = Eigen::Map<const Vector>(kept.data(), n);
  const auto doubled = doubled_ranks(d.cwiseAbs());
  std::size_t sum = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    if (d[i] > 0.0) sum += static_cast<std::size_t>(doubled[static_cast<std::size_t>(i)]);
  return RankTest{0.5 * static_cast<double>(sum), two_sided(subset_counts(doubled, false)[0], sum)};
}

core::Result<MannWhitney> mann_whitney(const Vector& x, const Vector& y) {
  if (x.size() < 1 || y.size() < 1 || !x.allFinite() || !y.allFinite())
    return core::bad_input("two samples of finite numbers are needed");
  if (x.size() + y.size() > 200)
    return core::Error{core::Errc::too_large, "exact for up to 200 values in all"};
  Vector all(x.size() + y.size());
  all << x, y;
  const auto doubled = doubled_ranks(all);
  const auto sum =
      static_cast<std::size_t>(std::accumulate(doubled.begin(), doubled.begin() + x.size(), 0));
  const double n = static_cast<double>(x.size()), m = static_cast<double>(y.size());
  MannWhitney out;
  out.w = 0.5 * static_cast<double>(sum) - 0.5 * n * (n + 1.0);
  out.p = two_sided(subset_counts(doubled, true)[static_cast<std::size_t>(x.size())], sum);
  out.cliff_delta = 2.0 * out.w / (n * m) - 1.0;
  return out;
}

core::Result<Correlation> spearman(const Vector& x, const Vector& y) {
  TRY(check_pairs(x, y));
  Vector a = ranks(x), b = ranks(y);
  a.array() -= a.mean();
  b.array() -= b.mean();
  const double df = static_cast<double>(x.size()) - 2.0;
  Correlation out;
  out.r = std::clamp(a.dot(b) / std::sqrt(a.squaredNorm() * b.squaredNorm()), -1.0, 1.0);
  out.statistic = out.r * std::sqrt(df / ((1.0 - out.r) * (1.0 + out.r)));
  out.p = student_t_two_sided(out.statistic, df);
  if (x.size() > 30) return out;
  if (const auto exact = permutation_slope(a, b, 4e6)) out.p_exact = exact->p;
  return out;
}

core::Result<Correlation> kendall(const Vector& x, const Vector& y) {
  TRY(check_pairs(x, y));
  const double n = static_cast<double>(x.size()), pairs = n * (n - 1.0);
  const auto two = [](double t) { return t * (t - 1.0); };
  const auto three = [](double t) { return t * (t - 1.0) * (t - 2.0); };
  const auto spread = [](double t) { return t * (t - 1.0) * (2.0 * t + 5.0); };
  const double tied_x = over_ties(x, two), tied_y = over_ties(y, two);
  const Crossings found = crossings(x, y);
  const double s = 0.5 * (pairs - tied_x - tied_y) + found.tied_in_both - 2.0 * found.discordant;
  const double variance = (spread(n) - over_ties(x, spread) - over_ties(y, spread)) / 18.0 +
                          tied_x * tied_y / (2.0 * pairs) +
                          over_ties(x, three) * over_ties(y, three) / (9.0 * pairs * (n - 2.0));
  Correlation out;
  out.r = 2.0 * s / std::sqrt((pairs - tied_x) * (pairs - tied_y));
  out.statistic = s / std::sqrt(variance);
  out.p = 2.0 * normal_upper(std::abs(out.statistic));
  if (tied_x == 0.0 && tied_y == 0.0 && x.size() <= kMostExactKendall)
    out.p_exact = kendall_exact(x.size(), found.discordant);
  return out;
}

}  // namespace statistics
}  // namespace tractus
