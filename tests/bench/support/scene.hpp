/// Simulated scenes for the benchmarks: no patient, no recording.
#pragma once

#include "math/geometry.hpp"
#include "volume/volume.hpp"

namespace tractus::bench {

/// A block of simulated bone, 56 × 56 × 70 mm at 0.35 mm, with porous texture and a drilled tract
/// of 3 mm diameter and 40 mm length that is closed at its end.
volume::Volume tract_block();
/// The handle's pose at time t, s: strokes along the walls all round, pressed until the shank bends
/// by millimetres, taps at the end, a hand's tremor.
math::Pose palpating_hand(double t);

/// Counts of a soft noise, every value different from its neighbours'.
volume::Volume noise_block(int nx, int ny, int nz);

}  // namespace tractus::bench
