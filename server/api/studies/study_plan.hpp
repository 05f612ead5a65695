/// Reads and checks the plan of a study, and stores the study.
#pragma once

#include "db/store/cases/cases.hpp"
#include "db/store/studies/studies.hpp"
#include "scenarios/scenario.hpp"
#include "server/api/backend.hpp"

namespace tractus::api {

/// The body of POST /studies, checked.
struct StudyPlan {
  store::Study study;
  std::vector<scenarios::Scenario> scenarios;
  std::vector<store::Participant> participants;

  /// Errors: bad_input naming the field: an invalid id, a scenario that occurs twice or is too
  /// large to be sealed, a participant that occurs twice, …
  static core::Result<StudyPlan> from_json(const core::Json& json);
};

/// {"tuned": "hard"} or a whole tractus-scenario/1, small enough to be sealed. Errors: bad_input.
core::Result<scenarios::Scenario> scenario_from(const core::Json& json, const std::string& where);
/// Stores the scenario's file among the objects.
core::Result<store::CasePart> put_scenario(Backend& backend, const scenarios::Scenario& scenario);
/// The cases in the order of the study's n-th participant (from 0), which follows from the study's
/// ordering, repeats and seed; "fixed": as listed, repeated.
std::vector<std::string> order_for(const store::Study& study,
                                   const std::vector<store::StudyScenario>& scenarios, int n);

core::Result<store::Participant> participant_from(const core::Json& json, const std::string& where);

/// Stores the scenarios among the objects, then in one transaction cases, study and participants
/// with their orders. Errors: conflict if a study with this id exists.
core::Result<void> make_study(Backend& backend, const StudyPlan& plan, const std::string& who);
/// Adds a participant, whose order follows from the study's seed and the participant's number.
/// Errors: not_found, conflict (the study already has a participant with this name).
core::Result<void> enrol(Backend& backend, const std::string& study_id,
                         const store::Participant& participant, const std::string& who);

}  // namespace tractus::api
