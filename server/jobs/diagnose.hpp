/// Runs the model lab on what was uploaded.
#pragma once

#include <functional>

#include "db/store/objects.hpp"
#include "db/store/store.hpp"

namespace jobs {

/// Diagnoses a model by a measurement set: result and report become objects, the better model a
/// version whose parent is the given one, all in one transaction. How far it is is noted about
/// twice a second. Nothing is done for a run that ended already.
/// @param ending  true when the server wants to end.
/// Errors: not_found, those of reading and of the lab; cancelled when someone asked for it, or the
/// server ends. A volume must come with the measurements.
core::Result<void> diagnose(store::Store& store, const store::Objects& objects,
                            const std::string& diagnosis_id, const std::function<bool()>& ending);

}  // namespace jobs
