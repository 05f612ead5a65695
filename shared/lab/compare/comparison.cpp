#include "lab/compare/comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "core/require.hpp"
#include "lab/settings.hpp"
#include "lab/signal/spectrum.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const auto& kDistribution = kSettings.comparison;

using Series = std::function<double(const TrialSamples&, std::size_t sample)>;

/// Mean and variance in one pass [Welford1962].
struct Moments {
  double count = 0.0, mean = 0.0, squares = 0.0;
  void take(double value) {
    count += 1.0;
    const double before = value - mean;
    mean += before / count;
    squares += before * (value - mean);
  }
  double variance() const { return count > 0.0 ? squares / count : 0.0; }
};

std::size_t total(const Samples& samples) {
  std::size_t out = 0;
  for (const TrialSamples& trial : samples.trials) out += trial.t_s.size();
  return out;
}

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * double(sorted.size() - 1);
  const std::size_t below = std::size_t(at), above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - double(below)) * (sorted[above] - sorted[below]);
}

Histogram histogram(const std::vector<double>& sorted, double low, double high) {
  Histogram out;
  if (!(high > low)) high = low + std::max(1e-12, 1e-9 * std::abs(low));
  for (std::size_t k = 0; k <= kDistribution.bins; ++k)
    out.edges.push_back(low + (high - low) * double(k) / double(kDistribution.bins));
  out.shares.assign(kDistribution.bins, 0.0);
  for (const double value : sorted) {
    const double bin = std::clamp((value - low) / (high - low) * double(kDistribution.bins), 0.0,
                                  kDistribution.bins - 1.0);
    out.shares[std::size_t(bin)] += 1.0 / double(sorted.size());
  }
  return out;
}

/// Mean and spread of all judged samples; quantiles and histogram of evenly chosen ones on long sets.
struct Described {
  Moments moments;
  std::vector<double> sorted;
};

Described described(const Samples& samples, const Series& series) {
  Described out;
  const std::size_t every = 1 + total(samples) / kDistribution.most_for_quantiles;
  std::size_t n = 0;
  for (const TrialSamples& trial : samples.trials)
    for (std::size_t k = 0; k < trial.t_s.size(); ++k) {
      if (!trial.is_judged(k)) continue;
      const double value = series(trial, k);
      out.moments.take(value);
      if (n++ % every == 0) out.sorted.push_back(value);
    }
  std::ranges::sort(out.sorted);
  return out;
}

Distribution distribution(const Described& from, double low, double high) {
  return {.mean = from.moments.mean,
          .sd = std::sqrt(from.moments.variance()),
          .p05 = quantile(from.sorted, 0.05),
          .p50 = quantile(from.sorted, 0.5),
          .p95 = quantile(from.sorted, 0.95),
          .histogram = histogram(from.sorted, low, high)};
}

Bands bands(const Samples& samples, const Series& series) {
  std::size_t longest = 0;
  double seconds = 0.0, steps = 0.0;
  for (const TrialSamples& trial : samples.trials) {
    longest = std::max(longest, trial.t_s.size());
    seconds += trial.t_s.back() - trial.t_s.front();
    steps += double(trial.t_s.size() - 1);
  }
  Welch welch(steps / seconds, longest);
  std::vector<double> values;
  for (const TrialSamples& trial : samples.trials) {
    values.resize(trial.t_s.size());
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = series(trial, k);
    welch.add(values);
  }
  return welch.bands();
}

/// What is left holds the noise: less than it was thought to be shows that it is less.
double floor_within(double floor, double rmse) { return std::min(floor, rmse); }

/// None where all of the signal is thought to be noise.
double explained(double variance, double rmse, double floor) {
  if (!(variance - floor * floor > 1e-9 * variance)) return kNone;
  const double least = floor_within(floor, rmse);
  return (variance - rmse * rmse) / (variance - least * least);
}

ChannelComparison channel(const Samples& samples, std::size_t c) {
  const Series measured = [c](const TrialSamples& t, std::size_t k) { return t.measured[c][k]; };
  const Series simulated = [c](const TrialSamples& t, std::size_t k) { return t.simulated[c][k]; };
  const Series residual = [c](const TrialSamples& t, std::size_t k) {
    return t.is_judged(k) ? t.residual(c, k) : 0.0;  // a gap in the spectrum's series
  };
  const Described m = described(samples, measured), s = described(samples, simulated),
                  r = described(samples, residual);
  ChannelComparison out;
  out.name = samples.channels[c].name;
  const double variance = m.moments.variance(),
               square = r.moments.variance() + r.moments.mean * r.moments.mean;
  out.rmse = std::sqrt(square);
  const double floor = samples.channels[c].noise_floor;
  out.noise_floor = floor_within(floor, out.rmse);
  out.r2 = variance > 0.0 ? 1.0 - square / variance : kNone;
  out.explained = explained(variance, out.rmse, floor);
  out.bias = r.moments.mean;
  const double low = std::min(m.sorted.front(), s.sorted.front()),
               high = std::max(m.sorted.back(), s.sorted.back());
  out.measured = distribution(m, low, high);
  out.simulated = distribution(s, low, high);
  const double reach = std::max(quantile(r.sorted, 0.999), -quantile(r.sorted, 0.001));
  out.residual = distribution(r, -reach, reach);
  const Bands by_measured = bands(samples, measured);
  out.spectrum = {by_measured.frequency_Hz, by_measured.density, bands(samples, simulated).density,
                  bands(samples, residual).density};
  return out;
}

