/// Curricula: ordered steps with criteria, in versions; given to cohorts; who is where.
#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/assignment_plan.hpp"
#include "server/api/studies/criteria_json.hpp"
#include "server/api/studies/curriculum_json.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxCurriculum_bytes = 4u << 20, kMaxGiven_bytes = 4096;
constexpr std::size_t kMaxCurriculumTitle = 150, kMaxStepReason = 500;

Result<Json> titled_cases(store::Reading& tx, const std::vector<std::string>& ids) {
  Json out = Json::array();
  for (const std::string& id : ids) {
    const auto of = TRY(store::case_of(tx, id));
    out.push_back({{"id", id}, {"title", of ? of->title : id}});
  }
  return out;
}

Result<Json> curriculum_version_json(store::Reading& tx, const store::CurriculumVersion& of) {
  const auto read =
      TRY(assessment::Curriculum::from_json(core::stored_json(of.definition), "curriculum"));
  Json steps = Json::array();
  for (const auto& step : read.steps) {
    const auto cases = TRY(titled_cases(tx, step.cases));
    steps.push_back({{"id", step.id},
                     {"name", step.name},
                     {"cases", cases},
                     {"repeats", step.repeats},
                     {"after", step.after},
                     {"requirements", requirements_json(step.criteria)}});
  }
  return Json{{"version", of.version}, {"title", of.title},     {"steps", steps},
              {"reason", of.reason},   {"made_by", of.made_by}, {"made_utc_us", of.made_utc_us}};
}

Result<Json> curricula_json(store::Reading& tx) {
  Json list = Json::array();
  const auto rows = TRY(store::all_curricula(tx));
  for (const store::CurriculumVersion& row : rows) {
    if (list.empty() || list.back()["id"] != row.id)
      list.push_back({{"id", row.id}, {"versions", Json::array()}});
    const auto version = TRY(curriculum_version_json(tx, row));
    list.back()["versions"].push_back(version);
  }
  return Json{{"curricula", list}};
}

Result<http::Response> list_curricula(const Call& call) {
  const auto json =
      TRY(call.backend.store.read([](store::Reading& tx) { return curricula_json(tx); }));
  return json_response(json);
}

/// The definition that was asked for, and the cases that its steps name.
struct AskedCurriculum {
  store::CurriculumVersion version;
  std::vector<AssignedCase> cases;  ///< each once
};

/// Steps with the ids of their cases in place of what names them.
Result<Json> steps_with_ids(const Json& steps, std::vector<AssignedCase>& cases) {
  Json out = steps;
  for (std::size_t s = 0; s < out.size(); ++s) {
    const bool named = out[s].is_object() && out[s].contains("cases");
    if (!named) return core::bad_input(fmt::format("body: /steps/{}/cases: cases are expected", s));
    auto read = assigned_cases_from(out[s]["cases"]);
    if (!read) return core::bad_input(fmt::format("body: /steps/{}{}", s, read.error().what));
    Json ids = Json::array();
    for (AssignedCase& one : *read) {
      ids.push_back(one.case_id);
      if (std::ranges::find(cases, one.case_id, &AssignedCase::case_id) == cases.end())
        cases.push_back(std::move(one));
    }
    out[s]["cases"] = ids;
  }
  return out;
}

