/// Where this checkout and what was built from it lie, for tests. Only `checkout.cpp`, which the build writes, holds the
/// paths: every other file compiles to the same object in every checkout, so a compiler cache serves them all.
#pragma once

namespace tractus::checkout {
extern const char* const kSource;   ///< the repository's root
extern const char* const kBin;      ///< folder of the programs
extern const char* const kStandIn;  ///< folder of the simulated vendor libraries
}  // namespace tractus::checkout
