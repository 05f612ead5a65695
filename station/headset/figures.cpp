#include "station/headset/figures.hpp"

#include <algorithm>
#include <cmath>

namespace tractus::headset {

double FrameTimes::quantile_ms(double share) const {
  if (work_s_.empty()) return 0.0;
  std::vector<float> sorted = work_s_;
  const auto n = static_cast<double>(sorted.size());
  const auto rank = static_cast<std::ptrdiff_t>(std::max(0.0, std::ceil(share * n) - 1.0));
  std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
  return 1e3 * double(sorted[static_cast<std::size_t>(rank)]);
}

void DueFrames::add(std::int64_t shown_at_ns, std::int64_t period_ns) {
  if (last_ns_ > 0 && period_ns > 0 && shown_at_ns > last_ns_) {
    const double periods = double(shown_at_ns - last_ns_) / double(period_ns);
    missed_ += static_cast<std::uint64_t>(std::max(0.0, std::round(periods) - 1.0));
  }
  last_ns_ = shown_at_ns;
}

core::Json Figures::to_json() const {
  return {{"runtime", runtime},
          {"device", device},
          {"simulated", simulated},
          {"aligned", aligned},
          {"frames", frames},
          {"dropped_frames", dropped},
          {"untracked_frames", untracked},
          {"rate_Hz", rate_Hz},
          {"frame_p50_ms", p50_ms},
          {"frame_p99_ms", p99_ms},
          {"gpu_p50_ms", gpu_p50_ms},
          {"gpu_p99_ms", gpu_p99_ms},
          {"ended", ended}};
}

}  // namespace tractus::headset
