/// Cohorts, which state who teaches whom, and the relations between a person and an object on which
/// access control is based.
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

/// What a person is in a cohort.
enum class CohortPart {
  trainee,
  faculty,  ///< a leader
};
constexpr auto words(CohortPart) {
  return std::to_array<core::Word<CohortPart>>(
      {{CohortPart::trainee, "trainee"}, {CohortPart::faculty, "faculty"}});
}

struct CohortPerson {
  std::string account_id, name;
  Role role = Role::trainee;
  CohortPart part = CohortPart::trainee;
  AccountState state = AccountState::active;
  std::string pseudonym = {};
};

/// Errors: conflict when the name is taken.
core::Result<void> add_cohort(Writing& tx, const Cohort& cohort);
core::Result<std::optional<Cohort>> cohort_of(Reading& tx, const std::string& id);
/// Sorted by name. @param account_id  only cohorts that this account belongs to; empty: all.
core::Result<std::vector<Cohort>> cohorts_of(Reading& tx, const std::string& account_id);
/// By name.
core::Result<std::vector<CohortPerson>> people_of(Reading& tx, const std::string& cohort_id);
/// A person who already belongs to the cohort gets this part.
core::Result<void> put_into_cohort(Writing& tx, const std::string& cohort_id,
                                   const std::string& account_id, CohortPart part,
                                   std::int64_t now_utc_us);
core::Result<void> take_from_cohort(Writing& tx, const std::string& cohort_id,
                                    const std::string& account_id);

// Relations of a person to an object. They are false for an object that does not exist.

core::Result<bool> leads_cohort(Reading& tx, const std::string& account_id,
                                const std::string& cohort_id);
core::Result<bool> is_in_cohort(Reading& tx, const std::string& account_id,
                                const std::string& cohort_id);
/// Does the account lead a cohort in which `trainee_id` is a trainee?
core::Result<bool> teaches(Reading& tx, const std::string& account_id,
                           const std::string& trainee_id);
/// Does the account lead a cohort to which this person belongs, as a trainee or as a leader?
core::Result<bool> leads_with(Reading& tx, const std::string& account_id,
                              const std::string& person_id);
/// Did a trainee of this account do the trial, in an assignment?
core::Result<bool> teaches_trial(Reading& tx, const std::string& account_id,
                                 const std::string& trial_id);
/// Did this account do the trial in an assignment whose results it may see?
core::Result<bool> sees_own_trial(Reading& tx, const std::string& account_id,
                                  const std::string& trial_id);
/// Did this account do such a trial on this case?
core::Result<bool> sees_own_case(Reading& tx, const std::string& account_id,
                                 const std::string& case_id);
/// Does the assignment belong to a cohort that this account leads, or did this account create it?
core::Result<bool> leads_assignment(Reading& tx, const std::string& account_id,
                                    const std::string& assignment_id);
core::Result<bool> has_assignment(Reading& tx, const std::string& account_id,
                                  const std::string& assignment_id);

}  // namespace tractus::store
