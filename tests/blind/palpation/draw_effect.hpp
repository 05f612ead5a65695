#pragma once
#include "palpation/draw.hpp"

namespace blind {

/// An effect with its shape drawn and a first guess of its size.
Hidden draw_hidden(Random& random, const std::string& id, const Probe& probe, const Tract& tract);

}  // namespace blind
