#include "server/api/studies/assignment_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/people/invitations.hpp"
#include "server/api/backend.hpp"
#include "server/api/studies/study_plan.hpp"
#include "study/order.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::size_t kMaxCases = 64, kMaxPeople = 500, kMaxPlanTitle = 200, kMaxText = 128;
constexpr long kMaxAssignedRepeats = 20, kMaxAssignedTime_us = 9'000'000'000'000'000,
               kMaxAssignedSeed = 1L << 53;

Result<AssignedCase> case_from(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  AssignedCase out;
  out.name = fields.text_or("name", "", kMaxText);
  out.case_id = fields.text_or("case", "", 64);
  const Json* scenario = fields.member("scenario", false);
  if (out.case_id.empty() == (scenario == nullptr))
    fields.wrong("case", "either the id of a case or a scenario is expected");
  TRY(fields.done());
  if (!scenario) return out;
  auto read = TRY(scenario_from(*scenario, where + "/scenario"));
  out.case_id = read.id();
  out.scenario = std::move(read);
  return out;
}

Result<std::vector<std::string>> names_from(const Json* json) {
  std::vector<std::string> out;
  if (!json) return out;
  const bool fits = json->is_array() && json->size() <= kMaxPeople &&
                    std::ranges::all_of(*json, [](const Json& one) { return one.is_string(); });
  if (!fits) return Error{Errc::bad_input, "/people: an array of names is expected"};
  for (const Json& one : *json) out.push_back(one.get<std::string>().substr(0, kMaxText));
  return out;
}

store::Assignment assignment_from(core::Fields& fields, std::int64_t now_utc_us) {
  store::Assignment out;
  out.study.id = "a-" + core::new_id().substr(0, 24);
  out.study.title = fields.text("title", kMaxPlanTitle);
  out.study.ordering = fields.word_or("ordering", store::CaseOrder::random);
  out.study.repeats = fields.integer_or("repeats", 1, 1, kMaxAssignedRepeats);
  out.study.on_invalid = fields.word_or("on_invalid", store::Repetition::at_end);
  long drawn = 0;
  for (const std::byte b : core::random_bytes(4)) drawn = drawn * 256 + std::to_integer<long>(b);
  out.study.seed = fields.integer_or("seed", drawn, 0, kMaxAssignedSeed);
  if (fields.has("due_utc_us")) out.due_utc_us = due_field(fields, now_utc_us);
  out.release = fields.word_or("release", store::Release::held);
  if (fields.has("cohort")) out.cohort_id = fields.text("cohort", 64);
  return out;
}

Error nothing_named(const char* what, const std::string& name) {
  return {Errc::not_found, fmt::format("{}: nothing has the name {}", what, name.substr(0, 64))};
}

/// The cohort's trainees and the people named.
Result<std::vector<store::Account>> people_meant(store::Reading& tx, const AssignmentPlan& plan) {
  std::vector<store::Account> out;
  if (plan.assignment.cohort_id) {
    const std::string& cohort = *plan.assignment.cohort_id;
    auto there = TRY(store::cohort_of(tx, cohort));
    if (!there) return nothing_named("/cohort", cohort);
    auto people = TRY(store::people_of(tx, cohort));
    for (const auto& person : people) {
      if (person.part != store::CohortPart::trainee) continue;
      auto account = TRY(store::account_of(tx, person.account_id));
      out.push_back(std::move(*account));
    }
  }
  for (const std::string& name : plan.people) {
    auto account = TRY(store::account_named(tx, name));
    if (!account) return nothing_named("/people", name);
    if (std::ranges::find(out, account->id, &store::Account::id) == out.end())
      out.push_back(std::move(*account));
  }
  return out;
}

/// Scenarios, order and repeats of the study that is the protocol.
Result<std::vector<std::string>> protocol_cases(store::Reading& tx, const std::string& protocol,
                                                store::Assignment& into) {
  auto id = TRY(store::find_study(tx, protocol));
  auto study = TRY(store::study_of(tx, id));
  auto scenarios = TRY(store::study_scenarios(tx, id));
  into.study.ordering = study.ordering;
  into.study.repeats = study.repeats;
  into.study.on_invalid = study.on_invalid;
  std::vector<std::string> out;
  for (const auto& scenario : scenarios) out.push_back(scenario.case_id);
  return out;
}

Result<void> make(store::Writing& tx, const Call& call, const AssignmentPlan& plan,
                  const std::vector<store::CasePart>& parts) {
  const store::AuditStamp stamp{call.caller.name, call.backend.now_utc_us()};
  store::Assignment assignment = plan.assignment;
  assignment.made_by_id = call.caller.id;
  auto cases = TRY(plan.protocol.empty() ? note_cases(tx, plan.cases, parts, stamp)
                                         : protocol_cases(tx, plan.protocol, assignment));
  auto people = TRY(people_meant(tx, plan));
  auto id = TRY(store::add_assignment(tx, assignment, cases, stamp));
  for (const AssignedCase& one : plan.cases)
    if (!one.name.empty()) TRY(store::set_assigned_name(tx, id, one.case_id, one.name));
  for (const store::Account& person : people) TRY(assign_to(tx, id, person, stamp));
  return {};
}

}  // namespace

std::int64_t due_field(core::Fields& fields, std::int64_t now_utc_us) {
  const std::int64_t due = fields.integer("due_utc_us", 0, kMaxAssignedTime_us);
  if (due < now_utc_us) fields.wrong("due_utc_us", "this time is in the past: choose a later one");
  return due;
}

