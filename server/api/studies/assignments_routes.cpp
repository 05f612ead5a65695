/// Assignments: what trainees are to do, until when, and when they may see how they did.
#include "core/try.hpp"
#include "db/store/studies/assignments.hpp"
#include "db/store/trials/debriefs.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/assignment_plan.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxPlan_bytes = 4u << 20, kMaxBody_bytes = 4096;
constexpr long kMaxTime_us = 9'000'000'000'000'000;

Json time_or_null(const std::optional<std::int64_t>& time) { return time ? Json(*time) : Json(); }

/// A trainee is told nothing of the order, nor of what others do.
Json assignment_json(const store::Assignment& a, Scope of) {
  Json out{{"id", a.study.id},
           {"title", a.study.title},
           {"state", a.study.state},
           {"due_utc_us", time_or_null(a.due_utc_us)},
           {"release", a.release},
           {"done", a.done},
           {"planned", a.planned},
           {"to_drill", a.to_drill},
           {"cohort_id", a.cohort_id ? Json(*a.cohort_id) : Json()},
           {"cohort_name", a.cohort_name},
           {"made_utc_us", a.study.made_utc_us},
           {"made_by", a.study.made_by}};
  if (of == Scope::own) return out;
  out["ordering"] = a.study.ordering;
  out["repeats"] = a.study.repeats;
  out["people"] = a.people;
  return out;
}

Result<http::Response> list_assignments(const Call& call) {
  store::AssignmentFilter whose;
  if (call.of == Scope::cohort) whose.led_by = call.caller.id;
  if (call.of == Scope::own) whose.done_by = call.caller.id;
  auto found = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::assignments_of(tx, whose); }));
  Json list = Json::array();
  for (const auto& one : found) list.push_back(assignment_json(one, call.of));
  return json_response({{"assignments", list}});
}

/// @param whose  this participant's alone; empty: everybody's.
Result<Json> trials_json(store::Reading& tx, const store::AssignmentId& id,
                         const std::string& whose) {
  auto slots = TRY(store::study_slots(tx, id));
  std::map<std::string, const store::Slot*> places;
  for (const auto& slot : slots) places[slot.id] = &slot;
  auto trials = TRY(store::study_trials(tx, id));
  Json out = Json::array();
  for (const auto& trial : trials) {
    const auto place = places.find(trial.slot_id);
    if (place == places.end() || (!whose.empty() && place->second->participant != whose)) continue;
    auto comments = TRY(store::comments_of(tx, trial.trial_id));
    out.push_back({{"trial_id", trial.trial_id},
                   {"participant", place->second->participant},
                   {"number", place->second->position + 1},
                   {"tool", trial.tool},
                   {"state", trial.state},
                   {"reason", trial.reason},
                   {"correct", trial.correct ? Json(*trial.correct) : Json()},
                   {"comments", comments.size()},
                   {"started_utc_us", time_or_null(trial.started_utc_us)}});
  }
  return out;
}

/// What a trainee has done of it, once the results may be seen.
Result<Json> own_trials_json(store::Reading& tx, const store::AssignmentId& id,
                             const std::string& me) {
  auto participant = TRY(store::participant_for(tx, id, me));
  return trials_json(tx, id, participant);
}

Result<Json> whole_json(store::Reading& tx, const std::string& asked, Scope of,
                        const std::string& me) {
  auto id = TRY(store::find_assignment(tx, asked));
  auto found = TRY(store::assignment_of(tx, id, of == Scope::own ? me : ""));
  Json out = assignment_json(found, of);
  if (of == Scope::own) {
    if (found.release == "held") return out;
    auto own = TRY(own_trials_json(tx, id, me));
    out["trials"] = std::move(own);
    return out;
  }
  out["trainees"] = Json::array();
  auto people = TRY(store::assigned_people(tx, id));
  for (const auto& person : people)
    out["trainees"].push_back({{"account_id", person.account_id},
                               {"name", person.name},
                               {"participant", person.participant},
                               {"done", person.done},
                               {"planned", person.planned}});
  auto trials = TRY(trials_json(tx, id, ""));
  out["trials"] = std::move(trials);
  return out;
}

Result<http::Response> assignment_response(const Call& call, const std::string& id, int status) {
  auto json = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return whole_json(tx, id, call.of, call.caller.id); }));
  return json_response(json, status);
}

Result<http::Response> one_assignment(const Call& call) {
  return assignment_response(call, call.text("id"), 200);
}

Result<http::Response> add_assignment_route(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  auto plan = TRY(AssignmentPlan::from_json(json));
  auto id = TRY(make_assignment(call, plan));
  return assignment_response(call, id, 201);
}

/// Reads the body with `read(fields)`, runs `work(tx, id, stamp)`, answers with the assignment.
template <class Read, class Work>
Result<http::Response> changed(const Call& call, Read read, Work work) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  read(fields);
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto id = TRY(store::find_assignment(tx, call.text("id")));
    return work(tx, id, store::AuditStamp{call.caller.name, call.backend.now_utc_us()});
  }));
  return one_assignment(call);
}

