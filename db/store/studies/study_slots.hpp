/// A study's trials on their way: handed out to stations, recorded, judged.
#pragma once

#include "db/store/studies/studies.hpp"

namespace tractus::store {

/// What became of a trial of a study.
struct StudyTrial {
  std::string trial_id, slot_id;
  std::string state;  ///< "arriving", "counts", "invalid", "surplus" (its slot had one already)
  std::string reason;
  std::int64_t changed_utc_us = 0;
  std::string station = {};  ///< that announced it
  std::string tool = {};     ///< once it was recorded: "burr" (it drilled), "probe"
  // Once it has arrived:
  std::optional<double> duration_s = {};
  std::optional<std::int64_t> samples = {}, started_utc_us = {};
  std::optional<std::string> sha256 = {};  ///< of the file
  std::optional<bool> correct = {};
  std::optional<std::string> assessment = {};  ///< "assessing", "assessed", "failed"
};

/// By participant as enrolled, then in their order.
core::Result<std::vector<Slot>> study_slots(Reading& tx, const SeriesId& id);

/// What a station has of a participant's trials.
struct Taken {
  std::vector<Slot> slots;       ///< in the order to be done
  std::uint64_t unfinished = 0;  ///< of the participant, these included
  std::uint64_t planned = 0;     ///< that count or are still to be done
};

/// The next slots of a participant, at most `ahead`, given to this station: repeating it gives the
/// same. Errors: conflict when another station has some, or when study or participant is paused.
core::Result<Taken> take_slots(Writing& tx, const SeriesId& id, const Participant& participant,
                               const std::string& station_id, std::int64_t ahead,
                               const AuditStamp& stamp);
/// What stations had of a participant waits again: the number of slots. A channel that was drilled
/// for one and not felt yet is on that station alone: its drilling no longer counts.
core::Result<std::uint64_t> release_slots(Writing& tx, const SeriesId& id,
                                          const std::string& participant, const AuditStamp& stamp);

core::Result<std::optional<Slot>> slot_of(Reading& tx, const std::string& slot_id);
/// The slot that a trial was announced for; none for a trial of no study.
/// Was the slot ever handed out to the station of this name? Of one that was released and handed
/// out elsewhere since, both.
core::Result<bool> was_handed_to(Reading& tx, const Slot& slot, const std::string& station_name);
core::Result<std::optional<Slot>> slot_of_trial(Reading& tx, const std::string& trial_id);
/// What became of a trial of a study, without what it holds; none for a trial of no study.
core::Result<std::optional<StudyTrial>> study_trial_of(Reading& tx, const std::string& trial_id);
/// Notes that a trial is on its way, in the transaction that announces it.
core::Result<void> announce_for_slot(Writing& tx, const std::string& trial_id,
                                     const std::string& slot_id, std::int64_t now_utc_us);

/// With what a trial was done, as its file says.
struct Tool {
  bool burr = false;         ///< it drilled
  std::string drilled = {};  ///< trial that drilled the channel it felt
};
/// The trial that drilled the channel which a slot's next trial feels; empty: none did.
core::Result<std::string> drilling_of(Reading& tx, const std::string& slot_id);

/// A trial has arrived: it counts, unless its slot has one already (then it is surplus) or it was
/// cut short (then it does not count, and the slot is repeated as the study says).
///
/// The slot of a planned case takes two: the drilling, with which it stays open at its station, and
/// the palpation of that very channel, with which it is recorded. A drilling that does not count is
/// repeated as any trial; a palpation is done again next, on the channel that is there (unless the
/// study never repeats).
core::Result<void> record_for_slot(Writing& tx, const std::string& trial_id, bool complete,
                                   const AuditStamp& stamp, const Tool& tool = {});
/// A person says that a trial does not count; the reason is the deed's. It stays, and its slot is
/// repeated as above; with a drilling goes the palpation of its channel. Errors: not_found (no
/// trial of this study), conflict (it does not count as it is).
core::Result<void> set_trial_invalid(Writing& tx, const SeriesId& id, const std::string& trial_id,
                                     const AuditStamp& stamp);

core::Result<std::vector<StudyTrial>> study_trials(Reading& tx, const SeriesId& id);

}  // namespace tractus::store
