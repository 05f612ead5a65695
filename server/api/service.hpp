/// From a request to its answer: route, credentials, arguments, handler.
#pragma once

#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/http/server.hpp"

namespace tractus::api {

/// A route and what its path's placeholders stand for.
struct Match {
  const RouteInfo* route;
  std::map<std::string, std::string> segments;
};
/// Errors: not_found; bad_input (a broken escape); Errc::forbidden is never one of these. When the
/// path exists with another method, `allowed` (if given) gets those methods.
core::Result<Match> match(const std::vector<RouteInfo>& table, const http::RequestHead& head,
                          std::string* allowed = nullptr);

/// Path, query and header arguments by the route's declaration. Errors: bad_input for one missing
/// or not declared, out_of_range for a number outside its limits.
core::Result<std::map<std::string, std::string>> arguments(const Match& matched,
                                                           const http::RequestHead& head);

/// Everything under /api by `table`.
http::Response answer(Backend& backend, const std::vector<RouteInfo>& table,
                      const http::Request& request);
/// Before the body is read: the same refusals, and how the route takes its body.
std::variant<http::Admitted, http::Response> admit(Backend& backend,
                                                   const std::vector<RouteInfo>& table,
                                                   const http::RequestHead& head);

/// The lane of the request's route; quick when there is none.
http::Lane lane_of(const std::vector<RouteInfo>& table, const http::RequestHead& head);
/// Familiar is who shows good credentials, and an origin from which somebody signed in before.
/// Refuses who may not call the route, and an origin with too many failures.
std::variant<http::Standing, http::Response> standing(Backend& backend,
                                                      const std::vector<RouteInfo>& table,
                                                      const http::RequestHead& head);
/// A request for a WebSocket: checked as any, then the route's conversation.
std::variant<http::Response, std::shared_ptr<http::WebSocketHandler>> converse(
    Backend& backend, const std::vector<RouteInfo>& table, const http::RequestHead& head);

}  // namespace tractus::api
