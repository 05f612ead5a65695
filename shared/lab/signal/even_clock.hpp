/// Time stamps that a file has rounded, put back on the even clock that they came from.
#pragma once

#include <vector>

namespace tractus::lab {

/// Stamps that are multiples of a step, as 0.1 ms or 1 us, and lie within half of it of an even clock, gaps included:
/// replaced by that clock. The motion of a fast probe would else carry the rounding, speed times half a step. All other
/// stamps stay as they are.
void restore_even_clock(std::vector<double>& t_s);

}  // namespace tractus::lab
