/// A case made to be felt: the breach where an ideal observer tells it best, and the certificate.
#pragma once

#include "cases/carving.hpp"
#include "cases/certificate.hpp"

namespace tractus::cases {

struct Made : Carved {
  std::optional<Certificate> certificate;  ///< none of a planned channel: there is nothing to feel
};

/// Carves, and lets the observer try a breach of each wall in this bone with this model.
///
/// In filled bone each side wall is tried every millimetre of the tract's ring, where all four
/// outer faces lie within 12 mm of the axis; a breach without a stated place goes to the best. In
/// published bone it goes where volume::place_breach puts it. The best place has the greatest of
/// min(K, B, B − FA + 2), so that 2.5 is what a certificate asks for.
/// Errors: those of `carve` and of models::PalpationRuntime::make.
core::Result<Made> make(const volume::Volume& ct, const models::PalpationModel& model,
                        const CarvingPlan& plan, const core::Progress& progress = {});

/// A breach in a volume that is drilled already: its whole twin is not known, so there is B against
/// the tract's other places, and no K. Errors: those of models::PalpationRuntime::make; bad_input
/// for the anterior wall, which has no other places.
core::Result<WallCertificate> certify_drilled(const volume::Volume& drilled,
                                              const models::PalpationModel& model,
                                              const volume::Tract& tract, volume::Wall wall,
                                              double at_m);

}  // namespace tractus::cases
