/// A station as the fleet's pages show it: kept facts and what it does just now.
#pragma once

#include "db/store/people/accounts.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/live/hub.hpp"

namespace tractus::api {

/// Which people at work the caller may see: everybody, those of the own cohorts, nobody.
live::Viewer viewer_of(const Caller& caller);
/// The hub of a server that runs. Errors: unavailable in one that has none.
core::Result<live::Hub*> hub_of(Backend& backend);

/// StationState, and when the station was enrolled and shut out.
core::Json station_json(Backend& backend, const store::StationEntry& entry, const Caller& caller);
/// Errors: not_found.
core::Result<store::StationEntry> station_entry(Backend& backend, const std::string& id);

/// The fields of StationState.
std::vector<schema::Field> station_state_fields();

}  // namespace tractus::api
