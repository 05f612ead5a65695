#include "effects/delayed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tractus {
namespace effects {
namespace {

/// Central differences; at the ends those to the one neighbour.
std::vector<double> slopes(std::span<const double> t, const std::vector<double>& f) {
  const std::size_t n = f.size();
  std::vector<double> out(n);
  const auto slope = [&](std::size_t before, std::size_t after) {
    const double width = t[after] - t[before];
    return width > 0.0 ? (f[after] - f[before]) / width : 0.0;
  };
  out[0] = slope(0, std::min<std::size_t>(1, n - 1));
  for (std::size_t k = 1; k + 1 < n; ++k) out[k] = slope(k - 1, k + 1);
  out[n - 1] = slope(n - std::min<std::size_t>(2, n), n - 1);
  return out;
}

/// Between samples `i` and `i + 1`, at a time there.
double between(std::span<const double> t, const std::vector<double>& f,
               const std::vector<double>& slope, std::size_t i, double at) {
  const double span = t[i + 1] - t[i];
  if (!(span > 0.0)) return f[i];
  const double u = (at - t[i]) / span, rise = f[i + 1] - f[i];
  const double from = span * slope[i] - rise, to = rise - span * slope[i + 1];
  return f[i] + u * (rise + (1.0 - u) * ((1.0 - u) * from + u * to));
}

/// Time between samples if they are evenly spaced but for rounding, else 0.
double even_spacing_s(std::span<const double> t_s) {
  const double spacing_s = (t_s.back() - t_s.front()) / std::max(1.0, double(t_s.size()) - 1.0);
  double most_s = 0.0;
  for (std::size_t k = 0; k < t_s.size(); ++k)
    most_s = std::max(most_s, std::abs(t_s[k] - t_s.front() - double(k) * spacing_s));
  return most_s < 1e-6 * spacing_s ? spacing_s : 0.0;
}

/// Samples of a delayed channel, [begin, end).
struct Inner {
  std::size_t begin = 0, end = 0;
};

/// What `between` gives for samples that are evenly spaced: a sum of four neighbours with the same weights everywhere.
/// Returns the part for which all four are there.
Inner delay_evenly(double late_samples, const std::vector<double>& was, std::span<double> values) {
  const auto n = std::ptrdiff_t(values.size());
  if (!(std::abs(late_samples) < double(n))) return {};
  const auto moved = std::ptrdiff_t(std::floor(-late_samples));
  const double u = -late_samples - double(moved), v = 1.0 - u;
  const std::array weight{-0.5 * u * v * v, 0.5 * v * (2.0 + 2.0 * u - 3.0 * u * u),
                          0.5 * u * (1.0 + 4.0 * u - 3.0 * u * u), -0.5 * u * u * v};
  const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, 1 - moved),
                       end = std::min(n, n - 2 - moved);
  if (begin >= end) return {};
  const double* from = was.data() + moved - 1;
  for (std::ptrdiff_t k = begin; k < end; ++k)
    values[std::size_t(k)] = weight[0] * from[k] + weight[1] * from[k + 1] +
                             weight[2] * from[k + 2] + weight[3] * from[k + 3];
  return {std::size_t(begin), std::size_t(end)};
}

}  // namespace

void delay(std::span<const double> t_s, double delay_s, std::span<double> values) {
  if (delay_s == 0.0 || values.empty()) return;
  const std::vector<double> was(values.begin(), values.end());
  const double spacing_s = even_spacing_s(t_s);
  const Inner done = spacing_s > 0.0 ? delay_evenly(delay_s / spacing_s, was, values) : Inner{};
  const std::vector<double> slope = slopes(t_s, was);
  std::size_t i = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k == done.begin && done.end > k) k = done.end;
    if (k == values.size()) break;
    const double at_s = t_s[k] - delay_s;
    while (i + 2 < values.size() && t_s[i + 1] <= at_s) ++i;
    values[k] = at_s <= t_s.front()  ? was.front()
                : at_s >= t_s.back() ? was.back()
                                     : between(t_s, was, slope, i, at_s);
  }
}

}  // namespace effects
}  // namespace tractus
