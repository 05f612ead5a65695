/// How far each trainee is: the scored trials of a cohort, by who did them, in order.
#pragma once

#include "assessment/trainee.hpp"
#include "db/store/cohort/cohort.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// The trials that a caller may know of, as a cohort, with the rule by which it is judged.
struct Programme {
  assessment::Cohort cohort;
  std::vector<std::vector<store::CohortTrial>> trials;  ///< [trainee][attempt], as cohort.attempts
  assessment::Certification rule;
  assessment::TraineeRules rules;
  Backend* backend;
};

/// Of trials that count and are judged: complete, assessed, with an answer, in their place where
/// they are of a study. Who did it is the account that it was assigned to, else the
/// study's pseudonym, else the operator's name. Restricted
/// to what the caller's grant reaches; argument "study" is optional.
/// Errors: bad_input for a study there is not; too_large for more than 20 000 trials.
core::Result<Programme> programme_of(const Call& call);

/// {"rule", "trainees": [in short]}
core::Json list_json(const Programme& programme);
/// tractus-trainee/1 with its attempts and the calibration of the stated confidence. A confidence
/// that cannot be read is null.
core::Json trainee_json(const Programme& programme, std::size_t trainee);

}  // namespace tractus::api
