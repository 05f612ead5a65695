/// Access control: may this caller call this route for this object? Only these functions decide it,
/// on every call, before the handler runs.
#pragma once

#include "db/store/people/people.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// The widest scope that the grants give to the role; nothing if no grant names the role.
std::optional<Scope> granted(const std::vector<Grant>& who, Role role);
/// The widest scope of the role for a route; nothing if the role may not call the route.
std::optional<Scope> granted(const RouteInfo& route, Role role);

/// Whether the caller has the relation `of` to the object; false for an object that does not exist.
core::Result<bool> relates(store::Reading& tx, const Caller& caller, Scope of, Object object,
                           const std::string& id);

/// Checks access to the route's object, then to every other end of the relation that the route
/// makes or changes. Errors: not_found if the caller may not access an object, so that the answer
/// does not reveal whether the object exists; forbidden if the role may not name such an end, or
/// for every caller if the trial is blinded (db/store/studies/blinding.hpp); those of parsing the
/// body.
core::Result<void> check_access(Backend& backend, const RouteInfo& route, const Caller& caller,
                                const std::map<std::string, std::string>& arguments,
                                const std::string& body);

}  // namespace tractus::api
