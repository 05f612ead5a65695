/// A recorded palpation replayed through a model: what the model would have done to the hand.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "models/palpation_stream.hpp"
#include "trial/measurement_set.hpp"

namespace tractus::replay {

/// A model's answer to one recording, at the recording's times.
struct Replayed {
  std::vector<math::Wrench>
      wrench_H;  ///< simulated: what the bone does to the probe, at the origin of H, in H
  std::vector<math::Vec2> deflection_m;  ///< δ of the tip, in H
  std::vector<std::uint8_t> converged;   ///< 1 where the equilibrium was reached
  std::uint64_t steps =
      0;  ///< at the published rate, the ones between the recording's times among them
  std::uint64_t not_converged = 0;  ///< of those
  std::uint64_t samples_in_volume =
      0;  ///< recorded times at which the bent tip lay within the volume's box
};

/// Replays one recording: a models::PalpationWalk along the spline through its poses. Between two
/// recorded times are equal steps of at most 1 / models::kPalpationRate_Hz, so that every recorded
/// time is a step of its own and gives its recorded pose; a recording at that rate or faster is taken
/// step for step.
///
/// Assumes that the hand moved as recorded whatever the model answers [Zoller2020, "Discussion"].
/// The model's effects act, measurement effects too: the answer is what a sensor would have said.
/// Velocities and accelerations are the spline's; a delay takes the motion that much earlier.
/// @param down  unit vector along gravity, in V (trial::stated_down)
/// Errors: bad_input for a gap of more than a second (the motion in it is not known) or more than
/// 10⁹ steps, naming the file; cancelled.
core::Result<Replayed> replay(const models::PalpationRuntime& runtime,
                              const trial::PalpationMeasurement& recording,
                              const math::Vec3& down = -math::Vec3::UnitZ(),
                              const core::Progress& progress = {});

/// The motion that the forces follow from, a row per sample, its columns named as the inputs of an FMU
/// (shared/fmu/palpation.cpp). Numbers are read back to the same bits.
std::string motion_csv(const models::PalpationMotion& motion);

}  // namespace tractus::replay
