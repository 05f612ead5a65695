/// Cohorts: who learns with whom, and who teaches them.
#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/people/invitations.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/assignment_plan.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using store::CohortPart;

constexpr std::uint64_t kMaxCohorts_bytes = 4096;

core::Json cohort_json(const store::Cohort& cohort) {
  return {{"id", cohort.id},
          {"name", cohort.name},
          {"trainees", cohort.trainees},
          {"made_utc_us", cohort.made_utc_us},
          {"made_by", cohort.made_by}};
}

Result<http::Response> list_cohorts(const Call& call) {
  auto found = TRY(call.backend.store.read([&](store::Reading& tx) {
    return store::cohorts_of(tx, call.of == Scope::all ? "" : call.caller.id);
  }));
  core::Json list = core::Json::array();
  for (const auto& cohort : found) list.push_back(cohort_json(cohort));
  return json_response({{"cohorts", list}});
}

Result<http::Response> cohort_response(store::Store& store, const std::string& id, int status) {
  auto answer = TRY(store.read([&](store::Reading& tx) -> Result<core::Json> {
    auto cohort = TRY(store::cohort_of(tx, id));
    if (!cohort) return Error{Errc::not_found, "no cohort " + id.substr(0, 32)};
    auto people = TRY(store::people_of(tx, id));
    core::Json out = cohort_json(*cohort);
    out["people"] = core::Json::array();
    auto invited = TRY(store::invitations_into(tx, id));
    out["invitations"] = core::Json::array();
    for (const auto& one : invited)
      out["invitations"].push_back(
          {{"name", one.account_name}, {"made_utc_us", one.made_utc_us}, {"made_by", one.made_by}});
    for (const auto& person : people)
      out["people"].push_back({{"account_id", person.account_id},
                               {"name", person.name},
                               {"part", name(person.part)},
                               {"state", name(person.state)}});
    return out;
  }));
  return json_response(answer, status);
}

Result<http::Response> one_cohort(const Call& call) {
  return cohort_response(call.backend.store, call.text("id"), 200);
}

/// A member of the faculty who creates a cohort becomes its leader.
Result<http::Response> add_cohort_route(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  store::Cohort cohort{core::new_id(), fields.text("name", kMaxName), call.backend.now_utc_us(),
                       call.caller.name};
  if (cohort.name.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("name", "a name is expected");
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(store::add_cohort(tx, cohort));
    if (call.caller.role != Role::faculty) return {};
    return store::put_into_cohort(tx, cohort.id, call.caller.id, CohortPart::faculty,
                                  cohort.made_utc_us);
  }));
  return cohort_response(call.backend.store, cohort.id, 201);
}

Result<void> put(store::Writing& tx, const Call& call, const std::string& account_name) {
  auto account = TRY(store::account_named(tx, account_name));
  if (!account) return Error{Errc::bad_input, "body: /name: there is no account with this name"};
  return join_cohort(tx, call.text("id"), *account, {call.caller.name, call.backend.now_utc_us()});
}

Result<http::Response> put_person(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string name = fields.text("name", kMaxName);
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) { return put(tx, call, name); }));
  return cohort_response(call.backend.store, call.text("id"), 200);
}

Result<http::Response> invite_person(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const store::Invitation invitation{.cohort_id = call.text("id"),
                                     .account_name = fields.text("name", kMaxName),
                                     .made_utc_us = call.backend.now_utc_us(),
                                     .made_by = call.caller.name};
  if (invitation.account_name.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("name", "a name is expected");
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto cohort = TRY(store::cohort_of(tx, invitation.cohort_id));
    if (!cohort) return Error{Errc::not_found, "no cohort " + invitation.cohort_id.substr(0, 32)};
    return store::invite(tx, invitation);
  }));
  return cohort_response(call.backend.store, call.text("id"), 201);
}

Result<http::Response> withdraw_invitation(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::remove_invitation(tx, call.text("id"), call.text("name"));
  }));
  return cohort_response(call.backend.store, call.text("id"), 200);
}

Result<http::Response> take_person(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::take_from_cohort(tx, call.text("id"), call.text("account_id"));
  }));
  return cohort_response(call.backend.store, call.text("id"), 200);
}

RouteInfo cohorts_route(std::string method, std::string tail, std::string id, std::string summary,
                        Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/cohorts" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin, {Role::faculty, Scope::cohort}},
                .object = tail.empty() ? Object::none : Object::cohort,
                .parameters = {},
                .body = "",
                .body_limit_bytes = kMaxCohorts_bytes,
                .answer = "Cohort",
                .schemas = {},
                .handle = handle};
  if (!tail.empty()) out.parameters.push_back(path_text("id", "Id of the cohort"));
  return out;
}

