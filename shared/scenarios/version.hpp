/// A new version of a scenario: numbers nudged, with who, when and from which version.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "scenarios/scenario.hpp"

namespace tractus::scenarios {

/// One field and its new value.
struct Change {
  std::string field;  ///< path in the file without the leading stroke: "bone/stiffness_N_per_m"
  core::Json value;
};

/// "bone/stiffness_N_per_m=9000", "walls_m=[0.02]", "name=\"mine\"". Errors: bad_input.
core::Result<Change> parse_change(const std::string& text);

/// `parent` with its changes, a new origin that names it. Errors: bad_input for a field that the
/// file does not have or that only this function writes, and all that `Scenario::check` refuses.
core::Result<Scenario> next_version(const Scenario& parent, std::span<const Change> changes,
                                    const std::string& who, std::int64_t when_utc_us);

}  // namespace tractus::scenarios
