/// Bytes made wrong, the same way for the same random numbers.
#pragma once

#include <random>

#include "core/bytes.hpp"

namespace tractus::fuzz {

/// Are texts put in that parsers stumble over? They break every frame of a binary file.
enum class Texts { too, none };

/// One to four times: a byte changed, a stretch removed, doubled or zeroed, a 32-bit number made
/// extreme, a text put in.
core::Bytes mutated(core::Bytes bytes, std::mt19937& random, Texts texts);

}  // namespace tractus::fuzz
