/// May this caller ask this of this object? Decided here alone, on every call, before the handler.
#pragma once

#include "db/store/people.hpp"
#include "server/api/route.hpp"

namespace api {

/// The widest that the route grants to the role; nothing: it may not call it at all.
std::optional<Of> granted(const RouteInfo& route, Role role);

/// Does the caller stand to the object as `of` says? Of nothing that does not exist.
core::Result<bool> relates(store::Reading& tx, const Caller& caller, Of of, Object object,
                           const std::string& id);

/// Errors: not_found when the object is none of the caller's: what others have is not even told to
/// exist.
core::Result<void> check_object(Backend& backend, const RouteInfo& route, const Caller& caller,
                                const std::map<std::string, std::string>& arguments);

}  // namespace api
