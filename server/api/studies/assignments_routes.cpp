/// Assignments: what trainees are to do, until when, and when they may see how they did.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/try.hpp"
#include "db/store/operations/notifications.hpp"
#include "db/store/studies/assignments.hpp"
#include "db/store/trials/debriefs.hpp"
#include "db/store/trials/ratings.hpp"
#include "server/api/backend.hpp"
#include "server/api/finding/list_request.hpp"
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
using store::Release;

constexpr std::uint64_t kMaxAssignmentPlan_bytes = 4u << 20, kMaxAssignment_bytes = 4096;
constexpr std::size_t kMaxReleased = 200;

/// The answer to a trainee contains neither the order of the cases nor data of other trainees.
Json assignment_json(const store::Assignment& a, Scope of) {
  Json out{{"id", a.study.id},
           {"title", a.study.title},
           {"state", name(a.study.state)},
           {"due_utc_us", core::or_null(a.due_utc_us)},
           {"release", name(a.release)},
           {"done", a.done},
           {"planned", a.planned},
           {"to_drill", a.to_drill},
           {"cohort_id", a.cohort_id ? Json(*a.cohort_id) : Json()},
           {"cohort_name", a.cohort_name},
           {"made_utc_us", a.study.made_utc_us},
           {"made_by", a.study.made_by}};
  if (of == Scope::own) return out;
  out["ordering"] = name(a.study.ordering);
  out["repeats"] = a.study.repeats;
  out["people"] = a.people;
  return out;
}

store::AssignmentFilter whose_assignments(const Call& call) {
  store::AssignmentFilter out;
  if (call.of == Scope::cohort) out.led_by = call.caller.id;
  if (call.of == Scope::own) out.done_by = call.caller.id;
  return out;
}

Result<http::Response> list_assignments(const Call& call) {
  const auto request = TRY(list_request(call, store::assignment_list()));
  auto found = TRY(call.backend.store.read([&](store::Reading& tx) {
    return store::find_assignments(tx, request, whose_assignments(call));
  }));
  Json list = Json::array();
  for (const auto& one : found.assignments) list.push_back(assignment_json(one, call.of));
  return json_response(with_page({{"assignments", list}}, found.page));
}

/// @param whose  this participant's alone; empty: everybody's.
/// @param but    trials that are left out
Result<Json> trials_json(store::Reading& tx, const store::AssignmentId& id,
                         const std::string& whose, const std::set<std::string>& but = {}) {
  auto slots = TRY(store::study_slots(tx, id));
  std::map<std::string, const store::Slot*> places;
  for (const auto& slot : slots) places[slot.id] = &slot;
  auto trials = TRY(store::study_trials(tx, id));
  Json out = Json::array();
  for (const auto& trial : trials) {
    const auto place = places.find(trial.slot_id);
    if (place == places.end() || (!whose.empty() && place->second->participant != whose)) continue;
    if (but.contains(trial.trial_id)) continue;
    auto comments = TRY(store::comments_of(tx, trial.trial_id));
    out.push_back({{"trial_id", trial.trial_id},
                   {"participant", place->second->participant},
                   {"number", place->second->position + 1},
                   {"tool", name(trial.tool)},
                   {"state", name(trial.state)},
                   {"reason", trial.reason},
                   {"correct", trial.correct ? Json(*trial.correct) : Json()},
                   {"comments", comments.size()},
                   {"started_utc_us", core::or_null(trial.started_utc_us)}});
  }
  return out;
}

/// The trainee's own trials of the assignment, once the results are released.
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
    if (found.release == Release::held) return out;
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
  // The table names the person of each trial: one that is rated blind comes back with its name.
  const auto hidden = TRY(store::trials_with_hidden_name(tx));
  auto trials = TRY(trials_json(tx, id, "", hidden));
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
  auto plan = TRY(AssignmentPlan::from_json(json, call.backend.now_utc_us()));
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

/// Trainees are told of the first release.
Result<void> release_results(store::Writing& tx, const store::AssignmentId& id, Release release,
                             const store::AuditStamp& stamp) {
  TRY(store::set_release(tx, id, release, stamp));
  if (release != Release::released) return {};
  return store::note_event(tx, {.id = {},
                                .kind = store::NotificationKind::released,
                                .key = "released/" + id.text(),
                                .subject = id.text(),
                                .at_utc_us = stamp.at_utc_us});
}

