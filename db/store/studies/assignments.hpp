/// Assignments: series of trials whose participants are accounts, with a due time, and whose
/// results trainees see when faculty releases them.
#pragma once

#include "db/store/finding/list.hpp"
#include "db/store/people/people.hpp"
#include "db/store/studies/study_slots.hpp"

namespace tractus::store {

/// When trainees see their results.
enum class Release {
  held,      ///< not yet
  released,  ///< now
  at_once,   ///< each when it exists
};
constexpr auto words(Release) {
  using enum Release;
  return std::to_array<core::Word<Release>>(
      {{held, "held"}, {released, "released"}, {at_once, "at_once"}});
}

struct Assignment {
  Study study;  ///< the series of trials; its id is the assignment's
  std::optional<std::string> cohort_id = {};
  std::optional<std::int64_t> due_utc_us = {};
  Release release = Release::held;
  std::string made_by_id = {};
  // Filled on reading:
  std::string cohort_name = {};
  std::uint64_t people = 0, done = 0,
                planned = 0;   ///< only of the account, if the filter names one
  std::uint64_t to_drill = 0;  ///< of `planned`: the trainee drills the channel, then palpates it
};

struct AssignedPerson {
  std::string account_id, name, participant;
  std::uint64_t done = 0, planned = 0;
};

/// Errors: those of add_study.
core::Result<AssignmentId> add_assignment(Writing& tx, const Assignment& assignment,
                                          const std::vector<std::string>& case_ids,
                                          const AuditStamp& stamp);
/// Name that the trainee sees in place of the case's title.
core::Result<void> set_assigned_name(Writing& tx, const AssignmentId& id,
                                     const std::string& case_id, const std::string& name);
/// Empty when it has none.
core::Result<std::string> assigned_name(Reading& tx, const AssignmentId& id,
                                        const std::string& case_id);
/// Adds the participant of an account. Errors: conflict if the assignment already includes the
/// account.
core::Result<void> add_assigned_person(Writing& tx, const AssignmentId& id,
                                       const std::string& account_id,
                                       const std::string& participant);
core::Result<void> set_release(Writing& tx, const AssignmentId& id, Release release,
                               const AuditStamp& stamp);
core::Result<void> set_due(Writing& tx, const AssignmentId& id,
                           const std::optional<std::int64_t>& due_utc_us, const AuditStamp& stamp);

/// Selects the assignments of a list. Both empty: all.
struct AssignmentFilter {
  std::string led_by = {};   ///< created by this account, or for a cohort that it leads
  std::string done_by = {};  ///< assigned to this account; counts only its trials
};
/// Sorted by due time, earliest first, those without a due time last; then by time of creation.
core::Result<std::vector<Assignment>> assignments_of(Reading& tx, const AssignmentFilter& whose);
/// The list of assignments (finding/list.hpp): its orders and filters. The first order is the unfinished ones before
/// the finished ones, of both the earliest due first.
const ListShape& assignment_list();
struct FoundAssignments {
  std::vector<Assignment> assignments;
  ListPage page;
};
/// `done_by` counts an assignment as finished once this account has finished its part.
core::Result<FoundAssignments> find_assignments(Reading& tx, const ListRequest& request,
                                                const AssignmentFilter& whose);

core::Result<Assignment> assignment_of(Reading& tx, const AssignmentId& id,
                                       const std::string& done_by = {});
core::Result<std::vector<AssignmentId>> assignments_of_cohort(Reading& tx,
                                                              const std::string& cohort_id);
/// By name.
core::Result<std::vector<AssignedPerson>> assigned_people(Reading& tx, const AssignmentId& id);
/// The participant of the account; empty if the assignment does not include it.
core::Result<std::string> participant_for(Reading& tx, const AssignmentId& id,
                                          const std::string& account_id);

}  // namespace tractus::store
