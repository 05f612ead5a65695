/// A station in the JSON form of the routes: stored facts and current state.
#pragma once

#include "db/store/people/accounts.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/live/hub.hpp"

namespace tractus::api {

/// The people at stations whom the caller may see: all, those of the caller's cohorts, or none.
live::Viewer viewer_of(const Caller& caller);
/// The hub of live connections. Errors: unavailable if this server has none.
core::Result<live::Hub*> hub_of(Backend& backend);

/// StationState with the times of the station's enrolment and revocation.
core::Json station_json(Backend& backend, const store::StationEntry& entry, const Caller& caller);
/// Errors: not_found.
core::Result<store::StationEntry> station_entry(Backend& backend, const std::string& id);

/// The fields of StationState.
std::vector<schema::Field> station_state_fields();

}  // namespace tractus::api