TrialComparison trial_comparison(const Samples& samples, const TrialSamples& trial) {
  TrialComparison out{trial.id, 0.0, {}, trial.t_s.back() - trial.t_s.front()};
  double n = 0.0;
  for (std::size_t k = 0; k < trial.t_s.size(); ++k) n += trial.is_judged(k);
  for (std::size_t c = 0; c < samples.channels.size(); ++c) {
    double squares = 0.0;
    for (std::size_t k = 0; k < trial.t_s.size(); ++k)
      if (trial.is_judged(k)) squares += trial.residual(c, k) * trial.residual(c, k);
    out.channels.push_back(n > 0.0 ? std::sqrt(squares / n) : kNone);
  }
  double squares = 0.0;
  for (const std::size_t c : samples.judged) squares += out.channels[c] * out.channels[c];
  out.rmse = std::sqrt(squares);
  return out;
}

std::vector<PhaseComparison> phases(const Samples& samples) {
  const std::size_t phase = samples.feature("phase");
  if (phase == samples.features.size()) return {};
  const auto& words = samples.features[phase].words;
  std::vector<double> squares(words.size(), 0.0), judged(words.size(), 0.0),
      rows(words.size(), 0.0);
  double all_squares = 0.0, all_rows = 0.0;
  for (const TrialSamples& trial : samples.trials)
    for (std::size_t row = 0; row < trial.rows(); ++row) {
      const auto word = std::size_t(trial.features[phase][row]);
      rows[word] += 1.0, all_rows += 1.0;
      if (!trial.is_judged(row * trial.stride)) continue;
      const double square = samples.squared(trial, row * trial.stride);
      squares[word] += square, judged[word] += 1.0, all_squares += square;
    }
  std::vector<PhaseComparison> out;
  for (std::size_t w = 0; w < words.size(); ++w)
    if (rows[w] > 0.0)
      out.push_back({words[w], judged[w] > 0.0 ? std::sqrt(squares[w] / judged[w]) : kNone,
                     all_squares > 0.0 ? squares[w] / all_squares : 0.0, rows[w] / all_rows,
                     judged[w] / rows[w]});
  return out;
}

/// The share of the samples that each judgement has, most first; judgements that no sample has are not named.
std::vector<JudgementShare> judgement_shares(const Samples& samples) {
  std::map<Judgement, double> counts;
  double all = 0.0;
  for (const TrialSamples& trial : samples.trials)
    for (std::size_t k = 0; k < trial.t_s.size(); ++k, all += 1.0)
      counts[trial.judgement.empty() ? Judgement::judged : trial.judgement[k]] += 1.0;
  std::vector<JudgementShare> out;
  for (const auto& [judgement, count] : counts) out.push_back({judgement, count / all});
  std::ranges::stable_sort(out, std::greater<>(), &JudgementShare::share);
  return out;
}

}  // namespace

Comparison compare(const Samples& samples) {
  core::require(!samples.trials.empty() && !samples.judged.empty(),
                "a comparison has a trial and a judged channel");
  Comparison out;
  out.judged_name = samples.judged_name;
  out.judged_unit = samples.judged_unit;
  for (std::size_t c = 0; c < samples.channels.size(); ++c)
    out.channels.push_back(channel(samples, c));
  double squares = 0.0, variance = 0.0;
  for (const std::size_t c : samples.judged) {
    squares += out.channels[c].rmse * out.channels[c].rmse;
    variance += out.channels[c].measured.sd * out.channels[c].measured.sd;
  }
  out.rmse = std::sqrt(squares);
  out.noise_floor = floor_within(samples.judged_floor(), out.rmse);
  out.explained = explained(variance, out.rmse, samples.judged_floor());
  out.r2 = variance > 0.0 ? 1.0 - squares / variance : kNone;
  for (const TrialSamples& trial : samples.trials)
    out.trials.push_back(trial_comparison(samples, trial));
  out.phases = phases(samples);
  out.judgements = judgement_shares(samples);
  out.error_regions = find_error_regions(samples);
  return out;
}

std::string judged_text(const Comparison& comparison) {
  double judged = 0.0;
  std::vector<std::string> others;
  for (const auto& [judgement, share] : comparison.judgements)
    if (judgement == Judgement::judged)
      judged = share;
    else
      others.push_back(fmt::format("{:.2g} % {}", 100.0 * share, name(judgement)));
  if (others.empty()) return "";
  return fmt::format("{:.3g} % of the samples are judged; left out: {}.", 100.0 * judged,
                     fmt::join(others, ", "));
}

}  // namespace lab
}  // namespace tractus
