/// The slots of a study: handed out to stations, recorded, judged.
#pragma once

#include "db/store/studies/studies.hpp"
#include "db/store/trials/trials.hpp"
#include "trial/tool.hpp"

namespace tractus::store {

enum class StudyTrialState {
  arriving,  ///< its upload is not complete
  counts,
  invalid,
  surplus,  ///< its slot had a trial already
};
constexpr auto words(StudyTrialState) {
  using enum StudyTrialState;
  return std::to_array<core::Word<StudyTrialState>>(
      {{arriving, "arriving"}, {counts, "counts"}, {invalid, "invalid"}, {surplus, "surplus"}});
}

/// The state of a trial in a study.
struct StudyTrial {
  std::string trial_id, slot_id;
  StudyTrialState state = StudyTrialState::arriving;
  std::string reason;
  std::int64_t changed_utc_us = 0;
  std::string station = {};               ///< station that announced the trial
  trial::Tool tool = trial::Tool::probe;  ///< known after the upload
  // Set when the upload is complete:
  std::optional<double> duration_s = {};
  std::optional<std::int64_t> samples = {}, started_utc_us = {};
  std::optional<std::string> sha256 = {};  ///< of the file
  std::optional<bool> correct = {};
  std::optional<AssessmentState> assessment = {};
};

/// By participant as enrolled, then in their order.
core::Result<std::vector<Slot>> study_slots(Reading& tx, const SeriesId& id);

/// The slots of a participant that a station has taken.
struct Taken {
  std::vector<Slot> slots;       ///< in the order in which the participant does them
  std::uint64_t unfinished = 0;  ///< open slots of the participant, including these
  std::uint64_t planned = 0;     ///< that count or are still to be done
};

/// Hands out the next slots of a participant, at most `ahead`, to this station; a second call gives
/// the same slots. Errors: conflict if another station has slots of the participant, or if the
/// study or the participant is paused.
core::Result<Taken> take_slots(Writing& tx, const SeriesId& id, const Participant& participant,
                               const std::string& station_id, std::int64_t ahead,
                               const AuditStamp& stamp);
/// Releases the slots of a participant that stations have taken, and returns their number. A
/// channel that was drilled for a slot and not palpated yet exists only at that station: its
/// drilling no longer counts.
core::Result<std::uint64_t> release_slots(Writing& tx, const SeriesId& id,
                                          const std::string& participant, const AuditStamp& stamp);

/// Releases one slot that the station has taken, unless a trial was announced for it.
core::Result<void> release_unstarted_slot(Writing& tx, const Slot& slot,
                                          const std::string& station_id, const AuditStamp& stamp);

core::Result<std::optional<Slot>> slot_of(Reading& tx, const std::string& slot_id);
/// The slot that a trial was announced for; none for a trial of no study.
/// Was the slot ever handed out to the station of this name? Of one that was released and handed
/// out elsewhere since, both.
core::Result<bool> was_handed_to(Reading& tx, const Slot& slot, const std::string& station_name);
core::Result<std::optional<Slot>> slot_of_trial(Reading& tx, const std::string& trial_id);
/// The state of a trial in its study, without its recording; none for a trial without a study.
core::Result<std::optional<StudyTrial>> study_trial_of(Reading& tx, const std::string& trial_id);
/// Records that a trial was announced, in the transaction of the announcement.
core::Result<void> announce_for_slot(Writing& tx, const std::string& trial_id,
                                     const std::string& slot_id, std::int64_t now_utc_us);

/// The tool of a trial, as stated in its file.
struct Tool {
  bool burr = false;         ///< the trial drilled a channel
  std::string drilled = {};  ///< id of the trial that drilled the palpated channel
};
/// The trial that drilled the channel which the slot's next trial palpates; empty: none.
core::Result<std::string> drilling_of(Reading& tx, const std::string& slot_id);

/// Records an uploaded trial: it counts, unless its slot already has a trial (then it is surplus)
/// or it was interrupted (then it is invalid, and the slot is repeated as the study states).
///
/// The slot of a planned case needs two trials: the drilling, after which the slot stays open at
/// its station, and the palpation of the same channel, after which the slot is recorded. An invalid
/// drilling is repeated like any trial; an invalid palpation is repeated next, on the same channel
/// (unless the study never repeats).
core::Result<void> record_for_slot(Writing& tx, const std::string& trial_id, bool complete,
                                   const AuditStamp& stamp, const Tool& tool = {});
/// A person says that a trial does not count; the reason is the deed's. It stays, and its slot is
/// repeated as above; with a drilling goes the palpation of its channel. Errors: not_found (no
/// trial of this study), conflict (it does not count as it is).
core::Result<void> set_trial_invalid(Writing& tx, const SeriesId& id, const std::string& trial_id,
                                     const AuditStamp& stamp);

core::Result<std::vector<StudyTrial>> study_trials(Reading& tx, const SeriesId& id);

}  // namespace tractus::store
