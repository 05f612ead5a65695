/// What the server knows of a probing scenario that trials are of.
#pragma once

#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"
#include "scenarios/scenario.hpp"

namespace tractus::jobs {

/// Errors: not_found (no such scenario on this server), those of reading.
core::Result<scenarios::Scenario> scenario_of(store::Store& store, const store::Objects& objects,
                                              const std::string& case_id);

}  // namespace tractus::jobs
