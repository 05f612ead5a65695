/// A route as data: the server dispatches by it, and the description is made from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"
#include "server/http/message.hpp"

namespace api {

struct Backend;

/// Who asks, after credentials were checked.
enum class Role { admin, station };
std::string_view name(Role role);

struct Caller {
  Role role;
  std::string id;  ///< of the account or the station
  std::string name;
  std::string session_hash;  ///< of the browser's session; empty for a station
};

/// Where an argument stands and what it may be. Text in a path: one segment, decoded.
struct Parameter {
  enum class In { path, query, header };
  enum class Kind { text, integer, number };
  In in;
  std::string name;
  Kind kind;
  std::string unit;  ///< of a number, else ""
  std::string meaning;
  bool required = true;
  double low = 0.0, high = 0.0;         ///< of a number, both included
  std::optional<std::string> fallback;  ///< taken when it is not given
};
Parameter path_text(std::string name, std::string meaning);

/// What a handler gets: checked credentials and arguments.
struct Call {
  Backend& backend;
  const http::Request& request;
  const Caller& caller;  ///< nobody's for an open route
  std::map<std::string, std::string>
      arguments;  ///< by name; of declared ones alone, fallbacks filled in

  bool has(const std::string& name) const { return arguments.contains(name); }
  const std::string& text(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  double number(const std::string& name) const;
};

struct NamedSchema {
  std::string name;  ///< "TrialSummary"
  core::Json schema;
};

/// A whole answer that is not JSON.
inline constexpr const char* kBytes = "bytes";

struct RouteInfo {
  std::string method;     ///< "GET"
  std::string path;       ///< "/api/v1/trials/{id}"
  std::string id;         ///< "trial", unique: the name of the web's function
  std::string summary;    ///< one line
  std::vector<Role> who;  ///< may call it; nobody else
  bool open = false;      ///< no credentials at all: signing in
  std::vector<Parameter> parameters;
  std::string body;  ///< name of the body's schema, kBytes, or "" for none
  std::uint64_t body_limit_bytes = 0;
  std::string answer;                ///< name of the answer's schema, kBytes, or "" for none (204)
  std::vector<NamedSchema> schemas;  ///< those it names that no other route has named already
  core::Result<http::Response> (*handle)(const Call& call);
};

/// Every file's routes, in file-name order.
std::vector<std::vector<RouteInfo>> all();
/// The same, in one.
const std::vector<RouteInfo>& routes();

http::Response json_response(const core::Json& json, int status = 200);
/// The system's causes as HTTP: the one place that knows.
int status_of(core::Errc code);
std::string_view name(core::Errc code);
http::Response error_response(const core::Error& error);

}  // namespace api
