#include "lab/signal/fading_memory.hpp"

#include <cmath>

namespace tractus {
namespace lab {

std::vector<double> fading_memory(std::span<const double> t_s, std::span<const double> v_m_s,
                                  double time_s) {
  std::vector<double> out(t_s.size(), 0.0);
  for (std::size_t k = 1; k < t_s.size(); ++k) {
    const double kept = std::exp(-(t_s[k] - t_s[k - 1]) / time_s);
    out[k] = out[k - 1] * kept + v_m_s[k] * time_s * (1.0 - kept);
  }
  return out;
}

}  // namespace lab
}  // namespace tractus
