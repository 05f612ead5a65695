/// An assignment as it is asked for, checked, made; and who is put into it.
#pragma once

#include "db/store/studies/assignments.hpp"
#include "scenarios/scenario.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// One case of an assignment: published already, or a scenario that comes with it.
struct AssignedCase {
  std::string case_id;
  std::string name;  ///< what the trainee is shown; empty: the trial's number
  std::optional<scenarios::Scenario> scenario = {};
};

struct AssignmentPlan {
  store::Assignment assignment;
  std::string protocol;             ///< a study whose scenarios, order and repeats are taken
  std::vector<AssignedCase> cases;  ///< none with a protocol
  std::vector<std::string> people;  ///< names of accounts, beside the cohort's

  /// Errors: bad_input with the field.
  static core::Result<AssignmentPlan> from_json(const core::Json& json);
};

/// Makes it, by the caller, who may name its cohort, people, cases and protocol (access.hpp).
/// Returns its id. Errors: not_found (a case, a cohort, a person, a study that there is not).
core::Result<std::string> make_assignment(const Call& call, const AssignmentPlan& plan);

/// Puts an account into it, with an order of its own. Errors: conflict when it is in it already;
/// bad_input for one that is no trainee's.
core::Result<void> assign_to(store::Writing& tx, const store::AssignmentId& id,
                             const store::Account& account, const store::AuditStamp& stamp);
/// Puts an account into a cohort: faculty leads it; a trainee learns in it, and gets what it was
/// assigned. An invitation is settled by it. Errors: not_found (the cohort), bad_input for an
/// account of another role.
core::Result<void> join_cohort(store::Writing& tx, const std::string& cohort_id,
                               const store::Account& account, const store::AuditStamp& stamp);

}  // namespace tractus::api
