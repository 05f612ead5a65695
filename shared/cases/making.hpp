/// A case made to be felt: the breach where an ideal observer tells it best, and the certificate.
#pragma once

#include "cases/carving.hpp"
#include "cases/certificate.hpp"

namespace tractus::cases {

struct Made : Carved {
  std::optional<Certificate> certificate;   ///< none of a planned channel: there is nothing to feel
  math::Vec2 moved_m = math::Vec2::Zero();  ///< from the plan, towards medial and superior
};

/// Carves, and lets the observer try a breach of each wall in this bone with this model.
///
/// In filled bone each side wall is tried every millimetre of the tract's ring, where all four
/// outer faces lie within 14 mm of the axis; a breach without a stated place goes to the best. In
/// published bone it goes where volume::place_breach puts it. The best place has the greatest of
/// min(K, B, B − FA + 2), so that 2.5 is what a certificate asks for, among those of which a hand is
/// foretold to be right as often as it asks.
/// @param perception  of whom the case is for
/// Errors: those of `carve` and of models::PalpationRuntime::make.
core::Result<Made> make(const volume::Volume& ct, const models::PalpationModel& model,
                        const CarvingPlan& plan, const core::Progress& progress = {},
                        const Perception& perception = {});

/// Five cases of one tract, a breach of each wall, all as hard to tell as can be: the breach of the
/// hardest wall lies where it is told best, each other one where it passes and is told as well as
/// that one. All carry the same certificate. The end has one place, and only its own d′.
/// @param plan  its breach and `even` are not looked at
/// Errors: those of `make`; out_of_range where a wall's breach cannot be told; bad_input for a
/// planned channel.
core::Result<std::vector<Made>> make_five(const volume::Volume& ct,
                                          const models::PalpationModel& model, CarvingPlan plan,
                                          const core::Progress& progress = {},
                                          const Perception& perception = {});

/// How much is tried: one place of each wall, in the middle of the ring, or every place.
enum class Effort { first, whole };
constexpr auto words(Effort) {
  return std::to_array<core::Word<Effort>>({{Effort::first, "first"}, {Effort::whole, "whole"}});
}

/// The certificate that a case of this plan would have. Errors: those of `make`; bad_input for a
/// planned channel.
core::Result<Certificate> certify(const volume::Volume& ct, const models::PalpationModel& model,
                                  const CarvingPlan& plan, Effort effort,
                                  const core::Progress& progress = {});

/// What can be told of a case that was made without a certificate, from its drilled volume alone:
/// its whole twin is not known, so there is B against the tract's other places, and no K. Errors:
/// those of models::PalpationRuntime::make; bad_input for a planned channel; out_of_range for an
/// anterior breach, which has no other places, and for a case without a breach.
core::Result<Certificate> certify_drilled(const volume::Volume& drilled, const Case& made,
                                          const Truth& truth, const Perception& perception = {});

}  // namespace tractus::cases
