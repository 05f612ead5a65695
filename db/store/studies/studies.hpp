/// Blinded studies: their trials, participants and changes. Studies and their data are never
/// deleted.
#pragma once

#include <vector>

#include "db/store/studies/series.hpp"

namespace tractus::store {

/// Actor, time and reason of a change: every change is recorded as a StudyEvent.
struct AuditStamp {
  std::string who;
  std::int64_t at_utc_us = 0;
  std::string reason = {};
};

/// Of a study, and of a participant in it.
enum class StudyState {
  running,
  paused,  ///< stations receive no trials of it
};
constexpr auto words(StudyState) {
  using enum StudyState;
  return std::to_array<core::Word<StudyState>>({{running, "running"}, {paused, "paused"}});
}

/// The order in which a participant meets the cases.
enum class CaseOrder {
  fixed,     ///< as listed
  random,    ///< as study::Ordering
  balanced,  ///< as study::Ordering
};
constexpr auto words(CaseOrder) {
  using enum CaseOrder;
  return std::to_array<core::Word<CaseOrder>>(
      {{fixed, "fixed"}, {random, "random"}, {balanced, "balanced"}});
}

/// When a trial that does not count is repeated.
enum class Repetition {
  at_end,
  at_once,  ///< as the next trial of its participant
  never,
};
constexpr auto words(Repetition) {
  using enum Repetition;
  return std::to_array<core::Word<Repetition>>(
      {{at_end, "at_end"}, {at_once, "at_once"}, {never, "never"}});
}

struct Study {
  std::string id;  ///< chosen by people: "spine-2026"
  std::string title;
  StudyState state = StudyState::running;
  CaseOrder ordering = CaseOrder::random;
  std::int64_t repeats = 1;  ///< of each scenario
  std::int64_t seed = 1;     ///< of the orders
  Repetition on_invalid = Repetition::at_end;
  std::int64_t made_utc_us = 0;  ///< filled by add_study
  std::string made_by = {};      ///< filled by add_study
};

/// A study and its progress.
struct StudySummary {
  Study study;
  std::uint64_t participants = 0;
  std::uint64_t done = 0;     ///< slots with a trial that counts
  std::uint64_t planned = 0;  ///< slots that count or are still to be done
};

struct Participant {
  std::string name;  ///< a pseudonym
  StudyState state = StudyState::running;
  std::string level = {};  ///< "resident", "fellow", …
  std::optional<double> experience_years = {};
  bool simulated = false;
};

struct StudyScenario {
  std::string case_id;
  std::string title;  ///< filled on reading
};

enum class SlotState {
  waiting,
  taken,  ///< a station has it
  recorded,
  invalid,
};
constexpr auto words(SlotState) {
  using enum SlotState;
  return std::to_array<core::Word<SlotState>>(
      {{waiting, "waiting"}, {taken, "taken"}, {recorded, "recorded"}, {invalid, "invalid"}});
}

/// One planned trial of a participant.
struct Slot {
  std::string id;  ///< 64 random hexadecimal characters
  std::string study_id, participant;
  std::int64_t position = 0;  ///< in the participant's order, from 0
  std::int64_t attempt = 0;   ///< of that position
  std::string case_id;
  SlotState state = SlotState::waiting;
  std::optional<std::string> station_id;
  std::optional<std::string> repeat_of;  ///< the slot that it repeats
  bool planned = false;  ///< whole bone: one trial drills the channel, the next palpates it
};

struct StudyEvent {
  std::int64_t at_utc_us = 0;
  std::string who, what;
  std::optional<std::string> participant, slot_id, trial_id;
  std::string reason;
};

/// Errors: conflict when the id is taken; not_found is the caller's to exclude (cases must exist).
core::Result<StudyId> add_study(Writing& tx, const Study& study,
                                const std::vector<std::string>& case_ids, const AuditStamp& stamp);
/// Enrols a participant, whose slots are these cases in this order. Errors: conflict when the name
/// is taken.
core::Result<void> add_participant(Writing& tx, const SeriesId& id, const Participant& participant,
                                   const std::vector<std::string>& case_order,
                                   const AuditStamp& stamp);
core::Result<void> set_study_state(Writing& tx, const StudyId& id, StudyState state,
                                   const AuditStamp& stamp);
core::Result<void> set_participant_state(Writing& tx, const StudyId& id, const std::string& name,
                                         StudyState state, const AuditStamp& stamp);

/// Newest first, without assignments.
core::Result<std::vector<StudySummary>> all_studies(Reading& tx);
core::Result<Study> study_of(Reading& tx, const SeriesId& id);
/// In the order they were named.
core::Result<std::vector<StudyScenario>> study_scenarios(Reading& tx, const SeriesId& id);
/// As enrolled.
core::Result<std::vector<Participant>> study_participants(Reading& tx, const SeriesId& id);
core::Result<std::optional<Participant>> participant_of(Reading& tx, const SeriesId& id,
                                                        const std::string& name);
core::Result<std::vector<StudyEvent>> study_events(Reading& tx, const StudyId& id,
                                                   std::int64_t limit);
/// Only for functions of this library. @param row  id, title, state, ordering, repeats, seed,
/// on_invalid, time, maker.
core::Result<Study> study_from(const Row& row);
/// Only for functions of this library that change studies.
core::Result<void> add_series(Writing& tx, const Study& study, SeriesKind kind,
                              const std::vector<std::string>& case_ids, const AuditStamp& stamp);
core::Result<void> add_study_event(Writing& tx, const std::string& series_id,
                                   const AuditStamp& stamp, const std::string& what,
                                   const Slot* slot = nullptr, const std::string& trial_id = {},
                                   const std::string& participant = {});

}  // namespace tractus::store