Result<AskedCurriculum> curriculum_asked(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  AskedCurriculum out;
  out.version.id = fields.text_or("id", core::new_id().substr(0, 24), 64);
  out.version.title = fields.text("title", kMaxCurriculumTitle);
  if (out.version.title.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("title", "a title is expected");
  out.version.reason = fields.text_or("reason", "", kMaxStepReason);
  const Json* steps = fields.member("steps");
  if (steps && !steps->is_array()) fields.wrong("steps", "an array of steps is expected");
  TRY(fields.done());
  const auto with_ids = TRY(steps_with_ids(*steps, out.cases));
  const auto read = TRY(assessment::Curriculum::from_json(
      {{"format", "tractus-curriculum/1"}, {"steps", with_ids}}, "body: "));
  out.version.definition = read.to_json().dump();
  out.version.made_by = call.caller.name;
  out.version.made_utc_us = call.backend.now_utc_us();
  return out;
}

Result<http::Response> add_curriculum_route(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  const auto asked = TRY(curriculum_asked(call));
  const auto parts = TRY(put_scenarios(call.backend, asked.cases));
  const auto answer = TRY(call.backend.store.write([&](store::Writing& tx) -> Result<Json> {
    const store::AuditStamp stamp{call.caller.name, asked.version.made_utc_us};
    const auto known = TRY(store::curriculum_versions(tx, asked.version.id));
    if (known.empty() && json.contains("id")) return absent("curriculum", asked.version.id);
    TRY(note_cases(tx, asked.cases, parts, stamp));
    TRY(store::add_curriculum(tx, asked.version));
    return curricula_json(tx);
  }));
  return json_response(answer, 201);
}

/// The assignment that hands a step out.
store::Assignment step_assignment(const Call& call, const store::CurriculumVersion& of,
                                  const assessment::CurriculumStep& step) {
  store::Assignment out;
  out.study.id = "a-" + core::new_id().substr(0, 24);
  out.study.title = of.title + ": " + step.name;
  out.study.ordering = store::CaseOrder::random;
  out.study.repeats = step.repeats;
  out.study.on_invalid = store::Repetition::at_end;
  for (const std::byte b : core::random_bytes(4))
    out.study.seed = out.study.seed * 256 + std::to_integer<long>(b);
  out.made_by_id = call.caller.id;
  return out;
}

Result<void> hand_out(store::Writing& tx, const store::Assignment& assignment,
                      const store::CurriculumVersion& of, const assessment::CurriculumStep& step,
                      const std::vector<store::Account>& people, const store::AuditStamp& stamp) {
  const auto id = TRY(store::add_assignment(tx, assignment, step.cases, stamp));
  for (const store::Account& person : people) TRY(assign_to(tx, id, person, stamp));
  return store::add_curriculum_assignment(tx, {id.text(), of.id, of.version, step.id});
}

Result<store::CurriculumVersion> version_of_call(store::Reading& tx, const Call& call,
                                                 std::optional<std::int64_t> version) {
  const auto known = TRY(store::curriculum_versions(tx, call.text("id")));
  if (known.empty()) return absent("curriculum", call.text("id"));
  return version ? known[std::size_t(*version - 1)] : known.back();
}

Result<void> check_not_given(store::Reading& tx, const store::CurriculumVersion& of,
                             const std::string& cohort) {
  const auto rows = TRY(store::curriculum_assignments(tx, ""));
  for (const store::CurriculumAssignment& row : rows) {
    if (row.curriculum_id != of.id || row.version != of.version) continue;
    const auto id = TRY(store::find_assignment(tx, row.study_id));
    const auto there = TRY(store::assignment_of(tx, id));
    if (there.cohort_id == cohort)
      return Error{Errc::conflict, "this cohort has this version of the curriculum already"};
  }
  return {};
}

Result<std::vector<store::Account>> trainees_of(store::Reading& tx, const std::string& cohort) {
  const auto known = TRY(store::cohort_of(tx, cohort));
  if (!known) return absent("cohort", cohort);
  std::vector<store::Account> out;
  const auto people = TRY(store::people_of(tx, cohort));
  for (const auto& person : people) {
    if (person.part != store::CohortPart::trainee) continue;
    auto account = TRY(store::account_of(tx, person.account_id));
    out.push_back(std::move(*account));
  }
  return out;
}

Result<http::Response> give_to_cohort(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string cohort = fields.text("cohort", 64);
  const auto release = fields.word_or("release", store::Release::held);
  std::optional<std::int64_t> due;
  if (fields.has("due_utc_us")) due = due_field(fields, call.backend.now_utc_us());
  TRY(fields.done());
  const auto answer = TRY(call.backend.store.write([&](store::Writing& tx) -> Result<Json> {
    const auto of = TRY(version_of_call(tx, call, {}));
    const auto read =
        TRY(assessment::Curriculum::from_json(core::stored_json(of.definition), "curriculum"));
    const auto people = TRY(trainees_of(tx, cohort));
    TRY(check_not_given(tx, of, cohort));
    store::AuditStamp stamp{call.caller.name, call.backend.now_utc_us()};
    for (const auto& step : read.steps) {
      store::Assignment assignment = step_assignment(call, of, step);
      assignment.cohort_id = cohort;
      assignment.release = release;
      assignment.due_utc_us = due;
      TRY(hand_out(tx, assignment, of, step, people, stamp));
      ++stamp.at_utc_us;  // stations offer what was made first, first
    }
    return curriculum_people_json(tx, call, "", of.id);
  }));
  return json_response(answer, 201);
}

/// The step's cases once more for one person, who has done all planned trials without passing.
Result<http::Response> step_again(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string step_id = fields.text("step", 32);
  TRY(fields.done());
  const auto answer = TRY(call.backend.store.write([&](store::Writing& tx) -> Result<Json> {
    const auto people = TRY(people_in_curricula(tx, call.text("account_id"), call.text("id")));
    if (people.empty()) return Error{Errc::not_found, "the person is not in this curriculum"};
    const CurriculumPerson& person = people.back();
    const auto step =
        std::ranges::find(person.curriculum.steps, step_id, &assessment::CurriculumStep::id);
    if (step == person.curriculum.steps.end())
      return core::bad_input("body: /step: the curriculum has no step with this id");
    const auto of = TRY(version_of_call(tx, call, person.version));
    const auto account = TRY(store::account_of(tx, person.account_id));
    store::Assignment assignment = step_assignment(call, of, *step);
    const auto first = TRY(store::find_assignment(
        tx, person.steps[std::size_t(step - person.curriculum.steps.begin())].study_ids.front()));
    const auto before = TRY(store::assignment_of(tx, first));
    assignment.release = before.release;
    assignment.study.title += " (again)";
    const store::AuditStamp stamp{call.caller.name, call.backend.now_utc_us()};
    TRY(hand_out(tx, assignment, of, *step, {*account}, stamp));
    return curriculum_people_json(tx, call, "", of.id);
  }));
  return json_response(answer, 201);
}

Result<http::Response> progress_of_curriculum(const Call& call) {
  const auto json = TRY(call.backend.store.read([&](store::Reading& tx) -> Result<Json> {
    TRY(version_of_call(tx, call, {}));
    return curriculum_people_json(tx, call, "", call.text("id"));
  }));
  return json_response(json);
}

Result<http::Response> curricula_of_account(const Call& call) {
  const auto json = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return curriculum_people_json(tx, call, call.text("id"), ""); }));
  return json_response(json);
}

