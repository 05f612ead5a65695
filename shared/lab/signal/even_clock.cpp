#include "lab/signal/even_clock.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace tractus {
namespace lab {
namespace {

/// The largest power of ten, from 1 ms down to 0.1 us, of which all stamps are multiples; 0 if there is none.
double rounding_step_s(std::span<const double> t_s) {
  for (const double step_s : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7})
    if (std::ranges::all_of(
            t_s, [&](double t) { return std::abs(t / step_s - std::round(t / step_s)) < 1e-3; }))
      return step_s;
  return 0.0;
}

/// Mean of the intervals, but for those that hold a gap.
double usual_spacing_s(std::span<const double> t_s) {
  std::vector<double> between;
  for (std::size_t k = 1; k < t_s.size(); ++k) between.push_back(t_s[k] - t_s[k - 1]);
  std::vector<double> sorted = between;
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  double sum = 0.0, count = 0.0;
  for (const double dt_s : between)
    if (dt_s < 1.6 * *middle) sum += dt_s, count += 1.0;
  return sum / count;
}

/// A rounded stamp lies within half a step of its clock, and the clock's spacing is estimated.
constexpr double kFarthest = 0.55;

struct Clock {
  double start_s, spacing_s;
};

/// Its spacing by least squares over the number of each sample; its start so that the stamps lie as far before it as
/// after it. Their mean will not do: stamps half-way between two multiples may all be rounded to one side.
Clock fitted(std::span<const double> t_s, std::span<const double> number) {
  const double n = double(t_s.size());
  double mean_t = 0.0, mean_k = 0.0, products = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) mean_t += t_s[i] / n, mean_k += number[i] / n;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    products += (number[i] - mean_k) * (t_s[i] - mean_t);
    squares += (number[i] - mean_k) * (number[i] - mean_k);
  }
  const double spacing_s = products / squares;
  double first = 1e300, last = -1e300;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    const double start_s = t_s[i] - spacing_s * number[i];
    first = std::min(first, start_s), last = std::max(last, start_s);
  }
  return {0.5 * (first + last), spacing_s};
}

}  // namespace

void restore_even_clock(std::vector<double>& t_s) {
  if (t_s.size() < 16) return;
  const double step_s = rounding_step_s(t_s);
  if (!(step_s > 0.0)) return;
  Clock clock{t_s.front(), usual_spacing_s(t_s)};
  if (clock.spacing_s < 2.0 * step_s) return;
  std::vector<double> number(t_s.size(), 0.0);
  for (std::size_t k = 1; k < t_s.size(); ++k)
    number[k] = number[k - 1] + std::max(1.0, std::round((t_s[k] - t_s[k - 1]) / clock.spacing_s));
  clock = fitted(t_s, number);
  for (std::size_t k = 0; k < t_s.size(); ++k)
    if (std::abs(clock.start_s + number[k] * clock.spacing_s - t_s[k]) > kFarthest * step_s) return;
  for (std::size_t k = 0; k < t_s.size(); ++k) t_s[k] = clock.start_s + number[k] * clock.spacing_s;
}

}  // namespace lab
}  // namespace tractus
