/// A route as data: the server dispatches by it, and the description is made from it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/errc_words.hpp"
#include "core/json.hpp"
#include "core/result.hpp"
#include "db/store/people/role.hpp"
#include "db/store/people/token_scope.hpp"
#include "server/http/lane.hpp"
#include "server/http/message.hpp"
#include "server/http/scratch_space.hpp"
#include "server/http/websocket_handler.hpp"

namespace tractus::api {

struct Backend;

using core::name;
using store::kRoles;
using store::Role;  // of a caller, after the credentials were checked

/// The objects that a role may access: its own, those of the people in the cohorts that it leads,
/// or all.
enum class Scope { own, cohort, all };
constexpr auto words(Scope) {
  using enum Scope;
  return std::to_array<core::Word<Scope>>({{own, "own"}, {cohort, "cohort"}, {all, "all"}});
}

/// A role that may call a route, and for which objects; a Role alone means all objects.
struct Grant {
  Role role;
  Scope of;
  Grant(Role who, Scope objects = Scope::all) : role(who), of(objects) {}
};

/// Every role except station, for all objects.
std::vector<Grant> people();

/// The kind of a route's object, for grants with a narrower scope than "all". `none` with such a
/// grant: the route has no object, and its handler filters the answer by Call::of.
enum class Object {
  none,
  trial,
  published_case,
  account,
  person,  ///< an account as a member or leader of cohorts
  cohort,
  invitation,  ///< into a cohort, by the cohort's id
  assignment,
  study,  ///< a research study; scope `cohort`: nothing of it is blinded any more
  model,
  station,
  api_token,  ///< a personal API token, by the id of its entry
};

/// One end of a relation that a route makes or changes, besides the route's own object: the other
/// object of the relation. Access to it is checked before the handler runs (access.hpp).
struct End {
  /// "account_id": the argument with this name. "/people/*": this field of the body, as a JSON
  /// pointer in which * means every element. A missing end is not checked.
  std::string field;
  Object object;
  std::vector<Grant> who;  ///< the objects that each role may name; other roles may name none
  enum class By { id, account_name } by = By::id;
};

/// A personal API token, by which a call comes in place of a session.
struct TokenUse {
  std::string id;                         ///< of the token's entry
  std::vector<store::TokenScope> scopes;  ///< the only routes that the call may use
};

struct Caller {
  Role role;
  std::string id;  ///< of the account or the station
  std::string name;
  std::string
      session_hash;  ///< hash of the browser's session token; empty for a station and an API token
  bool must_change = false;  ///< may only change the password
  std::optional<TokenUse> token = {};
  std::string language = {};  ///< of the person's pages; empty: not chosen
};

/// The place, type and range of an argument. A text in a path is one segment, decoded.
struct Parameter {
  enum class In { path, query, header };
  enum class Kind { text, integer, number };
  In in;
  std::string name;
  Kind kind;
  std::string unit;  ///< unit of a number; "" for a text
  std::string meaning;
  bool required = true;
  double low = 0.0, high = 0.0;              ///< range of a number, inclusive
  std::optional<std::string> fallback = {};  ///< default value of an optional argument
  std::vector<std::string> values = {};      ///< the only values of a text; empty: any text
};
Parameter path_text(std::string name, std::string meaning);

/// The input of a handler: checked credentials and arguments.
struct Call {
  Backend& backend;
  const http::Request& request;
  const Caller& caller;  ///< without id and name for an open route
  std::map<std::string, std::string>
      arguments;          ///< by name; only declared arguments, with default values
  Scope of = Scope::own;  ///< the widest scope that the route grants to the caller's role

  bool has(const std::string& name) const { return arguments.contains(name); }
  const std::string& text(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  double number(const std::string& name) const;
};

struct NamedSchema {
  std::string name;  ///< "TrialSummary"
  core::Json schema;
};

/// Provides the request's body as a file in `folder`, also if the body is in memory. Errors: io.
core::Result<std::filesystem::path> body_in(const Call& call, const std::filesystem::path& folder,
                                            const std::string& name);
/// A response with a file, which is deleted after sending; reduces the reservation in the scratch
/// space to the length of the file. Errors: io.
core::Result<http::Response> scratch_response(std::shared_ptr<http::ScratchFile> file,
                                              const char* content_type, const char* download_name);

/// The answer 426 to a request without upgrade at the address of a WebSocket.
core::Result<http::Response> wants_websocket(const Call& call);

/// The name for a body or answer that is not JSON.
inline constexpr const char* kBytes = "bytes";
/// The name for a body of a form: "a=1&b=2".
inline constexpr const char* kForm = "form";

/// The declaration of a route. A route without `who` is refused to every caller, and the tests of
/// the catalogue fail.
struct RouteInfo {
  std::string method;      ///< "GET"
  std::string path;        ///< "/api/v1/trials/{id}"
  std::string id;          ///< "trial", unique: the operationId
  std::string summary;     ///< one line, which begins with what the route does
  std::vector<Grant> who;  ///< the only roles that may call the route
  bool open = false;       ///< needs no credentials, for example signing in
  /// A page of another site may send a form to the route (only an open one), whose handler checks
  /// that it comes from a known site: a launch by a learning platform.
  bool takes_foreign_form = false;
  Object object = Object::none;
  std::string object_parameter = "id";  ///< the argument that names the object
  std::vector<End> ends = {};  ///< the other ends of a relation that the route makes or changes
  bool before_password_change = false;  ///< allowed before a required password change
  bool audited = true;                  ///< changes by this route are written into the audit trail
  http::Lane lane = http::Lane::quick;  ///< the threads that handle the route
  std::vector<Parameter> parameters;
  std::string body;  ///< name of the body's schema, kBytes, or "" for none
  std::uint64_t body_limit_bytes = 0;
  bool body_to_file = false;  ///< the body is large: the handler reads it from Request::body_file
  std::string answer;         ///< name of the answer's schema, kBytes, or "" for none (204)
  std::vector<NamedSchema> schemas;  ///< schemas that this route uses and no other route defines
  core::Result<http::Response> (*handle)(const Call& call);
  /// For a WebSocket: makes its handler, after the checks of every route and, for a cookie, a check
  /// of the Origin. `handle` then answers requests without an upgrade.
  core::Result<std::shared_ptr<http::WebSocketHandler>> (*converse)(
      const Call& call, std::function<bool()> may_stay) = nullptr;
};

/// The routes of every file, sorted by file name.
std::vector<std::vector<RouteInfo>> all();
/// The same routes in one list.
const std::vector<RouteInfo>& routes();

/// A route for researchers and administrators at "/api/v1/" + path; "{id}" in the path is a
/// parameter.
RouteInfo research_route(std::string method, std::string path, std::string id, std::string summary,
                         std::string answer, core::Result<http::Response> (*handle)(const Call&));
/// The same route with a body, and with the schemas that it defines.
RouteInfo taking(RouteInfo route, std::string body, std::uint64_t limit_bytes,
                 std::vector<NamedSchema> schemas);

/// Restricts a report page with a Content-Security-Policy: no scripts, no other resources.
http::Response as_report(http::Response response);
/// Sends the browser to an address; 303 after a POST.
http::Response redirection(const std::string& address, int status = 302);
http::Response json_response(const core::Json& json, int status = 200);
/// The HTTP status of an error code; the only place that defines this mapping.
int status_of(core::Errc code);
http::Response error_response(const core::Error& error);

/// "no model 0f3a here".
core::Error absent(const char* what, const std::string& id);

}  // namespace tractus::api
