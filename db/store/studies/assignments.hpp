/// What trainees are to do: a study whose participants are accounts, with a date, and whose results
/// are seen when those who teach say so.
#pragma once

#include "db/store/people/people.hpp"
#include "db/store/studies/study_slots.hpp"

namespace tractus::store {

struct Assignment {
  Study study;  ///< the series of trials; its id is the assignment's
  std::optional<std::string> cohort_id = {};
  std::optional<std::int64_t> due_utc_us = {};
  std::string release = "held";  ///< "held"; "released"; "at_once": each result once it is there
  std::string made_by_id = {};
  // Filled on reading:
  std::string cohort_name = {};
  std::uint64_t people = 0, done = 0, planned = 0;  ///< of the account alone where one is asked for
  std::uint64_t to_drill = 0;  ///< of `planned`: their channel is drilled first, and felt then
};

struct AssignedPerson {
  std::string account_id, name, participant;
  std::uint64_t done = 0, planned = 0;
};

/// Errors: those of add_study.
core::Result<AssignmentId> add_assignment(Writing& tx, const Assignment& assignment,
                                          const std::vector<std::string>& case_ids,
                                          const AuditStamp& stamp);
/// What the trainee is shown for a case instead of its title.
core::Result<void> set_assigned_name(Writing& tx, const AssignmentId& id,
                                     const std::string& case_id, const std::string& name);
/// Empty when it has none.
core::Result<std::string> assigned_name(Reading& tx, const AssignmentId& id,
                                        const std::string& case_id);
/// Somebody's participant in the study. Errors: conflict when they are in it already.
core::Result<void> add_assigned_person(Writing& tx, const AssignmentId& id,
                                       const std::string& account_id,
                                       const std::string& participant);
core::Result<void> set_release(Writing& tx, const AssignmentId& id, const std::string& release,
                               const AuditStamp& stamp);
core::Result<void> set_due(Writing& tx, const AssignmentId& id,
                           const std::optional<std::int64_t>& due_utc_us, const AuditStamp& stamp);

/// Whose assignments a list is of. Both empty: all.
struct AssignmentFilter {
  std::string led_by = {};   ///< made by this account, or of a cohort that it leads
  std::string done_by = {};  ///< assigned to this account, whose counts are its own
};
/// Those due first come first, those without a date last; then as they were made.
core::Result<std::vector<Assignment>> assignments_of(Reading& tx, const AssignmentFilter& whose);
core::Result<Assignment> assignment_of(Reading& tx, const AssignmentId& id,
                                       const std::string& done_by = {});
core::Result<std::vector<AssignmentId>> assignments_of_cohort(Reading& tx,
                                                              const std::string& cohort_id);
/// By name.
core::Result<std::vector<AssignedPerson>> assigned_people(Reading& tx, const AssignmentId& id);
/// The account's participant in the study; empty: not in it.
core::Result<std::string> participant_for(Reading& tx, const AssignmentId& id,
                                          const std::string& account_id);

}  // namespace tractus::store