Result<std::vector<AssignedCase>> assigned_cases_from(const Json& json) {
  std::vector<AssignedCase> out;
  if (!json.is_array() || json.empty() || json.size() > kMaxCases)
    return Error{Errc::bad_input,
                 fmt::format("/cases: an array of 1 to {} is expected", kMaxCases)};
  std::set<std::string> ids;
  for (const Json& one : json) {
    const std::string where = fmt::format("/cases/{}", out.size());
    auto read = TRY(case_from(one, where));
    if (!ids.insert(read.case_id).second)
      return Error{Errc::bad_input, where + ": this case occurs twice; use repeats instead"};
    out.push_back(std::move(read));
  }
  return out;
}

Result<std::vector<std::string>> note_cases(store::Writing& tx,
                                            const std::vector<AssignedCase>& cases,
                                            const std::vector<store::CasePart>& parts,
                                            const store::AuditStamp& stamp) {
  std::vector<std::string> out;
  std::size_t part = 0;
  for (const AssignedCase& one : cases) {
    if (one.scenario) {
      const store::CaseSummary summary{
          one.case_id, one.scenario->name, one.scenario->origin.who, stamp.at_utc_us,
          0,           trial::Rig::probing};
      TRY(store::add_case(tx, summary, {parts[part++]}, stamp.at_utc_us));
    } else {
      auto known = TRY(store::case_of(tx, one.case_id));
      if (!known) return nothing_named("/cases", one.case_id);
      if (known->retired) return Error{Errc::conflict, "/cases: " + known->title + " is retired"};
    }
    out.push_back(one.case_id);
  }
  return out;
}

Result<std::vector<store::CasePart>> put_scenarios(Backend& backend,
                                                   const std::vector<AssignedCase>& cases) {
  std::vector<store::CasePart> out;
  for (const AssignedCase& one : cases) {
    if (!one.scenario) continue;
    auto part = TRY(put_scenario(backend, *one.scenario));
    out.push_back(std::move(part));
  }
  return out;
}

Result<AssignmentPlan> AssignmentPlan::from_json(const Json& json, std::int64_t now_utc_us) {
  core::Fields fields(json, "");
  AssignmentPlan out;
  out.assignment = assignment_from(fields, now_utc_us);
  out.protocol = fields.text_or("protocol", "", 32);
  const Json* cases = fields.member("cases", false);
  const Json* people = fields.member("people", false);
  if (out.protocol.empty() == (cases == nullptr))
    fields.wrong("cases", "either cases or a protocol is expected");
  TRY(fields.done());
  if (cases) {
    auto read = TRY(assigned_cases_from(*cases));
    out.cases = std::move(read);
  }
  auto names = TRY(names_from(people));
  out.people = std::move(names);
  return out;
}

Result<std::string> make_assignment(const Call& call, const AssignmentPlan& plan) {
  const auto parts = TRY(put_scenarios(call.backend, plan.cases));
  TRY(call.backend.store.write([&](store::Writing& tx) { return make(tx, call, plan, parts); }));
  return plan.assignment.study.id;
}

Result<void> assign_to(store::Writing& tx, const store::AssignmentId& id,
                       const store::Account& account, const store::AuditStamp& stamp) {
  if (account.role != Role::trainee)
    return Error{Errc::bad_input, account.name + ": this account is not a trainee"};
  auto study = TRY(store::study_of(tx, id));
  auto scenarios = TRY(store::study_scenarios(tx, id));
  auto there = TRY(store::study_participants(tx, id));
  const std::string participant =
      account.pseudonym.empty() ? "P" + account.id.substr(0, 24) : account.pseudonym;
  if (std::ranges::find(there, participant, &store::Participant::name) != there.end())
    return Error{Errc::conflict, account.name + ": the assignment already includes this person"};
  TRY(store::add_participant(tx, id, {.name = participant, .level = account.level},
                             order_for(study, scenarios, int(there.size())), stamp));
  return store::add_assigned_person(tx, id, account.id, participant);
}

namespace {

Result<void> assign_what_the_cohort_has(store::Writing& tx, const std::string& cohort_id,
                                        const store::Account& account,
                                        const store::AuditStamp& stamp) {
  auto ids = TRY(store::assignments_of_cohort(tx, cohort_id));
  for (const store::AssignmentId& id : ids) {
    auto there = TRY(store::has_assignment(tx, account.id, id.text()));
    if (there) continue;
    TRY(assign_to(tx, id, account, stamp));
  }
  return {};
}

}  // namespace

Result<void> join_cohort(store::Writing& tx, const std::string& cohort_id,
                         const store::Account& account, const store::AuditStamp& stamp) {
  auto cohort = TRY(store::cohort_of(tx, cohort_id));
  if (!cohort) return Error{Errc::not_found, "no cohort " + cohort_id.substr(0, 32)};
  const bool learns = account.role == Role::trainee;
  if (!learns && account.role != Role::faculty)
    return Error{Errc::bad_input,
                 account.name + ": this account is neither a trainee nor a member of the faculty"};
  const auto part = learns ? store::CohortPart::trainee : store::CohortPart::faculty;
  TRY(store::put_into_cohort(tx, cohort_id, account.id, part, stamp.at_utc_us));
  TRY(store::remove_invitation(tx, cohort_id, account.name));
  return learns ? assign_what_the_cohort_has(tx, cohort_id, account, stamp) : Result<void>();
}

}  // namespace api
}  // namespace tractus
