#include "server/api/openapi.hpp"

#include <algorithm>
#include <set>

#include "effects/catalogues.hpp"
#include "server/api/people/token_scopes.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

std::string_view where(Parameter::In in) {
  switch (in) {
    case Parameter::In::path:
      return "path";
    case Parameter::In::query:
      return "query";
    case Parameter::In::header:
      return "header";
  }
  return "query";
}

core::Json schema_of(const Parameter& p) {
  if (p.kind == Parameter::Kind::text) {
    core::Json out{{"type", "string"}};
    if (!p.values.empty()) out["enum"] = p.values;
    if (p.fallback) out["default"] = *p.fallback;
    return out;
  }
  const bool whole = p.kind == Parameter::Kind::integer;
  core::Json out{{"type", whole ? "integer" : "number"}, {"x-unit", p.unit}};
  if (whole) {
    out["minimum"] = static_cast<std::int64_t>(p.low);
    out["maximum"] = static_cast<std::int64_t>(p.high);
    if (p.fallback) out["default"] = std::stoll(*p.fallback);
  } else {
    out["minimum"] = p.low;
    out["maximum"] = p.high;
    if (p.fallback) out["default"] = std::stod(*p.fallback);
  }
  return out;
}

core::Json content(const std::string& name) {
  if (name == kForm)
    return {{"application/x-www-form-urlencoded",
             {{"schema", {{"type", "object"}, {"additionalProperties", {{"type", "string"}}}}}}}};
  if (name == kBytes)
    return {{"application/octet-stream", {{"schema", {{"type", "string"}, {"format", "binary"}}}}}};
  return {{"application/json", {{"schema", schema::ref(name)}}}};
}

core::Json error_answer(const char* description) {
  return {{"description", description}, {"content", content("Error")}};
}

core::Json responses(const RouteInfo& route) {
  core::Json out = core::Json::object();
  if (route.converse)
    out["101"] = {{"description", route.summary}, {"content", content(route.answer)}};
  else if (route.answer.empty())
    out["204"] = {{"description", "The request was carried out"}};
  else
    out["200"] = {{"description", route.summary}, {"content", content(route.answer)}};
  out["400"] = error_answer("The request is invalid");
  out["401"] = error_answer("Credentials are missing or wrong");
  if (!route.open) out["403"] = error_answer("The caller's role does not allow this request");
  if (route.path.find('{') != std::string::npos)
    out["404"] = error_answer("The object does not exist, or the caller may not see it");
  if (route.method == "PUT" || route.method == "PATCH" || (route.method == "POST" && !route.open))
    out["409"] = error_answer("The request conflicts with the current state");
  if (!route.body.empty()) out["413"] = error_answer("The body is larger than the limit");
  if (route.open)
    out["429"] = error_answer("Too many failed attempts; wait before the next attempt");
  return out;
}

/// "/api/v1/cases/{id}" is of cases.
std::string resource_of(std::string_view path) {
  path.remove_prefix(path.starts_with("/api/v1/") ? 8 : 5);
  return std::string(path.substr(0, path.find('/')));
}

core::Json operation(const RouteInfo& route) {
  core::Json out{{"operationId", route.id}, {"summary", route.summary}};
  out["tags"] = core::Json::array({resource_of(route.path)});
  core::Json roles = core::Json::array(), security = core::Json::array();
  core::Json objects = core::Json::object();
  for (const Grant& grant : route.who) {
    roles.push_back(name(grant.role));
    objects[std::string(name(grant.role))] = name(grant.of);
    const core::Json by = {
        {grant.role == Role::station ? "station" : "session", core::Json::array()}};
    if (std::ranges::find(security, by) == security.end()) security.push_back(by);
  }
  core::Json scopes = core::Json::array();
  for (const TokenScope scope : scopes_of(route)) {
    scopes.push_back(name(scope));
    security.push_back({{"token", core::Json::array({name(scope)})}});
  }
  if (!scopes.empty()) out["x-token-scopes"] = scopes;
  out["x-roles"] = roles;
  out["x-objects"] = objects;
  out["security"] = security;
  core::Json parameters = core::Json::array();
  for (const Parameter& p : route.parameters)
    parameters.push_back({{"name", p.name},
                          {"in", where(p.in)},
                          {"required", p.required && !p.fallback},
                          {"description", p.meaning},
                          {"schema", schema_of(p)}});
  out["parameters"] = parameters;
  if (!route.body.empty())
    out["requestBody"] = {{"required", true}, {"content", content(route.body)}};
  out["responses"] = responses(route);
  if (route.converse) out["x-websocket"] = true;  // the frames are the answer's content
  return out;
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return text;
}

}  // namespace

core::Json openapi(const std::vector<RouteInfo>& table) {
  core::Json paths = core::Json::object(), schemas = core::Json::object();
  schemas["Error"] = schema::object(
      {{"error", schema::text("Description of the error, one line for people")},
       {"code", schema::text("Code of the error for programs, for example bad_input")}});
  std::set<std::string> resources;
  for (const RouteInfo& route : table) {
    paths[route.path][lower_case(route.method)] = operation(route);
    resources.insert(resource_of(route.path));
    for (const NamedSchema& named : route.schemas) schemas[named.name] = named.schema;
  }
  core::Json tags = core::Json::array();
  for (const std::string& resource : resources)
    tags.push_back({{"name", resource}, {"description", "Routes of the resource " + resource}});
  return {{"openapi", "3.1.0"},
          {"info",
           {{"title", "Tractus"},
            {"version", "1"},
            {"description",
             "Cases, trials and their assessment. Values are in SI units unless a field states "
             "another unit; the name of a field ends with its unit."},
            {"license", {{"name", "Apache-2.0"}, {"identifier", "Apache-2.0"}}}}},
          {"servers", core::Json::array({{{"url", "/"}, {"description", "This server"}}})},
          {"x-effect-labels", effects::labels()},
          {"tags", tags},
          {"paths", paths},
          {"components",
           {{"schemas", schemas},
            {"securitySchemes",
             {{"session", {{"type", "apiKey"}, {"in", "cookie"}, {"name", "tractus_session"}}},
              {"station", {{"type", "http"}, {"scheme", "bearer"}}},
              {"token",
               {{"type", "http"},
                {"scheme", "bearer"},
                {"description",
                 "Personal API token of an account, within its scopes and the account's "
                 "role"}}}}}}}};
}

}  // namespace api
}  // namespace tractus