Result<http::Response> set_release(const Call& call) {
  std::string release;
  return changed(
      call,
      [&](core::Fields& fields) {
        release = fields.text("release", 16);
        if (release != "held" && release != "released" && release != "at_once")
          fields.wrong("release", "held, released or at_once is expected");
      },
      [&](store::Writing& tx, const store::AssignmentId& id, const store::AuditStamp& stamp) {
        return store::set_release(tx, id, release, stamp);
      });
}

Result<http::Response> set_due(const Call& call) {
  std::optional<std::int64_t> due;
  return changed(
      call,
      [&](core::Fields& fields) {
        const Json* given = fields.member("due_utc_us");
        if (given && !given->is_null()) due = fields.integer("due_utc_us", 0, kMaxTime_us);
      },
      [&](store::Writing& tx, const store::AssignmentId& id, const store::AuditStamp& stamp) {
        return store::set_due(tx, id, due, stamp);
      });
}

Result<http::Response> assign_person(const Call& call) {
  std::string name;
  return changed(
      call, [&](core::Fields& fields) { name = fields.text("name", kMaxName); },
      [&](store::Writing& tx, const store::AssignmentId& id,
          const store::AuditStamp& stamp) -> Result<void> {
        auto account = TRY(store::account_named(tx, name));
        if (!account)
          return Error{Errc::not_found, "body: /name: there is no account of this name"};
        return assign_to(tx, id, *account, stamp);
      });
}

Result<http::Response> invalidate(const Call& call) {
  std::string reason;
  return changed(
      call,
      [&](core::Fields& fields) {
        reason = fields.text("reason", 500);
        if (reason.find_first_not_of(" \t\r\n") == std::string::npos)
          fields.wrong("reason", "a reason is expected");
      },
      [&](store::Writing& tx, const store::AssignmentId& id, store::AuditStamp stamp) {
        stamp.reason = reason;
        return store::set_trial_invalid(tx, id, call.text("trial_id"), stamp);
      });
}

Result<http::Response> free_person(const Call& call) {
  return changed(
      call, [](core::Fields& fields) { fields.skip("reason"); },
      [&](store::Writing& tx, const store::AssignmentId& id,
          const store::AuditStamp& stamp) -> Result<void> {
        auto participant = TRY(store::participant_for(tx, id, call.text("account_id")));
        if (participant.empty()) return Error{Errc::not_found, "it is not assigned to this person"};
        TRY(store::release_slots(tx, id, participant, stamp));
        return {};
      });
}

RouteInfo route(std::string method, std::string tail, std::string id, std::string summary,
                std::string body, Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/assignments" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin, {Role::faculty, Scope::cohort}},
                .object = tail.empty() ? Object::none : Object::assignment,
                .parameters = {},
                .body = std::move(body),
                .body_limit_bytes = kMaxBody_bytes,
                .answer = "Assignment",
                .schemas = {},
                .handle = handle};
  if (!tail.empty()) out.parameters.push_back(path_text("id", "the assignment's"));
  return out;
}

std::vector<schema::Field> summary_fields() {
  using namespace schema;
  return {{"id", text("never changes")},
          {"title", text("for people")},
          {"state", one_of({"running", "paused"}, "paused: nothing is handed out")},
          {"due_utc_us", nullable(integer("us", "since 1970, UTC"))},
          {"release", one_of({"held", "released", "at_once"}, "may trainees see their results?")},
          {"done", integer("1", "trials that count; a trainee: the own")},
          {"planned", integer("1", "trials in all; a trainee: the own")},
          {"to_drill", integer("1",
                               "of planned: the channel is drilled first, and felt then; one "
                               "is done when both are in")},
          {"cohort_id", nullable(text("that it is of"))},
          {"cohort_name", text("empty without one")},
          {"made_utc_us", integer("us", "since 1970, UTC")},
          {"made_by", text("who")},
          {"ordering", optional(one_of({"fixed", "random", "balanced"}, "not told to trainees"))},
          {"repeats", optional(integer("1", "of each case; not told to trainees"))},
          {"people", optional(integer("1", "trainees it is assigned to"))}};
}

