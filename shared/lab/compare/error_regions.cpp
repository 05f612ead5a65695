#include "lab/compare/error_regions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "lab/compare/error_tree.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kRegions = kSettings.regions;

/// Round numbers inside the feature's 2 to 98 % range, at most kRegions.most_edges: 1, 2, 2.5 or 5
/// times a power of ten apart.
std::vector<double> round_edges(std::vector<float> values) {
  if (values.empty()) return {};
  const auto at = [&](double share) {
    const auto nth = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
    std::ranges::nth_element(values, nth);
    return double(*nth);
  };
  const double low = at(0.02), high = at(0.98);
  if (!(high > low)) return {};
  const double finest = (high - low) / double(kRegions.most_edges);
  const double decade = std::pow(10.0, std::floor(std::log10(finest)));
  double step = 10.0 * decade;
  for (const double factor : {5.0, 2.5, 2.0, 1.0})
    if (factor * decade >= finest) step = factor * decade;
  std::vector<double> edges;
  for (double k = std::ceil(low / step); k * step < high; k += 1.0) edges.push_back(k * step);
  return edges;
}

/// A fixed scramble of whole numbers [Steele2014, SplitMix64's finaliser], so that neither trials
/// recorded in turn nor a motion that repeats falls in step with the halves.
std::uint64_t scrambled(std::uint64_t k) {
  k += 0x9e3779b97f4a7c15u;
  k = (k ^ (k >> 30)) * 0xbf58476d1ce4e5b9u;
  k = (k ^ (k >> 27)) * 0x94d049bb133111ebu;
  return k ^ (k >> 31);
}

/// Trials, or stretches of a single trial, dealt into the half that grows and the one that checks.
struct Halves {
  bool by_trials;
  std::vector<std::uint8_t> fills;  // [block]

  explicit Halves(std::size_t trials)
      : by_trials(trials > 1), fills(by_trials ? trials : kRegions.stretches) {
    std::vector<std::size_t> order(fills.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, [](std::size_t k) { return scrambled(k); });
    for (std::size_t k = 0; k < order.size() / 2; ++k) fills[order[k]] = 1;
  }
  std::uint32_t block(std::size_t trial, const TrialSamples& samples, std::size_t sample) const {
    return std::uint32_t(by_trials ? trial : kRegions.stretches * sample / samples.t_s.size());
  }
};

void add_rows(const Samples& samples, const Halves& halves, Rows& rows) {
  rows.residual.resize(samples.judged.size());
  for (std::size_t t = 0; t < samples.trials.size(); ++t) {
    const TrialSamples& trial = samples.trials[t];
    for (std::size_t row = 0; row < trial.rows(); ++row) {
      const std::size_t k = row * trial.stride;
      if (!trial.is_judged(k)) continue;
      rows.weight.push_back(double(std::min(trial.stride, trial.t_s.size() - k)));
      rows.error.push_back(samples.squared(trial, k));
      for (std::size_t c = 0; c < samples.judged.size(); ++c)
        rows.residual[c].push_back(trial.residual(samples.judged[c], k));
      rows.block.push_back(halves.block(t, trial, k));
      rows.fills.push_back(halves.fills[rows.block.back()]);
    }
  }
  rows.count = rows.weight.size();
  rows.blocks = halves.fills.size();
}

void add_bins(const Samples& samples, Rows& rows) {
  rows.bins.resize(samples.features.size());
  rows.edges.resize(samples.features.size());
  for (std::size_t f = 0; f < samples.features.size(); ++f) {
    std::vector<float> values;
    for (const TrialSamples& trial : samples.trials)
      for (std::size_t row = 0; row < trial.rows(); ++row)
        if (trial.is_judged(row * trial.stride)) values.push_back(trial.features[f][row]);
    const bool words = !samples.features[f].words.empty();
    if (!words) rows.edges[f] = round_edges(values);
    for (const float value : values) {
      const auto& edges = rows.edges[f];
      const auto bin = words ? std::ptrdiff_t(value)
                             : std::ranges::upper_bound(edges, double(value)) - edges.begin();
      rows.bins[f].push_back(std::uint8_t(bin));
    }
  }
}

void cap_errors(Rows& rows) {
  std::vector<double> errors = rows.error;
  const auto top = errors.begin() + std::ptrdiff_t(0.999 * double(errors.size() - 1));
  std::ranges::nth_element(errors, top);
  for (const double error : rows.error) rows.capped.push_back(std::min(error, *top));
}

/// A condition that another on the same feature makes superfluous is dropped.
void add_condition(std::vector<Condition>& to, const Condition& added) {
  std::erase_if(to, [&](const Condition& c) {
    return c.feature == added.feature && (c.op == added.op || added.op == Condition::Op::equals) &&
           added.op != Condition::Condition::Op::not_equals;
  });
  to.push_back(added);
}

Condition opposite(const Samples& samples, Condition split) {
  if (split.op != Condition::Op::equals) return split.op = Condition::Op::below, split;
  if (samples.features[split.feature].words.size() == 2) return split.word = 1 - split.word, split;
  return split.op = Condition::Op::not_equals, split;
}

