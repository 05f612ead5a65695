#include "assessment/certification.hpp"

#include <algorithm>
#include <map>

namespace tractus {
namespace assessment {
namespace {

constexpr int kMostTrials = 400;
constexpr int kFirstStep = 5, kLastStep = 120;  // of h, by 0.05

double threshold_of(int step) { return 0.05 * step; }

}  // namespace

Certification certification(const statistics::Rates& rates, double risk, double power) {
  Certification out{rates, risk, power, 0, 0.0, {}, {}};
  // A higher h takes longer to pass and lets fewer pass wrongly: the lowest h that keeps the risk
  // is the shortest rule.
  int low = kFirstStep, high = kLastStep + 1;
  while (low < high) {
    const int step = (low + high) / 2;
    const double h = threshold_of(step);
    const auto good = statistics::lc_cusum_characteristic(rates, h, rates.adequate, kMostTrials);
    const auto enough = std::ranges::lower_bound(good.signalled_by, power);
    if (enough == good.signalled_by.end()) {
      high = step;
      continue;
    }
    const int trials = static_cast<int>(enough - good.signalled_by.begin()) + 1;
    const auto bad = statistics::lc_cusum_characteristic(rates, h, rates.inadequate, trials);
    if (bad.signalled_by.back() <= risk) {
      out.trials = trials;
      out.threshold = h;
      high = step;
    } else {
      low = step + 1;
    }
  }
  if (out.trials == 0) return out;
  out.passes_if_adequate =
      statistics::lc_cusum_characteristic(rates, out.threshold, rates.adequate, kMostTrials)
          .signalled_by;
  out.passes_if_inadequate =
      statistics::lc_cusum_characteristic(rates, out.threshold, rates.inadequate, kMostTrials)
          .signalled_by;
  return out;
}

const Certification& usual_certification(const statistics::Rates& rates) {
  constexpr std::size_t kMostKept = 64;  // a programme has a handful
  thread_local std::map<std::pair<double, double>, Certification> kept;
  const std::pair key{rates.adequate, rates.inadequate};
  if (kept.size() >= kMostKept && !kept.contains(key)) kept.clear();
  const auto found = kept.find(key);
  if (found != kept.end()) return found->second;
  return kept.emplace(key, certification(rates)).first->second;
}

}  // namespace assessment
}  // namespace tractus