std::vector<Grant> curriculum_teachers() {
  return {Role::admin, Role::director, {Role::faculty, Scope::cohort}};
}

RouteInfo curriculum_route(std::string method, std::string path, std::string id,
                           std::string summary, std::string answer,
                           Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/" + path,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = curriculum_teachers(),
                .parameters = {},
                .body = "",
                .answer = std::move(answer),
                .schemas = {},
                .handle = handle};
  if (path.find("curricula/{id}") != std::string::npos)
    out.parameters.push_back(path_text("id", "Id of the curriculum"));
  return out;
}

std::vector<NamedSchema> curricula_schemas() {
  using namespace schema;
  return {{"CurriculumCase",
           object({{"id", text("Id of the case")}, {"title", text("Title of the case")}})},
          {"CurriculumStep",
           object({{"id", text("Id of the step, which the other steps name")},
                   {"name", text("Name of the step")},
                   {"cases", array(ref("CurriculumCase"), "Cases of the step")},
                   {"repeats", integer("1", "Number of planned trials of each case")},
                   {"after", array(text("Id of an earlier step"), "Steps to be passed before")},
                   {"requirements", array(ref("Requirement"), "What passing the step is")}})},
          {"CurriculumVersion",
           object({{"version", integer("1", "Number of the version, counted from 1")},
                   {"title", text("Title of the curriculum")},
                   {"steps", array(ref("CurriculumStep"), "Steps, in order")},
                   {"reason", text("Reason of the change; empty if none was given")},
                   {"made_by", text("Name of the account that made it")},
                   {"made_utc_us", integer("us",
                                           "Time of creation, in microseconds since 1970-01-01 "
                                           "UTC")}})},
          {"Curriculum",
           object({{"id", text("Id of the curriculum, which never changes")},
                   {"versions", array(ref("CurriculumVersion"), "Versions, oldest first")}})},
          {"Curricula", object({{"curricula", array(ref("Curriculum"), "All curricula")}})}};
}

