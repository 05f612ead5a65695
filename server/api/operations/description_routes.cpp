/// The API's own description.
#include "server/api/openapi.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {
core::Result<http::Response> describe(const Call&) { return json_response(openapi(routes())); }
}  // namespace

std::vector<RouteInfo> description_routes() {
  return {{.method = "GET",
           .path = "/api/openapi.json",
           .id = "description",
           .summary = "Read this description of the API (OpenAPI 3.1)",
           .who = {kRoles.begin(), kRoles.end()},
           .parameters = {},
           .body = "",
           .answer = "Description",
           .schemas = {{"Description", schema::anything("Document in OpenAPI 3.1 format")}},
           .handle = describe}};
}

}  // namespace api
}  // namespace tractus
