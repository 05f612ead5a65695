#include "statistics/anova/anova.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/summary/modified_z.hpp"

namespace tractus {
namespace statistics {
namespace {

core::Result<void> check(const Groups& groups) {
  core::require(groups.names.size() == groups.values.size(), "every group has a name");
  if (groups.values.size() < 2)
    return core::bad_input("one group: there is nothing to compare it with");
  Eigen::Index n = 0;
  for (std::size_t j = 0; j < groups.values.size(); ++j) {
    n += groups.values[j].size();
    if (groups.values[j].size() == 0)
      return core::bad_input("group '" + groups.names[j] + "' is empty");
    if (!groups.values[j].allFinite())
      return core::bad_input("group '" + groups.names[j] +
                             "' holds a value that is not a finite number");
  }
  if (n <= static_cast<Eigen::Index>(groups.values.size()))
    return core::bad_input("every group holds one value: there is no spread within groups");
  return {};
}

/// Sum of squares about the mean, and that mean as a difference from `shift`.
struct Moments {
  long double mean = 0.0L, squares = 0.0L;
};

Moments moments(const Vector& values, double shift) {
  Moments out;
  const auto n = static_cast<long double>(values.size());
  const auto from = [&](double v) { return static_cast<long double>(v) - shift; };
  for (const double v : values) out.mean += from(v);
  out.mean /= n;
  long double rest = 0.0L;
  for (const double v : values) {
    const long double d = from(v) - out.mean;
    rest += d;
    out.squares += d * d;
  }
  out.squares -= rest * rest / n;
  out.mean += rest / n;
  return out;
}

void add_effect_sizes(OneWay& out) {
  const double total = out.ss_between + out.ss_within;
  const double ms_within = out.ss_within / out.df_within;
  out.residual_sd = std::sqrt(ms_within);
  out.eta_squared = out.ss_between / total;
  out.omega_squared = (out.ss_between - out.df_between * ms_within) / (total + ms_within);
  out.epsilon_squared = (out.ss_between - out.df_between * ms_within) / total;
  out.cohen_f = std::sqrt(out.ss_between / out.ss_within);
}

core::Result<SpreadTest> anova_of_deviations(
    const Groups& groups, const std::function<double(const Vector&)>& middle_of) {
  TRY(check(groups));
  Groups deviations = groups;
  for (auto& values : deviations.values) values = (values.array() - middle_of(values)).abs();
  const auto test = TRY(one_way(deviations));
  return SpreadTest{test.f, test.df_between, test.df_within, test.p};
}

/// Variance of each group; each must have one, and not 0.
core::Result<std::vector<double>> variances(const Groups& groups) {
  TRY(check(groups));
  std::vector<double> out;
  for (std::size_t j = 0; j < groups.values.size(); ++j) {
    const auto& values = groups.values[j];
    const double squares = static_cast<double>(moments(values, values[0]).squares);
    if (!(squares > 0.0)) return core::bad_input("group '" + groups.names[j] + "' has no spread");
    out.push_back(squares / static_cast<double>(values.size() - 1));
  }
  return out;
}

}  // namespace

Groups grouped(const std::vector<std::string>& labels, const Vector& values) {
  core::require(labels.size() == static_cast<std::size_t>(values.size()), "one label per value");
  Groups out;
  std::map<std::string, std::size_t> place;
  std::vector<std::vector<double>> sorted;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto [at, is_new] = place.try_emplace(labels[i], sorted.size());
    if (is_new) {
      out.names.push_back(labels[i]);
      sorted.emplace_back();
    }
    sorted[at->second].push_back(values[static_cast<Eigen::Index>(i)]);
  }
  for (const auto& group : sorted)
    out.values.push_back(
        Eigen::Map<const Vector>(group.data(), static_cast<Eigen::Index>(group.size())));
  return out;
}

Groups grouped(const std::vector<std::size_t>& places, std::vector<std::string> names,
               const Vector& values) {
  core::require(places.size() == static_cast<std::size_t>(values.size()), "one place per value");
  Groups out{std::move(names), {}};
  std::vector<Eigen::Index> sizes(out.names.size(), 0);
  for (const std::size_t place : places) ++sizes[place];
  std::vector<double*> ends;
  for (const Eigen::Index size : sizes) out.values.emplace_back(size);
  for (auto& values_of : out.values) ends.push_back(values_of.data());
  for (std::size_t i = 0; i < places.size(); ++i)
    *ends[places[i]]++ = values[static_cast<Eigen::Index>(i)];
  return out;
}

core::Result<OneWay> one_way(const Groups& groups) {
  TRY(check(groups));
  const double shift = groups.values[0][0];
  OneWay out;
  std::vector<Moments> parts;
  long double within = 0.0L, sum = 0.0L, n = 0.0L;
  for (const auto& values : groups.values) {
    const auto size = static_cast<long double>(values.size());
    parts.push_back(moments(values, shift));
    within += parts.back().squares;
    sum += size * parts.back().mean;
    n += size;
    out.means.push_back(static_cast<double>(shift + parts.back().mean));
    out.deviations.push_back(static_cast<double>(std::sqrt(parts.back().squares / (size - 1.0L))));
  }
  long double between = 0.0L;
  for (std::size_t j = 0; j < parts.size(); ++j) {
    const long double d = parts[j].mean - sum / n;
    between += static_cast<long double>(groups.values[j].size()) * d * d;
  }
  const auto k = static_cast<long double>(parts.size());
  if (!(within > 0.0L))
    return core::bad_input("every group is constant: there is no spread to judge by");
  out.grand_mean = static_cast<double>(shift + sum / n);
  out.ss_between = static_cast<double>(between);
  out.ss_within = static_cast<double>(within);
  out.df_between = static_cast<double>(k - 1.0L);
  out.df_within = static_cast<double>(n - k);
  out.f = static_cast<double>((between / (k - 1.0L)) / (within / (n - k)));
  if (!std::isfinite(out.ss_within) || !(out.ss_within > 0.0) || !std::isfinite(out.ss_between))
    return core::Error{core::Errc::out_of_range,
                       "the numbers are too large or too small for sums of squares: rescale them"};
  out.p = f_upper(out.f, out.df_between, out.df_within);
  add_effect_sizes(out);
  return out;
}

core::Result<SpreadTest> welch(const Groups& groups) {
  const auto variance = TRY(variances(groups));
  const double k = static_cast<double>(groups.values.size());
  std::vector<double> weight;
  double total = 0.0, mean = 0.0;
  for (std::size_t j = 0; j < groups.values.size(); ++j) {
    weight.push_back(static_cast<double>(groups.values[j].size()) / variance[j]);
    total += weight[j];
    mean += weight[j] * groups.values[j].mean();
  }
  mean /= total;
  double between = 0.0, lambda = 0.0;
  for (std::size_t j = 0; j < weight.size(); ++j) {
    const double d = groups.values[j].mean() - mean, share = 1.0 - weight[j] / total;
    between += weight[j] * d * d;
    lambda += share * share / static_cast<double>(groups.values[j].size() - 1);
  }
  const double square = k * k - 1.0;
  SpreadTest out;
  out.df1 = k - 1.0;
  out.df2 = square / (3.0 * lambda);
  out.statistic = between / (k - 1.0) / (1.0 + 2.0 * (k - 2.0) / square * lambda);
  out.p = f_upper(out.statistic, out.df1, out.df2);
  return out;
}

core::Result<SpreadTest> levene(const Groups& groups) {
  return anova_of_deviations(groups, [](const Vector& values) { return values.mean(); });
}

core::Result<SpreadTest> brown_forsythe(const Groups& groups) {
  return anova_of_deviations(groups, [](const Vector& values) {
    return median({values.begin(), values.end()});
  });
}

core::Result<SpreadTest> bartlett(const Groups& groups) {
  const auto variance = TRY(variances(groups));
  const double k = static_cast<double>(groups.values.size());
  double df = 0.0, pooled = 0.0, logs = 0.0, inverse = 0.0;
  for (std::size_t j = 0; j < variance.size(); ++j) {
    const double own = static_cast<double>(groups.values[j].size() - 1);
    df += own;
    pooled += own * variance[j];
    logs += own * std::log(variance[j]);
    inverse += 1.0 / own;
  }
  SpreadTest out;
  out.df1 = k - 1.0;
  out.statistic =
      (df * std::log(pooled / df) - logs) / (1.0 + (inverse - 1.0 / df) / (3.0 * (k - 1.0)));
  out.p = chi_squared_upper(out.statistic, out.df1);
  return out;
}

core::Result<std::vector<TukeyPair>> tukey(const Groups& groups) {
  const auto fit = TRY(one_way(groups));
  const double k = static_cast<double>(groups.values.size());
  // Bisection on the upper tail: its values are good to 1e-10, so q is to about 1e-9.
  double low = 0.0, high = 10.0;
  while (studentized_range_upper(high, k, fit.df_within) > 0.05) high *= 2.0;
  for (int i = 0; i < 48; ++i) {
    const double middle = 0.5 * (low + high);
    (studentized_range_upper(middle, k, fit.df_within) > 0.05 ? low : high) = middle;
  }
  std::vector<TukeyPair> out;
  for (std::size_t a = 0; a < groups.values.size(); ++a)
    for (std::size_t b = a + 1; b < groups.values.size(); ++b) {
      const double difference = fit.means[b] - fit.means[a];
      const double se =
          fit.residual_sd * std::sqrt(0.5 / static_cast<double>(groups.values[a].size()) +
                                      0.5 / static_cast<double>(groups.values[b].size()));
      out.push_back({groups.names[b] + "-" + groups.names[a], difference, difference - low * se,
                     difference + low * se,
                     studentized_range_upper(std::abs(difference) / se, k, fit.df_within)});
    }
  return out;
}

}  // namespace statistics
}  // namespace tractus
