/// Runs the model lab on what was uploaded.
#pragma once

#include <functional>

#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"

namespace tractus::jobs {

/// Does what was asked of a model and a measurement set (diagnosis, comparison, fit): result,
/// report, samples and the better model become objects, in one transaction. How far it is is noted
/// about twice a second, the ranking of a diagnosis as soon as every effect was tried by itself.
/// Nothing is done for a run that ended already.
/// @param ending  true when the server wants to end.
/// Errors: not_found, those of reading and of the lab; cancelled when someone asked for it, or the
/// server ends. A volume must come with the measurements.
core::Result<void> run_lab(store::Store& store, const store::Objects& objects,
                           const std::string& run_id, const std::function<bool()>& ending);

}  // namespace tractus::jobs
