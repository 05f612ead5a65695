/// Invitations into cohorts as those who are invited see them: who accepts one joins the cohort.
#include "core/try.hpp"
#include "db/store/people/invitations.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/assignment_plan.hpp"

namespace tractus {
namespace api {
namespace {

using core::Error;
using core::Result;

Result<http::Response> own_invitations(const Call& call) {
  auto found = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::invitations_for(tx, call.caller.name); }));
  core::Json list = core::Json::array();
  for (const auto& one : found)
    list.push_back({{"cohort_id", one.cohort_id},
                    {"cohort_name", one.cohort_name},
                    {"made_utc_us", one.made_utc_us},
                    {"made_by", one.made_by}});
  return json_response({{"invitations", list}});
}

Result<http::Response> accept(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto account = TRY(store::account_of(tx, call.caller.id));
    core::require(account.has_value(), "who calls has an account");
    return join_cohort(tx, call.text("cohort"), *account,
                       {call.caller.name, call.backend.now_utc_us()});
  }));
  return own_invitations(call);
}

Result<http::Response> decline(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::remove_invitation(tx, call.text("cohort"), call.caller.name);
  }));
  return own_invitations(call);
}

RouteInfo invitation_route(std::string method, std::string tail, std::string id,
                           std::string summary, Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/session/invitations" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {{Role::trainee, Scope::own}, {Role::faculty, Scope::own}},
                .object = tail.empty() ? Object::none : Object::invitation,
                .object_parameter = "cohort",
                .parameters = {},
                .body = "",
                .answer = "Invitations",
                .schemas = {},
                .handle = handle};
  if (!tail.empty()) out.parameters.push_back(path_text("cohort", "Id of the cohort"));
  return out;
}

}  // namespace

std::vector<RouteInfo> invitations_routes() {
  using namespace schema;
  RouteInfo list = invitation_route("GET", "", "ownInvitations",
                                    "List the caller's open invitations into cohorts, oldest first",
                                    own_invitations);
  list.schemas = {
      {"Invitation",
       object({{"cohort_id", text("Id of the cohort")},
               {"cohort_name", text("Name of the cohort")},
               {"made_utc_us",
                integer("us", "Time of the invitation, in microseconds since 1970-01-01 UTC")},
               {"made_by", text("Name of the account that sent the invitation")}})},
      {"Invitations",
       object({{"invitations",
                array(ref("Invitation"), "Open invitations of the caller, oldest first")}})}};
  RouteInfo yes =
      invitation_route("POST", "/{cohort}/accept", "acceptInvitation",
                       "Accept an invitation and join the cohort; the leaders of the cohort can "
                       "then see the caller's trials",
                       accept);
  // The invitation gives the caller the right to name this cohort.
  yes.ends = {{"cohort", Object::cohort, {Role::trainee, Role::faculty}}};
  RouteInfo no = invitation_route("POST", "/{cohort}/decline", "declineInvitation",
                                  "Decline an invitation; the invitation is removed", decline);
  no.ends = yes.ends;
  return {list, yes, no};
}

}  // namespace api
}  // namespace tractus
