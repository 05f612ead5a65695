#include "effects/delayed.hpp"

#include <algorithm>
#include <vector>

namespace tractus {
namespace effects {
namespace {

/// Between samples `i` and `i + 1`, at a time there.
double between(std::span<const double> t, const std::vector<double>& f, std::size_t i, double at) {
  const double span = t[i + 1] - t[i];
  if (!(span > 0.0)) return f[i];
  const auto slope = [&](std::size_t k) {
    const std::size_t before = k == 0 ? 0 : k - 1, after = std::min(k + 1, f.size() - 1);
    const double width = t[after] - t[before];
    return width > 0.0 ? span * (f[after] - f[before]) / width : 0.0;
  };
  const double u = (at - t[i]) / span, rise = f[i + 1] - f[i];
  const double from = slope(i) - rise, to = rise - slope(i + 1);
  return f[i] + u * (rise + (1.0 - u) * ((1.0 - u) * from + u * to));
}

}  // namespace

void delay(std::span<const double> t_s, double delay_s, std::span<double> values) {
  if (delay_s == 0.0 || values.empty()) return;
  const std::vector<double> was(values.begin(), values.end());
  std::size_t i = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double at_s = t_s[k] - delay_s;
    while (i + 2 < values.size() && t_s[i + 1] <= at_s) ++i;
    values[k] = at_s <= t_s.front()  ? was.front()
                : at_s >= t_s.back() ? was.back()
                                     : between(t_s, was, i, at_s);
  }
}

}  // namespace effects
}  // namespace tractus
