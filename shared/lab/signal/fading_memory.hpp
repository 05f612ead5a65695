/// What a motion leaves behind for a while.
#pragma once

#include <span>
#include <vector>

namespace tractus::lab {

/// The way that a first-order lag still remembers, m (or rad): y' = v − y/τ from 0, v held over each step, exact.
/// @param v_m_s  one per moment. @param time_s  τ.
std::vector<double> fading_memory(std::span<const double> t_s, std::span<const double> v_m_s,
                                  double time_s);

}  // namespace tractus::lab
