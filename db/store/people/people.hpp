/// Cohorts: who teaches whom. And the relations between a person and an object that access is
/// decided by.
#pragma once

#include <vector>

#include "db/store/people/accounts.hpp"

namespace tractus::store {

struct Cohort {
  std::string id;
  std::string name;
  std::int64_t made_utc_us = 0;
  std::string made_by = {};
  std::uint64_t trainees = 0;  ///< counted on reading
};

struct CohortPerson {
  std::string account_id, name, role;
  std::string part;  ///< "trainee", "faculty" (who leads it)
  std::string state = {};
  std::string pseudonym = {};
};

/// Errors: conflict when the name is taken.
core::Result<void> add_cohort(Writing& tx, const Cohort& cohort);
core::Result<std::optional<Cohort>> cohort_of(Reading& tx, const std::string& id);
/// By name. @param account_id  those this account has a part in; empty: all.
core::Result<std::vector<Cohort>> cohorts_of(Reading& tx, const std::string& account_id);
/// By name.
core::Result<std::vector<CohortPerson>> people_of(Reading& tx, const std::string& cohort_id);
/// Somebody who is in it already gets this part.
core::Result<void> put_into_cohort(Writing& tx, const std::string& cohort_id,
                                   const std::string& account_id, const std::string& part,
                                   std::int64_t now_utc_us);
core::Result<void> take_from_cohort(Writing& tx, const std::string& cohort_id,
                                    const std::string& account_id);

// How a person stands to an object. An object that does not exist is nobody's.

core::Result<bool> leads_cohort(Reading& tx, const std::string& account_id,
                                const std::string& cohort_id);
core::Result<bool> is_in_cohort(Reading& tx, const std::string& account_id,
                                const std::string& cohort_id);
/// Does the account lead a cohort in which `trainee_id` is a trainee?
core::Result<bool> teaches(Reading& tx, const std::string& account_id,
                           const std::string& trainee_id);
/// Does the account lead a cohort that this person is in, in whatever part?
core::Result<bool> leads_with(Reading& tx, const std::string& account_id,
                              const std::string& person_id);
/// Did somebody taught by this account do the trial, in an assignment?
core::Result<bool> teaches_trial(Reading& tx, const std::string& account_id,
                                 const std::string& trial_id);
/// Did this account do the trial in an assignment whose results it may see?
core::Result<bool> sees_own_trial(Reading& tx, const std::string& account_id,
                                  const std::string& trial_id);
/// Did it do such a trial of this case?
core::Result<bool> sees_own_case(Reading& tx, const std::string& account_id,
                                 const std::string& case_id);
/// Is the assignment of a cohort that this account leads, or did this account make it?
core::Result<bool> leads_assignment(Reading& tx, const std::string& account_id,
                                    const std::string& assignment_id);
core::Result<bool> has_assignment(Reading& tx, const std::string& account_id,
                                  const std::string& assignment_id);

}  // namespace tractus::store
