#include <cmath>

#include "lab/rigs/probing/recording.hpp"

namespace tractus {
namespace lab {
namespace {

/// Of so many samples that the filter passes over between outputs, how far apart those are that a fit needs.
std::size_t step_of(const ProbingRecording& r) {
  const double rate_Hz = double(r.size() - 1) / r.seconds();
  std::size_t step = 1;
  for (std::size_t by = 2; rate_Hz / double(by) >= kProbingRecording.least_fit_rate_Hz; ++by)
    if (r.decimator.stride() % by == 0) step = by;
  return step;
}

template <class Value>
std::vector<Value> every(const std::vector<Value>& all, std::size_t first, std::size_t step) {
  std::vector<Value> out;
  for (std::size_t k = first; k < all.size(); k += step) out.push_back(all[k]);
  return out;
}

}  // namespace

FitSamples fit_samples(const ProbingRecording& r) {
  FitSamples out{r, r.decimator};
  const std::size_t step = step_of(r), first = r.decimator.half() % step;
  if (step == 1) return out;
  out.decimator = r.decimator.of_every(step);
  for (auto* all : {&out.motion.t_s, &out.motion.x_m, &out.motion.v_m_s, &out.motion.a_m_s2,
                    &out.motion.theta_rad, &out.motion.omega_rad_s, &out.motion.tz_Nm})
    *all = every(*all, first, step);
  const effects::ProbingMotion at_rest = std::move(out.at_rest);
  out.at_rest = {.rest_m_s = at_rest.rest_m_s, .rest_rad_s = at_rest.rest_rad_s};
  out.rest.clear();
  for (std::size_t i = 0; i < r.rest.size(); ++i) {
    if (r.rest[i] < first || (r.rest[i] - first) % step != 0) continue;
    out.rest.push_back((r.rest[i] - first) / step);
    for (const auto column : {&effects::ProbingMotion::t_s, &effects::ProbingMotion::x_m,
                              &effects::ProbingMotion::v_m_s, &effects::ProbingMotion::a_m_s2,
                              &effects::ProbingMotion::theta_rad,
                              &effects::ProbingMotion::omega_rad_s, &effects::ProbingMotion::tz_Nm})
      if (!(at_rest.*column).empty()) (out.at_rest.*column).push_back((at_rest.*column)[i]);
  }
  return out;
}

}  // namespace lab
}  // namespace tractus
