/// Trials of the simulated hand on a carved case, in simulated time.
#pragma once

#include "cases/making.hpp"
#include "station/devices/catalogue.hpp"

namespace tractus::bench {

/// The hand palpates for `duration_s` with the case's own model and says what it found.
devices::SimulatedAnswer palpated_by_hand(const cases::Carved& carved,
                                          const models::PalpationRuntime& runtime,
                                          double probe_length_m, std::uint64_t seed,
                                          double duration_s);

}  // namespace tractus::bench
