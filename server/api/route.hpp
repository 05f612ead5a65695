/// A route as data: the server dispatches by it, and the description is made from it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"
#include "server/http/lane.hpp"
#include "server/http/message.hpp"
#include "server/http/scratch_space.hpp"
#include "server/http/websocket_handler.hpp"

namespace tractus::api {

struct Backend;

/// Who asks, after credentials were checked.
enum class Role { admin, director, faculty, researcher, technician, trainee, station };
inline constexpr std::array kRoles{Role::admin,      Role::director,   Role::faculty,
                                   Role::researcher, Role::technician, Role::trainee,
                                   Role::station};
std::string_view name(Role role);
std::optional<Role> role_named(std::string_view name);

/// Of which objects a role may ask: its own, those of the people in the cohorts it leads, or all.
enum class Scope { own, cohort, all };
std::string_view name(Scope of);

/// A role that may call a route; a bare Role means: of all objects.
struct Grant {
  Role role;
  Scope of;
  Grant(Role who, Scope objects = Scope::all) : role(who), of(objects) {}
};

/// Every role but a station's, of all objects.
std::vector<Grant> people();

/// What the route's object is, when a grant says less than "all". `none` with such a grant: the
/// route has no object of its own, and its handler answers by Call::of alone.
enum class Object {
  none,
  trial,
  published_case,
  account,
  person,  ///< an account as a member of cohorts, also one that leads them
  cohort,
  invitation,  ///< into a cohort, by the cohort's id
  assignment,
  study,  ///< of research; `cohort` of it: its participants are through, nothing of it is blind
  model,
  station,
};

/// One end of a relation that a route makes or changes, beside the route's own object: what the
/// object is brought together with. Checked before the handler (access.hpp).
struct End {
  /// "account_id": the argument of this name. "/people/*": this field of the body, as a JSON
  /// pointer in which * is every element. An end that is not there is not checked.
  std::string field;
  Object object;
  std::vector<Grant> who;  ///< of which such objects each role may name one; others may name none
  enum class By { id, account_name } by = By::id;
};

struct Caller {
  Role role;
  std::string id;  ///< of the account or the station
  std::string name;
  std::string session_hash;  ///< of the browser's session; empty for a station
  bool must_change = false;  ///< may do nothing but choose a password
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
      arguments;          ///< by name; of declared ones alone, fallbacks filled in
  Scope of = Scope::own;  ///< the widest that the route grants the caller's role

  bool has(const std::string& name) const { return arguments.contains(name); }
  const std::string& text(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  double number(const std::string& name) const;
};

struct NamedSchema {
  std::string name;  ///< "TrialSummary"
  core::Json schema;
};

/// The request's body as a file in `folder`, whether it came as one or is in memory. Errors: io.
core::Result<std::filesystem::path> body_in(const Call& call, const std::filesystem::path& folder,
                                            const std::string& name);
/// A file as a whole answer, which is deleted once it is sent; it takes no more of the scratch
/// space than it is long. Errors: io.
core::Result<http::Response> scratch_response(std::shared_ptr<http::ScratchFile> file,
                                              const char* content_type, const char* download_name);

/// 426: this address is a WebSocket.
core::Result<http::Response> wants_websocket(const Call& call);

/// A whole answer that is not JSON.
inline constexpr const char* kBytes = "bytes";

/// A route as its file states it. One without `who` is nobody's: it is refused to all, and the
/// tests of the catalogue fail.
struct RouteInfo {
  std::string method;      ///< "GET"
  std::string path;        ///< "/api/v1/trials/{id}"
  std::string id;          ///< "trial", unique: the name of the web's function
  std::string summary;     ///< one line
  std::vector<Grant> who;  ///< may call it; nobody else
  bool open = false;       ///< no credentials at all: signing in
  Object object = Object::none;
  std::string object_parameter = "id";  ///< the argument that names the object
  std::vector<End> ends = {};           ///< every other end of a relation that it makes or changes
  bool before_password_change = false;  ///< also for who must choose a password first
  bool audited = true;                  ///< a change by it is noted in the audit trail
  http::Lane lane = http::Lane::quick;  ///< on which threads it is handled
  std::vector<Parameter> parameters;
  std::string body;  ///< name of the body's schema, kBytes, or "" for none
  std::uint64_t body_limit_bytes = 0;
  bool body_to_file = false;         ///< it is large: handlers find it in Request::body_file
  std::string answer;                ///< name of the answer's schema, kBytes, or "" for none (204)
  std::vector<NamedSchema> schemas;  ///< those it names that no other route has named already
  core::Result<http::Response> (*handle)(const Call& call);
  /// Of a route that is a WebSocket: who answers in it, once everything was checked that is checked
  /// of any route, and by cookie the Origin. `handle` then answers those who come without one.
  core::Result<std::shared_ptr<http::WebSocketHandler>> (*converse)(
      const Call& call, std::function<bool()> may_stay) = nullptr;
};

/// Every file's routes, in file-name order.
std::vector<std::vector<RouteInfo>> all();
/// The same, in one.
const std::vector<RouteInfo>& routes();

/// A route of researchers and administrators at "/api/v1/" + path; "{id}" in it is a parameter.
RouteInfo research_route(std::string method, std::string path, std::string id, std::string summary,
                         std::string answer, core::Result<http::Response> (*handle)(const Call&));
/// The same route with a body, and with the schemas it is the first to name.
RouteInfo taking(RouteInfo route, std::string body, std::uint64_t limit_bytes,
                 std::vector<NamedSchema> schemas);

/// A report as a page of its own: it may show itself and do nothing else.
http::Response as_report(http::Response response);
http::Response json_response(const core::Json& json, int status = 200);
/// The system's causes as HTTP: the one place that knows.
int status_of(core::Errc code);
std::string_view name(core::Errc code);
http::Response error_response(const core::Error& error);

}  // namespace tractus::api