Result<http::Response> set_release(const Call& call) {
  Release release = Release::held;
  return changed(
      call, [&](core::Fields& fields) { release = fields.word<Release>("release"); },
      [&](store::Writing& tx, const store::AssignmentId& id, const store::AuditStamp& stamp) {
        return release_results(tx, id, release, stamp);
      });
}

/// All or none. Access to each was checked (access.hpp).
Result<http::Response> release_many(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const auto release = fields.word<Release>("release");
  const Json* ids = fields.member("assignments");
  const bool fits = ids && ids->is_array() && !ids->empty() && ids->size() <= kMaxReleased &&
                    std::ranges::all_of(*ids, [](const Json& one) { return one.is_string(); });
  if (ids && !fits)
    fields.wrong("assignments", fmt::format("an array of 1 to {} ids is expected", kMaxReleased));
  TRY(fields.done());
  Json released = Json::array();
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    const store::AuditStamp stamp{call.caller.name, call.backend.now_utc_us()};
    for (const Json& one : *ids) {
      const auto id = TRY(store::find_assignment(tx, one.get<std::string>()));
      TRY(release_results(tx, id, release, stamp));
      const auto now = TRY(store::assignment_of(tx, id));
      released.push_back(assignment_json(now, call.of));
    }
    return {};
  }));
  return json_response({{"assignments", released}});
}

Result<http::Response> set_due(const Call& call) {
  std::optional<std::int64_t> due;
  return changed(
      call,
      [&](core::Fields& fields) {
        const Json* given = fields.member("due_utc_us");
        if (given && !given->is_null()) due = due_field(fields, call.backend.now_utc_us());
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
          return Error{Errc::not_found, "body: /name: there is no account with this name"};
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
        if (participant.empty())
          return Error{Errc::not_found, "the assignment does not include this person"};
        TRY(store::release_slots(tx, id, participant, stamp));
        return {};
      });
}

RouteInfo assignment_route(std::string method, std::string tail, std::string id,
                           std::string summary, std::string body,
                           Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/assignments" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin, {Role::faculty, Scope::cohort}},
                .object = tail.empty() ? Object::none : Object::assignment,
                .parameters = {},
                .body = std::move(body),
                .body_limit_bytes = kMaxAssignment_bytes,
                .answer = "Assignment",
                .schemas = {},
                .handle = handle};
  if (!tail.empty()) out.parameters.push_back(path_text("id", "Id of the assignment"));
  return out;
}

std::vector<schema::Field> assignment_fields() {
  using namespace schema;
  return {
      {"id", text("Id of the assignment, which never changes")},
      {"title", text("Title of the assignment")},
      {"state", one_of<store::StudyState>(
                    "State of the assignment; paused: stations receive no trials of it")},
      {"due_utc_us",
       nullable(
           integer("us", "Due time, in microseconds since 1970-01-01 UTC; null if there is none"))},
      {"release",
       one_of<Release>("When trainees see their results: held = not yet, released = now, at_once "
                       "= as soon as a trial is uploaded")},
      {"done", integer("1", "Number of trials that count; for a trainee only the own trials")},
      {"planned", integer("1", "Number of planned trials; for a trainee only the own trials")},
      {"to_drill",
       integer("1",
               "Number of the planned trials in which the trainee first drills the channel, then "
               "palpates it; such a trial is done when both recordings are uploaded")},
      {"cohort_id", nullable(text("Id of the cohort; null if the assignment has none"))},
      {"cohort_name", text("Name of the cohort; empty if the assignment has none")},
      {"made_utc_us", integer("us", "Time of creation, in microseconds since 1970-01-01 UTC")},
      {"made_by", text("Name of the account that created the assignment")},
      {"ordering", optional(one_of<store::CaseOrder>(
                       "Order of the cases; missing in the answer to a trainee"))},
      {"repeats", optional(integer(
                      "1", "Number of repeats of each case; missing in the answer to a trainee"))},
      {"people",
       optional(integer(
           "1", "Number of trainees in the assignment; missing in the answer to a trainee"))}};
}

