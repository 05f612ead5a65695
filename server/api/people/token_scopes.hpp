/// What a personal API token may do: each scope is a set of routes, stated in one table. A route
/// that is in no scope cannot be called with a token. Roles and relations apply as without one.
#pragma once

#include "db/store/people/api_tokens.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

using store::TokenScope;

/// The scopes of a route, each of which allows it; empty: no token may call it.
std::vector<TokenScope> scopes_of(const RouteInfo& route);
/// Whether a token with these scopes may call the route.
bool allows(const std::vector<TokenScope>& held, const RouteInfo& route);
/// The scopes with at least one route that the role may call.
std::vector<TokenScope> scopes_for(Role role);
/// What a scope allows, in one line for people.
std::string_view meaning(TokenScope scope);
/// The caller as the one who ends a token now.
store::TokenEnd token_end_of(const Call& call);
/// The ids of the routes that the table names, also of those that any scope allows.
std::vector<std::string_view> routes_of_scopes();

}  // namespace tractus::api
