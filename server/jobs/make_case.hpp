/// A released volume, an entry and a target become a case.
#pragma once

#include <functional>

#include "cases/carving.hpp"
#include "core/json.hpp"
#include "core/signing.hpp"
#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"

namespace tractus::jobs {

/// {"entry_m", "target_m", "radius_m"?, "breach"?: {"wall", "depth_m"?, "at_m"?} | null,
/// "envelope_marks"?: [{"at_m", "radius_m", "bone"}]}, all in V.
/// Errors: bad_input, out_of_range, led by the field.
core::Result<cases::CarvingPlan> plan_from(core::Fields& fields);
core::Json plan_json(const cases::CarvingPlan& plan);

/// Does what a row of case_makings asks: carves as `tractus carve` does, signs by `key`, publishes;
/// how far it is is noted. Nothing is done for one that is done. Errors: not_found, those of
/// cases::carve and of reading; cancelled when the server ends.
core::Result<void> make_case(store::Store& store, const store::Objects& objects,
                             const core::KeyPair& key, const std::string& making_id,
                             const std::function<bool()>& ending);

}  // namespace tractus::jobs
