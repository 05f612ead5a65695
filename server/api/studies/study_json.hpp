/// Studies in the JSON form of the routes.
#pragma once

#include <set>

#include "db/store/studies/study_slots.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// All of one study, read in one transaction.
struct StudyFacts {
  store::Study study;
  std::vector<store::StudyScenario> scenarios;
  std::vector<store::Participant> participants;
  std::vector<store::Slot> slots;
  std::vector<store::StudyTrial> trials;
  std::set<std::string> unlinked;  ///< trials that are rated blind: in no participant's row
};
/// Errors: not_found.
core::Result<StudyFacts> study_facts(store::Reading& tx, const store::StudyId& id);

core::Json summary_json(const store::StudySummary& summary);
/// The study runs double-blind: the scenario of a slot is null while its participant still has
/// trials to do, and the seed is null while any participant still has trials to do.
core::Json study_json(const StudyFacts& facts);
/// @param unlinked  trials that are rated blind: the answer has not their ids
core::Json event_json(const store::StudyEvent& event, const std::set<std::string>& unlinked);

/// StudySummary, StudyList, Study, StudyParticipant, StudySlot, StudyTrial, StudyScenario.
std::vector<NamedSchema> study_schemas();
/// NewStudy, NewParticipant, StudyEvents, StudyEvent.
std::vector<NamedSchema> study_deed_schemas();

}  // namespace tractus::api