std::vector<NamedSchema> read_schemas() {
  using namespace schema;
  std::vector<Field> whole = assignment_fields();
  whole.emplace_back(
      "trainees",
      optional(
          array(ref("AssignedTrainee"),
                "Trainees of the assignment, sorted by name; missing in the answer to a trainee")));
  whole.emplace_back("trials", optional(array(ref("AssignedTrialDone"),
                                              "Uploaded trials; for a trainee only the own trials, "
                                              "and only after the release of the results")));
  std::vector<Field> list = page_fields();
  list.emplace_back("assignments",
                    array(ref("AssignmentSummary"), "Assignments in the order asked for"));
  return {
      {"AssignmentSummary", object(assignment_fields())},
      {"Assignments", object(list)},
      {"AssignedTrainee",
       object({{"account_id", text("Id of the person's account")},
               {"name", text("Name of the account")},
               {"participant", text("Pseudonym of the person in trial files")},
               {"done", integer("1", "Number of the person's trials that count")},
               {"planned", integer("1", "Number of the person's planned trials")}})},
      {"AssignedTrialDone",
       object({{"trial_id", text("Id of the trial, 32 hexadecimal characters")},
               {"participant", text("Pseudonym of the person")},
               {"number",
                integer("1", "Number of the trial among the person's trials, counted from 1")},
               {"tool",
                one_of<trial::Tool>("Tool; burr: the trial drilled the channel and has no answer")},
               {"state",
                one_of<store::StudyTrialState>(
                    "arriving: the upload is not complete; counts: the trial counts; invalid: it "
                    "was marked invalid; surplus: its place in the order already had a trial")},
               {"reason", text("Reason why the trial does not count; empty if it counts")},
               {"correct", nullable(truth("True if the answer agrees with the truth; null if the "
                                          "answer or the truth is missing"))},
               {"comments", integer("1", "Number of comments on the trial")},
               {"started_utc_us",
                nullable(integer("us",
                                 "Start of the trial, in microseconds since 1970-01-01 UTC; null "
                                 "until the upload is complete"))}})},
      {"Assignment", object(whole)}};
}

std::vector<NamedSchema> assignment_schemas() {
  using namespace schema;
  return {
      {"AssignedCase",
       object({{"case", optional(text("Id of a published case; give either a case or a scenario"))},
               {"scenario", optional(ref("ScenarioOrTuned"))},
               {"name",
                optional(text(
                    "Name that the trainee sees; if it is missing, the number of the trial"))}})},
      {"NewAssignment",
       object(
           {{"title", text("Title of the assignment, shown to trainees")},
            {"cases", optional(array(ref("AssignedCase"),
                                     "Cases of the assignment; give either cases or a protocol"))},
            {"protocol",
             optional(
                 text("Id of a study whose scenarios, order and repeats the assignment uses"))},
            {"cohort", optional(text("Id of a cohort; the assignment then includes its trainees, "
                                     "also those who join later"))},
            {"people", optional(array(text("Name of an account"),
                                      "More trainees, in addition to those of the cohort"))},
            {"ordering", optional(one_of<store::CaseOrder>(
                             "Order of the cases: fixed as listed, random, or balanced "
                             "by Williams squares; default random"))},
            {"repeats",
             optional(integer("1", "Number of repeats of each case, 1 to 20; default 1"))},
            {"seed",
             optional(integer(
                 "1", "Seed of the random orders; if it is missing, the server draws one"))},
            {"due_utc_us", optional(integer("us",
                                            "Due time, in microseconds since 1970-01-01 UTC, not "
                                            "in the past; if it is missing, there is none"))},
            {"release", optional(one_of<Release>(
                            "When trainees see their results: held (default) = not yet, released "
                            "= now, at_once = as soon as a trial is uploaded"))},
            {"on_invalid", optional(one_of<store::Repetition>(
                               "When an invalid trial is repeated; default at_end"))}})}};
}

