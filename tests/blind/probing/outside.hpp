#pragma once
/// Effects that the catalogue does not have, for the test that the lab says so.
#include "probing/law.hpp"

namespace blind {

/// Null when the id names an effect of the measurement.
std::unique_ptr<Term> make_outside_term(const HiddenEffect& effect, std::uint64_t set_seed);

}  // namespace blind
