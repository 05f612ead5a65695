/// The learning state of each trainee, from the scored trials of a cohort in order of time.
#pragma once

#include <set>

#include "assessment/trainee.hpp"
#include "db/store/cohort/cohort.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/api/studies/passing.hpp"

namespace tractus::api {

/// The next case that a curriculum wants of somebody.
struct CurriculumNext {
  std::string case_title, why;
};

/// The trials that the caller may see, as a cohort, with what passing is.
struct Programme {
  assessment::Cohort cohort;
  std::vector<std::vector<store::CohortTrial>> trials;  ///< [trainee][attempt], as cohort.attempts
  CriteriaHistory criteria;                             ///< of the programme
  std::map<std::string, CurriculumNext> next;           ///< by the trainee's name
  /// Trials that are rated blind: beside a name they have neither id nor time.
  std::set<std::string> unlinked;
  Backend* backend;
};

/// Uses trials that count and are judged: complete, assessed, with an answer and, in a study, in
/// their place. The trainee is the account to which the trial was assigned, else the study's
/// pseudonym, else the operator's name. Contains only trials that the caller may see; the argument
/// "study" is optional. Errors: bad_input for an unknown study; too_large for more than 20 000
/// trials.
core::Result<Programme> programme_of(const Call& call);

/// {"rule", "trainees": [summaries]}
core::Json list_json(const Programme& programme);
/// tractus-trainee/1 with its attempts and the calibration of the stated confidence. An unreadable
/// confidence is null.
core::Json trainee_json(const Programme& programme, std::size_t trainee);

}  // namespace tractus::api