std::vector<NamedSchema> cohort_schemas() {
  using namespace schema;
  const std::vector<Field> summary{
      {"id", text("Id of the cohort, which never changes")},
      {"name", text("Name of the cohort")},
      {"trainees", integer("1", "Number of trainees in the cohort")},
      {"made_utc_us", integer("us", "Time of creation, in microseconds since 1970-01-01 UTC")},
      {"made_by", text("Name of the account that created the cohort")}};
  std::vector<Field> whole = summary;
  whole.emplace_back("people", array(ref("CohortPerson"), "Members of the cohort, sorted by name"));
  whole.emplace_back(
      "invitations",
      array(object({{"name", text("Name of the invited account, as the inviting person typed it")},
                    {"made_utc_us",
                     integer("us", "Time of the invitation, in microseconds since 1970-01-01 UTC")},
                    {"made_by", text("Name of the account that sent the invitation")}}),
            "Open invitations, sorted by name"));
  return {
      {"CohortSummary", object(summary)},
      {"Cohorts", object({{"cohorts", array(ref("CohortSummary"), "Cohorts, sorted by name")}})},
      {"CohortPerson",
       object({{"account_id", text("Id of the person's account")},
               {"name", text("Name of the account")},
               {"part", one_of<CohortPart>(
                            "Part in the cohort: a trainee learns, faculty leads the cohort")},
               {"state", one_of<store::AccountState>(
                             "State of the account; a disabled account cannot sign in")}})},
      {"Cohort", object(whole)}};
}

RouteInfo putting_route() {
  RouteInfo out = cohorts_route(
      "POST", "/{id}/people", "putIntoCohort",
      "Add a person to a cohort: a trainee as a learner, a member of the faculty as a leader",
      put_person);
  out.who.push_back(Role::director);
  out.ends = {{"/name", Object::person, out.who, End::By::account_name}};
  out.body = "PersonNamed";
  out.schemas = {{"PersonNamed", schema::object({{"name", schema::text("Name of the account")}})}};
  return out;
}

RouteInfo taking_route() {
  RouteInfo out =
      cohorts_route("DELETE", "/{id}/people/{account_id}", "takeFromCohort",
                    "Remove a person from a cohort; the person's trials stay", take_person);
  out.parameters.push_back(path_text("account_id", "Id of the person's account"));
  out.ends = {{"account_id", Object::person, out.who}};
  return out;
}

/// Every person may be invited, because the person accepts or declines.
std::vector<RouteInfo> inviting_routes() {
  const std::vector<Grant> inviting{Role::admin, Role::director, Role::faculty};
  RouteInfo ask =
      cohorts_route("POST", "/{id}/invitations", "inviteIntoCohort",
                    "Invite a person into a cohort, without the right to add the person "
                    "directly; the person accepts or declines",
                    invite_person);
  ask.who.push_back(Role::director);
  ask.ends = {{"/name", Object::person, inviting, End::By::account_name}};
  ask.body = "PersonNamed";
  RouteInfo withdraw = cohorts_route("DELETE", "/{id}/invitations/{name}", "withdrawInvitation",
                                     "Withdraw an invitation", withdraw_invitation);
  withdraw.who.push_back(Role::director);
  withdraw.parameters.push_back(
      path_text("name", "Name of the invited account, as in the invitation"));
  withdraw.ends = {{"name", Object::person, inviting, End::By::account_name}};
  return {ask, withdraw};
}

}  // namespace

std::vector<RouteInfo> cohorts_routes() {
  RouteInfo list = cohorts_route(
      "GET", "", "cohorts",
      "List cohorts, sorted by name: all cohorts, or those that the caller leads or is a member of",
      list_cohorts);
  list.answer = "Cohorts";
  list.who = {
      Role::admin, Role::director, {Role::faculty, Scope::cohort}, {Role::trainee, Scope::own}};
  list.schemas = cohort_schemas();
  RouteInfo one =
      cohorts_route("GET", "/{id}", "cohort",
                    "Read one cohort with its members and open invitations", one_cohort);
  one.who.push_back(Role::director);
  RouteInfo add = cohorts_route(
      "POST", "", "addCohort",
      "Create a cohort; a member of the faculty who creates a cohort becomes its leader",
      add_cohort_route);
  add.who.push_back(Role::director);
  add.body = "NewCohort";
  add.schemas = {
      {"NewCohort",
       schema::object(
           {{"name", schema::text("Name of the cohort; no other cohort may have this name")}})}};
  std::vector<RouteInfo> out{list, one, add, putting_route(), taking_route()};
  for (RouteInfo& inviting : inviting_routes()) out.push_back(std::move(inviting));
  return out;
}

}  // namespace api
}  // namespace tractus
