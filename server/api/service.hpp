/// Answers a request: finds the route, checks credentials and arguments, calls the handler.
#pragma once

#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/http/server.hpp"

namespace tractus::api {

/// A route with the values of its path's placeholders.
struct Match {
  const RouteInfo* route;
  std::map<std::string, std::string> segments;
};
/// Errors: not_found; bad_input (an invalid escape). If the path exists only with other methods,
/// `allowed` (if given) receives these methods.
core::Result<Match> match(const std::vector<RouteInfo>& table, const http::RequestHead& head,
                          std::string* allowed = nullptr);

/// Path, query and header arguments as the route declares them. Errors: bad_input for a missing or
/// an undeclared argument, out_of_range for a number outside its limits.
core::Result<std::map<std::string, std::string>> arguments(const Match& matched,
                                                           const http::RequestHead& head);

/// Answers every request under /api with the routes of `table`.
http::Response answer(Backend& backend, const std::vector<RouteInfo>& table,
                      const http::Request& request);
/// Before the body is read: the same refusals, or how the route receives its body.
std::variant<http::Admitted, http::Response> admit(Backend& backend,
                                                   const std::vector<RouteInfo>& table,
                                                   const http::RequestHead& head);

/// The lane of the request's route; quick if there is no such route.
http::Lane lane_of(const std::vector<RouteInfo>& table, const http::RequestHead& head);
/// `familiar` for valid credentials, and for an origin from which somebody signed in before.
/// Refuses callers that may not call the route, and origins with too many failed attempts.
std::variant<http::Standing, http::Response> standing(Backend& backend,
                                                      const std::vector<RouteInfo>& table,
                                                      const http::RequestHead& head);
/// Whether the request would still come in, for an answer that takes long.
bool still_allowed(Backend& backend, const std::vector<RouteInfo>& table,
                   const http::RequestHead& head);
/// Answers a WebSocket request: the same checks as for every request, then the route's handler.
std::variant<http::Response, std::shared_ptr<http::WebSocketHandler>> converse(
    Backend& backend, const std::vector<RouteInfo>& table, const http::RequestHead& head);

}  // namespace tractus::api
