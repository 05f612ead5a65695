/// Who has passed: the criteria of shared/assessment on the trials that count.
#pragma once

#include "assessment/curriculum.hpp"
#include "db/store/cohort/cohort.hpp"
#include "db/store/studies/criteria.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// Complete, assessed and, in a study or an assignment, in its place.
bool counts_for_passing(const store::CohortTrial& trial);
assessment::JudgedTrial judged_trial(const store::CohortTrial& trial);

/// The trials that the caller may see and that count, of one assignment or, with an empty id, of
/// all. Errors: too_large.
core::Result<std::vector<store::CohortTrial>> trials_for_passing(store::Reading& tx,
                                                                 const Call& call,
                                                                 const std::string& study);

/// The versions of a criterion as they were stored.
struct CriteriaHistory {
  std::vector<std::int64_t> made_utc_us;  ///< ascending
  std::vector<assessment::Criteria> versions;
  /// The version that holds for somebody who began then; the usual one if there is none.
  const assessment::Criteria& for_start(std::optional<std::int64_t> began_utc_us) const;
  /// From 1; 0: the usual one.
  std::size_t number_for(std::optional<std::int64_t> began_utc_us) const;
};
core::Result<CriteriaHistory> criteria_history(store::Reading& tx, store::CriteriaKind kind,
                                               const std::string& subject);

/// What somebody who has begun a curriculum did of one step.
struct StepRecord {
  std::vector<std::string> study_ids;  ///< of the assignments that hand the step out to the person
  std::vector<assessment::StepTrial> trials;
  std::vector<std::int64_t> started_utc_us;  ///< of each trial
  std::uint64_t done = 0, planned = 0;
  bool held = false;       ///< results that the person must not see yet
  bool simulated = false;  ///< a simulated hand did a trial
};

/// Somebody in one version of a curriculum.
struct CurriculumPerson {
  std::string account_id, name;
  std::string curriculum_id, title;
  std::int64_t version = 0;
  assessment::Curriculum curriculum;
  std::vector<StepRecord> steps = {};
  assessment::Progress progress = {};
};

/// Everybody in curricula. @param account_id  only this account; empty: all.
/// @param curriculum_id  only this curriculum; empty: all.
core::Result<std::vector<CurriculumPerson>> people_in_curricula(store::Reading& tx,
                                                                const std::string& account_id,
                                                                const std::string& curriculum_id);

/// Whether a station may hand out this assignment to the account now: false for a step of a
/// curriculum that waits for another step, or that the person has passed.
core::Result<bool> may_be_handed_out(store::Reading& tx, const std::string& account_id,
                                     const std::string& study_id);

}  // namespace tractus::api