/// "is not in" where but one other word is left says that word.
void simplify(const Samples& samples, const Rows& rows, const Node& leaf, Region& region) {
  for (Condition& c : region.conditions) {
    if (c.op != Condition::Op::not_equals) continue;
    std::vector<double> seen(samples.features[c.feature].words.size(), 0.0);
    for (const auto row : leaf.rows) seen[rows.bins[c.feature][row]] += rows.weight[row];
    const auto most = std::ranges::max_element(seen);
    if (*most >= 0.95 * std::accumulate(seen.begin(), seen.end(), 0.0))
      c.op = Condition::Op::equals, c.word = std::size_t(most - seen.begin());
  }
  const auto same = [](const Condition& a, const Condition& b) {
    return a.feature == b.feature && a.op == b.op && a.bound == b.bound && a.word == b.word;
  };
  for (std::size_t k = region.conditions.size(); k-- > 1;)
    for (std::size_t i = 0; i < k; ++i)
      if (same(region.conditions[i], region.conditions[k])) {
        region.conditions.erase(region.conditions.begin() + std::ptrdiff_t(k));
        break;
      }
  std::ranges::stable_sort(region.conditions, {}, [&](const Condition& c) {
    return std::tuple(samples.features[c.feature].words.empty(), c.feature, c.op);
  });
}

void add_leaves(const Samples& samples, const Rows& rows, const Node& node, const Node& root,
                const std::vector<Condition>& path, std::vector<Region>& out) {
  if (node.first) {
    std::vector<Condition> first = path, second = path;
    add_condition(first, node.split);
    add_condition(second, opposite(samples, node.split));
    add_leaves(samples, rows, *node.first, root, first, out);
    add_leaves(samples, rows, *node.second, root, second, out);
    return;
  }
  const Sums &here = node.filled, &all = root.filled;
  if (!(here.weight > 0.0)) return;
  Region region;
  region.conditions = path;
  simplify(samples, rows, node, region);
  region.share_of_error = all.error > 0.0 ? here.error / all.error : 0.0;
  region.share_of_time = here.weight / all.weight;
  region.rmse = std::sqrt(here.error / here.weight);
  for (const double sum : here.residual) region.mean.push_back(sum / here.weight);
  out.push_back(std::move(region));
}

std::string sentence(const Region& region, const Samples& samples, bool for_people) {
  std::vector<std::string> parts;
  for (const Condition& c : region.conditions) parts.push_back(text(c, samples, for_people));
  return parts.empty() ? "everywhere" : fmt::format("{}", fmt::join(parts, " and "));
}

struct Scale {
  const char* unit;
  double factor;
  const char* shown;
};
constexpr std::array kScales{Scale{"m", 1e3, "mm"}, Scale{"m/s", 1e3, "mm/s"},
                             Scale{"rad", 57.29577951308232, "°"},
                             Scale{"rad/s", 57.29577951308232, "°/s"}};

std::string written_number(double value, const std::string& unit, bool for_people) {
  std::string shown = unit;
  if (for_people)
    for (const Scale& scale : kScales)
      if (unit == scale.unit) value *= scale.factor, shown = scale.shown;
  return fmt::format("{:.4g}{}{}", value, shown.empty() || shown[0] == '\xc2' ? "" : " ", shown);
}

bool holds(const Condition& c, const TrialSamples& trial, std::size_t row) {
  const double value = double(trial.features[c.feature][row]);
  switch (c.op) {
    case Condition::Op::above:
      return value >= c.bound;
    case Condition::Op::below:
      return value < c.bound;
    case Condition::Op::equals:
      return value == double(c.word);
    case Condition::Op::not_equals:
      break;
  }
  return value != double(c.word);
}

}  // namespace

std::vector<std::int8_t> regions_by_sample(const Samples& samples, const TrialSamples& trial,
                                           const std::vector<Region>& regions) {
  std::vector<std::int8_t> out(trial.t_s.size(), -1);
  if (samples.features.empty()) return out;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const auto inside = [&](const Region& region) {
      return std::ranges::all_of(
          region.conditions, [&](const Condition& c) { return holds(c, trial, k / trial.stride); });
    };
    const auto it = std::ranges::find_if(regions, inside);
    if (it != regions.end()) out[k] = std::int8_t(it - regions.begin());
  }
  return out;
}

std::string text(const Condition& condition, const Samples& samples, bool for_people) {
  const Feature& feature = samples.features[condition.feature];
  switch (condition.op) {
    case Condition::Op::above:
    case Condition::Op::below:
      return fmt::format("{} {} {}", feature.name, condition.op == Condition::Op::above ? ">" : "<",
                         written_number(condition.bound, feature.unit, for_people));
    case Condition::Op::equals:
      return fmt::format("{} = {}", feature.name, feature.words[condition.word]);
    case Condition::Op::not_equals:
      return fmt::format("{} is not {}", feature.name, feature.words[condition.word]);
  }
  return {};
}

ErrorRegions find_error_regions(const Samples& samples, const ErrorRegionOptions& options) {
  const Halves halves(samples.trials.size());
  Rows rows;
  add_rows(samples, halves, rows);
  cap_errors(rows);
  add_bins(samples, rows);
  const auto root = grown_tree(samples, rows, options);
  ErrorRegions out;
  std::vector<Region> leaves;
  add_leaves(samples, rows, *root, *root, {}, leaves);
  const auto beyond = [](const Region& r) { return r.share_of_error - r.share_of_time; };
  std::ranges::stable_sort(leaves, std::greater<>(), beyond);
  for (Region& region : leaves) {
    double mean = 0.0;
    for (const double m : region.mean) mean += m * m;
    const bool one_sided = std::sqrt(mean) > 0.5 * region.rmse && region.share_of_error > 0.1;
    if (out.regions.size() < options.most_regions &&
        (leaves.size() == 1 || beyond(region) > 0.0 || one_sided)) {
      region.text = sentence(region, samples, false);
      region.words = sentence(region, samples, true);
      out.regions.push_back(std::move(region));
    }
  }
  const std::size_t n = samples.trials.size();
  out.honest = halves.by_trials
                   ? fmt::format("borders from {} trial{}, figures from the other {}", (n + 1) / 2,
                                 n > 2 ? "s" : "", n / 2)
                   : "one trial: borders from every second stretch of time, figures from the rest";
  return out;
}

}  // namespace lab
}  // namespace tractus