std::vector<NamedSchema> read_schemas() {
  using namespace schema;
  std::vector<Field> whole = summary_fields();
  whole.emplace_back("trainees", optional(array(ref("AssignedTrainee"), "by name")));
  whole.emplace_back("trials", optional(array(ref("AssignedTrialDone"),
                                              "that arrived; a trainee: the own, once released")));
  return {
      {"AssignmentSummary", object(summary_fields())},
      {"Assignments",
       object({{"assignments", array(ref("AssignmentSummary"), "due first, first")}})},
      {"AssignedTrainee", object({{"account_id", text("of the person")},
                                  {"name", text("of the account")},
                                  {"participant", text("the pseudonym in files")},
                                  {"done", integer("1", "trials that count")},
                                  {"planned", integer("1", "in all")}})},
      {"AssignedTrialDone",
       object(
           {{"trial_id", text("32 hexadecimal characters")},
            {"participant", text("a pseudonym")},
            {"number", integer("1", "of the person's trials, from 1")},
            {"tool", one_of({"probe", "burr"}, "burr: it drilled the channel, and has no answer")},
            {"state", one_of({"arriving", "counts", "invalid", "surplus"}, "does it count?")},
            {"reason", text("why it does not")},
            {"correct", nullable(truth("the answer against the truth"))},
            {"comments", integer("1", "that were made on it")},
            {"started_utc_us", nullable(integer("us", "since 1970, UTC"))}})},
      {"Assignment", object(whole)}};
}

std::vector<NamedSchema> plan_schemas() {
  using namespace schema;
  return {
      {"AssignedCase", object({{"case", optional(text("a published case's id"))},
                               {"scenario", optional(anything("tractus-scenario/1, or "
                                                              "{\"tuned\": \"hard\"}"))},
                               {"name", optional(text("what the trainee is shown; without, the "
                                                      "trial's number"))}})},
      {"NewAssignment",
       object({{"title", text("shown to trainees")},
               {"cases", optional(array(ref("AssignedCase"), "without a protocol"))},
               {"protocol", optional(text("a study's id: its scenarios, order and repeats"))},
               {"cohort", optional(text("its trainees, also those who join later"))},
               {"people", optional(array(text("an account's name"), "beside the cohort's"))},
               {"ordering", optional(one_of({"fixed", "random", "balanced"}, "random"))},
               {"repeats", optional(integer("1", "of each case, 1 to 20"))},
               {"seed", optional(integer("1", "of the orders; without, drawn"))},
               {"due_utc_us", optional(integer("us", "since 1970, UTC"))},
               {"release", optional(one_of({"held", "released", "at_once"}, "held"))},
               {"on_invalid", optional(one_of({"at_end", "at_once", "never"},
                                              "when a trial that does not count is repeated"))}})}};
}

RouteInfo adding_route() {
  RouteInfo out = route("POST", "", "addAssignment",
                        "Assign cases, or a study's protocol, to a cohort and to people",
                        "NewAssignment", add_assignment_route);
  out.body_limit_bytes = kMaxPlan_bytes;
  out.ends = {{"/cohort", Object::cohort, out.who},
              {"/people/*", Object::account, out.who, End::By::account_name},
              {"/cases/*/case", Object::published_case, {Role::admin, Role::faculty}},
              {"/protocol", Object::study, out.who}};
  out.schemas = plan_schemas();
  return out;
}

}  // namespace

std::vector<RouteInfo> assignments_routes() {
  using namespace schema;
  RouteInfo list =
      route("GET", "", "assignments", "All, those one leads, or one's own", "", list_assignments);
  list.who = {
      Role::admin, Role::director, {Role::faculty, Scope::cohort}, {Role::trainee, Scope::own}};
  list.answer = "Assignments";
  list.schemas = read_schemas();
  RouteInfo one =
      route("GET", "/{id}", "assignment", "One, with who has done what", "", one_assignment);
  one.who = list.who;
  RouteInfo release = route("POST", "/{id}/release", "releaseResults",
                            "May trainees see their results?", "Release", set_release);
  release.schemas = {
      {"Release", object({{"release", one_of({"held", "released", "at_once"}, "from now on")}})}};
  RouteInfo due = route("POST", "/{id}/due", "setDue", "Another date, or none", "Due", set_due);
  due.schemas = {{"Due", object({{"due_utc_us", nullable(integer("us", "since 1970, UTC"))}})}};
  RouteInfo person = route("POST", "/{id}/people", "assignPerson", "One more trainee",
                           "PersonNamed", assign_person);
  person.ends = {{"/name", Object::account, person.who, End::By::account_name}};
  RouteInfo invalid =
      route("POST", "/{id}/trials/{trial_id}/invalid", "markAssignedTrialInvalid",
            "A trial does not count: it stays, and is repeated as asked for", "Reason", invalidate);
  invalid.parameters.push_back(path_text("trial_id", "32 hexadecimal characters"));
  RouteInfo free =
      route("POST", "/{id}/people/{account_id}/free", "freeAssignedPerson",
            "What a station holds of this person's trials waits again", "Nothing", free_person);
  free.parameters.push_back(path_text("account_id", "the person's"));
  // Whoever it is assigned to, also who has left the cohort since.
  free.ends = {{"account_id", Object::account, {Role::admin, Role::faculty}}};
  free.schemas = {{"Nothing", object({{"reason", optional(text("why"))}})}};
  return {list, one, adding_route(), release, due, person, invalid, free};
}

}  // namespace api
}  // namespace tractus
