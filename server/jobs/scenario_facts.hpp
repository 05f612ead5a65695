/// What the server knows of a probing scenario that trials are of.
#pragma once

#include "db/store/objects.hpp"
#include "db/store/store.hpp"
#include "scenarios/scenario.hpp"

namespace jobs {

/// Errors: not_found (no such scenario on this server), those of reading.
core::Result<scenarios::Scenario> scenario_of(store::Store& store, const store::Objects& objects,
                                              const std::string& case_id);

}  // namespace jobs
