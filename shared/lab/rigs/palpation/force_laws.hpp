/// The laws by which a force that is missing from a palpation's model may follow from the motion and the contact force.
#pragma once

#include <span>

#include "effects/palpation_effect.hpp"
#include "lab/identify/recorded_trials.hpp"
#include "lab/rigs/palpation/recording.hpp"
#include "models/palpation_runtime.hpp"

namespace tractus::lab {

/// What a probe feels in a trial by a model, per sample: the bent shank's tip, the straight one's velocity, and the contact
/// force; in the room's frame (V) or in the handle's (H).
struct Felt {
  std::vector<math::Vec3> tip_m, velocity_m_s, force_V_N, force_H_N;
};
Felt felt_by(const models::PalpationRuntime& model, const PalpationRecording& trial);

/// One trial as a model near the truth has it; spans of one length, one entry per sample.
struct Contact {
  std::span<const double> t_s;
  std::span<const effects::HandleMotion> handle;
  std::span<const math::Vec3> force_V_N;  ///< on the probe, in the room's frame
  std::span<const math::Vec3>
      tip_v_m_s;                    ///< velocity of the straight shank's tip, in the room's frame
  std::span<const double> depth_m;  ///< along the tract; empty: not known
};

/// Laws in the handle's frame, without the errors' standard deviations.
std::vector<ForceLaws::Law> force_laws_of(const Contact& contact);

}  // namespace tractus::lab
