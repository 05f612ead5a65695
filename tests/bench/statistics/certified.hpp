/// Correct digits on NIST's certified problems: ours, R's, and what the doubles allow.
#pragma once

#include "bench/statistics/r_peer.hpp"
#include "bench/support/report.hpp"

namespace tractus::bench {

/// Prints the table. On each problem ours must have R's digits, or those that exact arithmetic on
/// the same doubles has: beyond these more is luck.
void certified(Report& report, const Answers& r);

}  // namespace tractus::bench
