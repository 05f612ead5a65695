/// A study as a person asks for it, and its way into the store.
#pragma once

#include "db/store/cases/cases.hpp"
#include "db/store/studies/studies.hpp"
#include "scenarios/scenario.hpp"
#include "server/api/backend.hpp"

namespace tractus::api {

/// What POST /studies carries, checked.
struct StudyPlan {
  store::Study study;
  std::vector<scenarios::Scenario> scenarios;
  std::vector<store::Participant> participants;

  /// Errors: bad_input naming the field: an id that is no name, a scenario twice, one too large to
  /// be handed out blind, a participant twice, …
  static core::Result<StudyPlan> from_json(const core::Json& json);
};

/// {"tuned": "hard"} or a whole tractus-scenario/1, fit to be handed out blind. Errors: bad_input.
core::Result<scenarios::Scenario> scenario_from(const core::Json& json, const std::string& where);
/// The scenario's file among the objects.
core::Result<store::CasePart> put_scenario(Backend& backend, const scenarios::Scenario& scenario);
/// The cases in the order of the study's n-th participant (from 0): by its ordering, repeats and
/// seed; "fixed": as they are named, round after round.
std::vector<std::string> order_for(const store::Study& study,
                                   const std::vector<store::StudyScenario>& scenarios, int n);

core::Result<store::Participant> participant_from(const core::Json& json, const std::string& where);

/// Scenarios among the objects, then all of it in one transaction: cases, study, participants with
/// their orders. Errors: conflict when the study's id is taken.
core::Result<void> make_study(Backend& backend, const StudyPlan& plan, const std::string& who);
/// One more participant: with the order that follows from the study's seed and their number.
/// Errors: not_found, conflict (the name is taken).
core::Result<void> enrol(Backend& backend, const std::string& study_id,
                         const store::Participant& participant, const std::string& who);

}  // namespace tractus::api