RouteInfo making_route() {
  using namespace schema;
  RouteInfo out = curriculum_route("POST", "curricula", "addCurriculum",
                                   "Make a curriculum, or a new version of one; who has begun "
                                   "stays with the version they began with",
                                   "Curricula", add_curriculum_route);
  out.who = {Role::admin, Role::director, Role::faculty};
  out.body = "NewCurriculum";
  out.body_limit_bytes = kMaxCurriculum_bytes;
  out.ends = {{"/steps/*/cases/*/case", Object::published_case, out.who}};
  out.schemas = {
      {"NewCurriculumStep",
       object(
           {{"id", text("Id of the step, at most 32 bytes")},
            {"name", text("Name of the step, shown to trainees")},
            {"cases", array(ref("AssignedCase"), "Cases of the step")},
            {"repeats", optional(integer("1", "Planned trials of each case, 1 to 20; default 1"))},
            {"after", array(text("Id of an earlier step"), "Steps to be passed before")},
            {"criteria", ref("CriteriaFile")}})},
      {"NewCurriculum",
       object({{"id", optional(text("Id of the curriculum that gets a new version; if it is "
                                    "missing, a new curriculum is made"))},
               {"title", text("Title of the curriculum, at most 150 bytes")},
               {"reason", optional(text("Reason of the change, at most 500 bytes"))},
               {"steps", array(ref("NewCurriculumStep"), "Steps, in order, 1 to 20")}})}};
  return out;
}

RouteInfo giving_route() {
  using namespace schema;
  RouteInfo out = curriculum_route("POST", "curricula/{id}/cohorts", "giveCurriculum",
                                   "Give the newest version of a curriculum to a cohort: one "
                                   "assignment for each step, which stations offer in order",
                                   "CurriculumPeople", give_to_cohort);
  out.body = "CurriculumGiven";
  out.body_limit_bytes = kMaxGiven_bytes;
  out.ends = {{"/cohort", Object::cohort, out.who}};
  out.schemas = {
      {"CurriculumGiven",
       object({{"cohort", text("Id of the cohort; also those who join later get the curriculum")},
               {"release",
                optional(one_of<store::Release>("When trainees see their results; default held"))},
               {"due_utc_us", optional(integer("us",
                                               "Due time of every step, in microseconds "
                                               "since 1970-01-01 UTC, not in the past"))}})}};
  return out;
}

}  // namespace

std::vector<RouteInfo> curricula_routes() {
  using namespace schema;
  RouteInfo list =
      curriculum_route("GET", "curricula", "curricula", "List the curricula with all versions",
                       "Curricula", list_curricula);
  list.who = {Role::admin, Role::director, Role::faculty};
  list.schemas = curricula_schemas();
  RouteInfo progress = curriculum_route("GET", "curricula/{id}/progress", "curriculumProgress",
                                        "Read where everybody in a curriculum stands, of the "
                                        "people whom the caller may see",
                                        "CurriculumPeople", progress_of_curriculum);
  progress.schemas = curriculum_people_schemas();
  RouteInfo again = curriculum_route(
      "POST", "curricula/{id}/people/{account_id}/again", "repeatCurriculumStep",
      "Assign a step of a curriculum once more to one person", "CurriculumPeople", step_again);
  again.parameters.push_back(path_text("account_id", "Id of the person's account"));
  again.body = "StepNamed";
  again.body_limit_bytes = kMaxGiven_bytes;
  again.ends = {{"account_id", Object::account, again.who}};
  again.schemas = {{"StepNamed", object({{"step", text("Id of the step")}})}};
  RouteInfo own = curriculum_route("GET", "accounts/{id}/curricula", "curriculaOfAccount",
                                   "Read where one person stands in their curricula, and what a "
                                   "certificate of it rests on",
                                   "CurriculumPeople", curricula_of_account);
  own.who.push_back({Role::trainee, Scope::own});
  own.object = Object::account;
  own.parameters = {path_text("id", "Id of the account")};
  return {list, making_route(), giving_route(), progress, again, own};
}

}  // namespace api
}  // namespace tractus
