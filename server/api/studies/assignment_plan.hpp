/// Reads and checks the plan of an assignment, creates the assignment, and adds people to it.
#pragma once

#include "db/store/cases/cases.hpp"
#include "db/store/studies/assignments.hpp"
#include "scenarios/scenario.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// One case of an assignment: a published case, or a scenario in the request.
struct AssignedCase {
  std::string case_id;
  std::string name;  ///< name that the trainee sees; empty: the number of the trial
  std::optional<scenarios::Scenario> scenario = {};
};

struct AssignmentPlan {
  store::Assignment assignment;
  std::string protocol;             ///< id of a study whose scenarios, order and repeats are used
  std::vector<AssignedCase> cases;  ///< none with a protocol
  std::vector<std::string> people;  ///< names of accounts, in addition to the cohort's trainees

  /// Errors: bad_input with the field.
  static core::Result<AssignmentPlan> from_json(const core::Json& json, std::int64_t now_utc_us);
};

/// Cases of an assignment, none twice. Errors: bad_input with the place.
core::Result<std::vector<AssignedCase>> assigned_cases_from(const core::Json& json);
/// Stores the files of those that are scenarios.
core::Result<std::vector<store::CasePart>> put_scenarios(Backend& backend,
                                                         const std::vector<AssignedCase>& cases);
/// The cases' ids; scenarios among them are noted as cases. @param parts  of put_scenarios.
/// Errors: not_found; conflict for a case that is retired.
core::Result<std::vector<std::string>> note_cases(store::Writing& tx,
                                                  const std::vector<AssignedCase>& cases,
                                                  const std::vector<store::CasePart>& parts,
                                                  const store::AuditStamp& stamp);

/// The due time in a body, in microseconds since 1970-01-01 UTC; one in the past is an error.
std::int64_t due_field(core::Fields& fields, std::int64_t now_utc_us);

/// Creates the assignment for the caller, whose access to its cohort, people, cases and protocol
/// was checked (access.hpp). Returns its id. Errors: not_found (a case, cohort, person or study).
core::Result<std::string> make_assignment(const Call& call, const AssignmentPlan& plan);

/// Adds an account to the assignment, with its own order of trials. Errors: conflict if the
/// assignment already includes the account; bad_input if the account is not a trainee.
core::Result<void> assign_to(store::Writing& tx, const store::AssignmentId& id,
                             const store::Account& account, const store::AuditStamp& stamp);
/// Adds an account to a cohort: faculty as a leader; a trainee as a learner, who also gets the
/// cohort's assignments. Removes an open invitation of the account. Errors: not_found (the cohort),
/// bad_input for an account of another role.
core::Result<void> join_cohort(store::Writing& tx, const std::string& cohort_id,
                               const store::Account& account, const store::AuditStamp& stamp);

}  // namespace tractus::api
