/// The description of the API, made from the routes.
#pragma once

#include "server/api/route.hpp"

namespace tractus::api {

/// OpenAPI 3.1: every route with parameters, units (x-unit), bodies, answers, errors and who may
/// call (x-roles).
core::Json openapi(const std::vector<RouteInfo>& table);

}  // namespace tractus::api