RouteInfo adding_route() {
  RouteInfo out = assignment_route(
      "POST", "", "addAssignment",
      "Assign cases, or the protocol of a study, to a cohort and to single trainees",
      "NewAssignment", add_assignment_route);
  out.body_limit_bytes = kMaxAssignmentPlan_bytes;
  out.ends = {{"/cohort", Object::cohort, out.who},
              {"/people/*", Object::account, out.who, End::By::account_name},
              {"/cases/*/case", Object::published_case, {Role::admin, Role::faculty}},
              {"/protocol", Object::study, out.who}};
  out.schemas = assignment_schemas();
  return out;
}

RouteInfo releasing_route() {
  using namespace schema;
  RouteInfo out = assignment_route("POST", "", "releaseManyResults",
                                   "Set when trainees see their results of many assignments, all "
                                   "or none",
                                   "Releases", release_many);
  out.path = "/api/v1/assignment-releases";
  out.body_limit_bytes = 16384;
  out.answer = "ReleasedAssignments";
  out.ends = {{"/assignments/*", Object::assignment, out.who}};
  out.schemas = {
      {"Releases",
       object({{"assignments", array(text("Id of an assignment"), "Assignments, at most 200")},
               {"release", one_of<Release>("When trainees see their results")}})},
      {"ReleasedAssignments", object({{"assignments", array(ref("AssignmentSummary"),
                                                            "The assignments of the request")}})}};
  return out;
}

}  // namespace

std::vector<RouteInfo> assignments_routes() {
  using namespace schema;
  RouteInfo list = assignment_route(
      "GET", "", "assignments",
      "List assignments: all, those of cohorts that the caller leads, or the caller's own", "",
      list_assignments);
  list.who = {
      Role::admin, Role::director, {Role::faculty, Scope::cohort}, {Role::trainee, Scope::own}};
  list.answer = "Assignments";
  list.parameters = list_parameters(store::assignment_list(), "title, cohort or creator");
  list.schemas = read_schemas();
  RouteInfo one = assignment_route("GET", "/{id}", "assignment",
                                   "Read one assignment with its trainees and uploaded trials", "",
                                   one_assignment);
  one.who = list.who;
  RouteInfo release = assignment_route("POST", "/{id}/release", "releaseResults",
                                       "Set when trainees see their results of an assignment",
                                       "Release", set_release);
  release.schemas = {
      {"Release",
       object({{"release",
                one_of<Release>("When trainees see their results: held = not yet, released = "
                                "now, at_once = as soon as a trial is uploaded")}})}};
  RouteInfo due =
      assignment_route("POST", "/{id}/due", "setDue",
                       "Change or remove the due time of an assignment", "Due", set_due);
  due.schemas = {
      {"Due",
       object({{"due_utc_us",
                nullable(integer(
                    "us",
                    "New due time, in microseconds since 1970-01-01 UTC; null: no due time"))}})}};
  RouteInfo person =
      assignment_route("POST", "/{id}/people", "assignPerson", "Add a trainee to an assignment",
                       "PersonNamed", assign_person);
  person.ends = {{"/name", Object::account, person.who, End::By::account_name}};
  RouteInfo invalid =
      assignment_route("POST", "/{id}/trials/{trial_id}/invalid", "markAssignedTrialInvalid",
                       "Mark a trial invalid, so that it does not count; the server keeps the "
                       "trial and repeats it as the assignment states",
                       "Reason", invalidate);
  invalid.parameters.push_back(path_text("trial_id", "Id of the trial, 32 hexadecimal characters"));
  RouteInfo free =
      assignment_route("POST", "/{id}/people/{account_id}/free", "freeAssignedPerson",
                       "Release the trials of a person that a station has taken, so that any "
                       "station can take them again",
                       "Nothing", free_person);
  free.parameters.push_back(path_text("account_id", "Id of the person's account"));
  // Any person of the assignment, including people who have left the cohort since.
  free.ends = {{"account_id", Object::account, {Role::admin, Role::faculty}}};
  free.schemas = {
      {"Nothing", object({{"reason", optional(text("Reason; the server does not store it"))}})}};
  return {list, one, adding_route(), release, releasing_route(), due, person, invalid, free};
}

}  // namespace api
}  // namespace tractus
