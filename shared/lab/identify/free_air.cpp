#include "lab/identify/free_air.hpp"

#include "lab/identify/parallel.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

/// Sums over one trial of what an effect changes: everywhere, in air, and of that what the residual without it has.
struct ChangeSums {
  double all = 0.0, air = 0.0, shown = 0.0;
};

ChangeSums sums_of(const ResidualModel& model, const Solution& with, const Solution& without,
                   int trial) {
  ChangeSums out;
  const std::vector<bool> in_air = model.in_free_air(trial);
  if (in_air.empty()) return out;
  const Residuals a = model.full_rate(with.structure, with.values, trial),
                  b = model.full_rate(without.structure, without.values, trial);
  for (std::size_t c = 1; c < 4; ++c)  // the force's three components
    for (std::size_t k = 0; k < in_air.size(); ++k) {
      const double change = b.channels[c][k] - a.channels[c][k];
      out.all += change * change;
      if (!in_air[k]) continue;
      out.air += change * change;
      out.shown += change * b.channels[c][k];
    }
  return out;
}

}  // namespace

std::optional<double> share_in_free_air(const Residual& residual, const Solution& with,
                                        const Solution& without, double least_share) {
  std::vector<ChangeSums> trials(std::size_t(residual.trials()));
  parallel(residual.trials(), residual.threads(),
           [&](int k) { trials[std::size_t(k)] = sums_of(residual.problem(), with, without, k); });
  ChangeSums sum;
  for (const ChangeSums& one : trials)
    sum.all += one.all, sum.air += one.air, sum.shown += one.shown;
  if (!(sum.air > least_share * sum.all)) return std::nullopt;
  return sum.shown / sum.air;
}

}  // namespace lab
}  // namespace tractus
