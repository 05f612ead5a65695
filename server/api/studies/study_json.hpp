/// Studies as the pages get them.
#pragma once

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
};
/// Errors: not_found.
core::Result<StudyFacts> study_facts(store::Reading& tx, const store::StudyId& id);

core::Json summary_json(const store::StudySummary& summary);
/// Blind also to who runs the study: which scenario a slot has is told once nothing is left to do
/// for its participant, and the seed once nothing is left for anybody.
core::Json study_json(const StudyFacts& facts);
core::Json event_json(const store::StudyEvent& event);

/// StudySummary, StudyList, Study, StudyParticipant, StudySlot, StudyTrial, StudyScenario.
std::vector<NamedSchema> study_schemas();
/// NewStudy, NewParticipant, StudyEvents, StudyEvent.
std::vector<NamedSchema> study_deed_schemas();

}  // namespace tractus::api
