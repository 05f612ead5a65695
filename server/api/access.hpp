/// May this caller ask this of this object? Decided here alone, on every call, before the handler.
#pragma once

#include "db/store/people/people.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// The widest that the grants say of the role; nothing: it is not among them.
std::optional<Scope> granted(const std::vector<Grant>& who, Role role);
/// Of a route: nothing: the role may not call it at all.
std::optional<Scope> granted(const RouteInfo& route, Role role);

/// Does the caller stand to the object as `of` says? Of nothing that does not exist.
core::Result<bool> relates(store::Reading& tx, const Caller& caller, Scope of, Object object,
                           const std::string& id);

/// Of the route's object, then of every other end of the relation that it makes or changes. Errors:
/// not_found when an object is none of the caller's: what others have is not even told to exist;
/// forbidden when the role may name no such end, or for a trial that is blind still
/// (db/store/studies/blinding.hpp), whoever asks; those of parsing the body.
core::Result<void> check_access(Backend& backend, const RouteInfo& route, const Caller& caller,
                                const std::map<std::string, std::string>& arguments,
                                const std::string& body);

}  // namespace tractus::api
