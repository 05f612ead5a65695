#include "db/store/studies/study_slots.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/rows.hpp"
#include "db/store/studies/assignment_list.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kSlot =
    "select k.id, k.study_id, k.participant, k.position, k.attempt, k.case_id, k.state, "
    "k.station_id, k.repeat_of, (select c.planned from cases c where c.id = k.case_id) "
    "from study_slots k ";

core::Result<Slot> slot_from(const Row& row) {
  const auto state = TRY(row.word<SlotState>(6, "study_slots.state"));
  return Slot{.id = row.text(0),
              .study_id = row.text(1),
              .participant = row.text(2),
              .position = row.integer(3),
              .attempt = row.integer(4),
              .case_id = row.text(5),
              .state = state,
              .station_id = row.text_or_null(7),
              .repeat_of = row.text_or_null(8),
              .planned = row.truth(9)};
}

/// Columns trial_id, slot_id, state, reason, changed_utc_us.
core::Result<StudyTrial> judged_trial_from(const Row& row) {
  const auto state = TRY(row.word<StudyTrialState>(2, "study_trials.state"));
  return StudyTrial{row.text(0), row.text(1), state, row.text(3), row.integer(4)};
}

/// Columns of study_trials.
core::Result<StudyTrial> study_trial_from(const Row& row) {
  auto out = TRY(judged_trial_from(row));
  out.station = row.text(5);
  out.duration_s = row.number_or_null(6);
  out.sha256 = row.text_or_null(9);
  out.correct = row.truth_or_null(10);
  out.assessment = TRY(row.word_or_null<AssessmentState>(11, "trials.state"));
  out.tool = TRY(row.word<trial::Tool>(12, "study_trials.tool"));
  if (out.sha256) {
    out.samples = row.integer(7);
    out.started_utc_us = row.integer(8);
  }
  return out;
}

core::Result<std::vector<Slot>> slots_where(Reading& tx, const std::string& tail,
                                            std::initializer_list<Value> values) {
  return all_of(tx.query(kSlot + tail, values), slot_from);
}

core::Result<std::optional<Slot>> first(const core::Result<std::vector<Slot>>& found) {
  if (!found) return found.error();
  if (found->empty()) return std::optional<Slot>();
  return std::optional(found->front());
}

core::Result<void> set_slot(Writing& tx, const std::string& id, SlotState state,
                            const std::optional<std::string>& station_id, std::int64_t now_utc_us) {
  return done(
      tx.query("update study_slots set state = ?, station_id = ?, changed_utc_us = ? where id = ?",
               {name_value(state), or_null(station_id), now_utc_us, id}));
}

core::Result<void> set_trial(Writing& tx, const std::string& trial_id, StudyTrialState state,
                             const AuditStamp& stamp) {
  return done(tx.query(
      "update study_trials set state = ?, reason = ?, changed_utc_us = ? where trial_id = ?",
      {name_value(state), stamp.reason, stamp.at_utc_us, trial_id}));
}

/// Where a repetition of `slot` stands: after everything, or at its own place.
core::Result<std::pair<std::int64_t, std::int64_t>> place_of_repetition(Writing& tx,
                                                                        const Slot& slot,
                                                                        Repetition on_invalid) {
  const bool at_end = on_invalid == Repetition::at_end;
  auto rows = TRY(
      at_end ? tx.query("select max(position) + 1, 0 from study_slots where study_id = ? and "
                        "participant = ?",
                        {slot.study_id, slot.participant})
             : tx.query("select position, max(attempt) + 1 from study_slots where study_id = ? and "
                        "participant = ? and position = ? group by position",
                        {slot.study_id, slot.participant, slot.position}));
  return std::pair(rows.front().integer(0), rows.front().integer(1));
}

core::Result<Repetition> on_invalid_of(Reading& tx, const std::string& series_id) {
  auto rows = TRY(tx.query("select on_invalid from studies where id = ?", {series_id}));
  core::require(!rows.empty(), "a slot has its study");
  return rows.front().word<Repetition>(0, "studies.on_invalid");
}

/// The slot did not yield a trial that counts: it is closed, and repeated as the study says. That
/// of a palpation whose channel is there stays open for the next one.
core::Result<void> close_and_repeat(Writing& tx, const Slot& slot, const Tool& tool,
                                    const AuditStamp& stamp) {
  auto on_invalid = TRY(on_invalid_of(tx, slot.study_id));
  const bool never = on_invalid == Repetition::never;
  if (slot.planned && !tool.burr && !never) {
    TRY(set_slot(tx, slot.id, slot.station_id ? SlotState::taken : SlotState::waiting,
                 slot.station_id, stamp.at_utc_us));
    return note_progress(tx, slot.study_id, slot.participant);
  }
  TRY(set_slot(tx, slot.id, SlotState::invalid, slot.station_id, stamp.at_utc_us));
  if (never) return note_progress(tx, slot.study_id, slot.participant);
  auto place = TRY(place_of_repetition(tx, slot, on_invalid));
  Slot again = slot;
  again.id = core::hex(core::random_bytes(32));
  TRY(tx.query(
      "insert into study_slots (id, study_id, participant, position, attempt, case_id, state, "
      "repeat_of, changed_utc_us) values (?, ?, ?, ?, ?, ?, 'waiting', ?, ?)",
      {again.id, slot.study_id, slot.participant, place.first, place.second, slot.case_id, slot.id,
       stamp.at_utc_us}));
  TRY(note_progress(tx, slot.study_id, slot.participant));
  return add_study_event(tx, slot.study_id, stamp, "repeated", &again);
}

/// What becomes of a trial, and why.
struct Judged {
  StudyTrialState state;
  std::string reason = {};
};

/// @param drilling  drilling_of the slot
Judged judged(const Slot& slot, bool complete, const Tool& tool, const std::string& drilling) {
  if (slot.state != SlotState::waiting && slot.state != SlotState::taken)
    return {StudyTrialState::surplus, "its place in the order has a trial already"};
  if (slot.planned && tool.burr && !drilling.empty())
    return {StudyTrialState::surplus, "a channel was drilled for it already"};
  if (slot.planned && !tool.burr && (drilling.empty() || tool.drilled != drilling))
    return {StudyTrialState::surplus, "it did not feel the channel that was drilled for it"};
  if (!complete) return {StudyTrialState::invalid, "cut short before its end"};
  return {StudyTrialState::counts};
}

/// The trials of a slot that count no longer do.
core::Result<void> discount(Writing& tx, const Slot& slot, const AuditStamp& stamp) {
  auto rows = TRY(tx.query(
      "select trial_id from study_trials where slot_id = ? and state = 'counts'", {slot.id}));
  for (const Row& row : rows) {
    TRY(set_trial(tx, row.text(0), StudyTrialState::invalid, stamp));
    TRY(add_study_event(tx, slot.study_id, stamp, "invalid", &slot, row.text(0)));
  }
  return {};
}

core::Error paused(const std::string& what) {
  return {core::Errc::conflict, what + " is paused: nothing is handed out until it goes on"};
}

core::Result<void> give(Writing& tx, Slot& slot, const std::string& station_id,
                        const AuditStamp& stamp) {
  if (slot.state == SlotState::taken) return {};
  slot.state = SlotState::taken;
  slot.station_id = station_id;
  TRY(set_slot(tx, slot.id, SlotState::taken, station_id, stamp.at_utc_us));
  return add_study_event(tx, slot.study_id, stamp, "taken", &slot);
}

/// A slot that a station held waits again; what was drilled in it and not felt is discounted.
core::Result<void> release_slot(Writing& tx, const Slot& slot, const AuditStamp& stamp) {
  AuditStamp unfelt = stamp;
  unfelt.reason = "freed before its channel was felt";
  TRY(discount(tx, slot, unfelt));
  TRY(set_slot(tx, slot.id, SlotState::waiting, std::nullopt, stamp.at_utc_us));
  return add_study_event(tx, slot.study_id, stamp, "released", &slot);
}

/// The participant's slots that are not done. What a station holds whose access was revoked (it was
/// stolen, say) is released here: its trial can no longer be handed over.
core::Result<std::vector<Slot>> open_slots(Writing& tx, const SeriesId& id,
                                           const std::string& participant,
                                           const AuditStamp& stamp) {
  const auto lost = TRY(slots_where(tx,
                                    "join stations s on s.id = k.station_id where k.study_id = ? "
                                    "and k.participant = ? and k.state = 'taken' and "
                                    "s.revoked_utc_us is not null",
                                    {id.text(), participant}));
  AuditStamp revoked = stamp;
  revoked.reason = "access of its station was revoked";
  for (const Slot& slot : lost) TRY(release_slot(tx, slot, revoked));
  return slots_where(tx,
                     "where k.study_id = ? and k.participant = ? and "
                     "k.state in ('waiting', 'taken') order by k.position, k.attempt",
                     {id.text(), participant});
}

core::Result<std::uint64_t> planned_of(Reading& tx, const std::string& study_id,
                                       const std::string& participant) {
  auto rows =
      TRY(tx.query("select count(*) from study_slots where study_id = ? and participant = ? and "
                   "state <> 'invalid'",
                   {study_id, participant}));
  return rows.front().count(0);
}

}  // namespace

core::Result<std::vector<Slot>> study_slots(Reading& tx, const SeriesId& id) {
  return slots_where(tx,
                     "join study_participants p on p.study_id = k.study_id and "
                     "p.name = k.participant where k.study_id = ? "
                     "order by p.position, k.position, k.attempt",
                     {id.text()});
}

core::Result<Taken> take_slots(Writing& tx, const SeriesId& id, const Participant& participant,
                               const std::string& station_id, std::int64_t ahead,
                               const AuditStamp& stamp) {
  auto study = TRY(study_of(tx, id));
  if (study.state == StudyState::paused) return paused("study " + id.text());
  if (participant.state == StudyState::paused) return paused("participant " + participant.name);
  auto open = TRY(open_slots(tx, id, participant.name, stamp));
  for (const Slot& slot : open)
    if (slot.station_id && *slot.station_id != station_id)
      return core::Error{
          core::Errc::conflict,
          fmt::format("{} has trials at another station: finish them there, or release them first",
                      participant.name)};
  auto planned = TRY(planned_of(tx, id.text(), participant.name));
  Taken out{.slots = {}, .unfinished = open.size(), .planned = planned};
  open.resize(std::min<std::size_t>(open.size(), static_cast<std::size_t>(ahead)));
  for (Slot& slot : open) TRY(give(tx, slot, station_id, stamp));
  out.slots = std::move(open);
  return out;
}

core::Result<std::uint64_t> release_slots(Writing& tx, const SeriesId& id,
                                          const std::string& participant, const AuditStamp& stamp) {
  auto held =
      TRY(slots_where(tx, "where k.study_id = ? and k.participant = ? and k.state = 'taken'",
                      {id.text(), participant}));
  for (const Slot& slot : held) TRY(release_slot(tx, slot, stamp));
  return held.size();
}

core::Result<void> release_unstarted_slot(Writing& tx, const Slot& slot,
                                          const std::string& station_id, const AuditStamp& stamp) {
  if (slot.state != SlotState::taken || slot.station_id != station_id) return {};
  auto announced = TRY(tx.query("select count(*) from study_trials where slot_id = ?", {slot.id}));
  if (announced.front().integer(0) > 0) return {};
  return release_slot(tx, slot, stamp);
}

core::Result<std::optional<Slot>> slot_of(Reading& tx, const std::string& slot_id) {
  return first(slots_where(tx, "where k.id = ?", {slot_id}));
}

core::Result<bool> was_handed_to(Reading& tx, const Slot& slot, const std::string& station_name) {
  auto rows = TRY(
      tx.query("select count(*) from study_events where slot_id = ? and what = 'taken' and who = ?",
               {slot.id, station_name}));
  return rows.front().integer(0) > 0;
}

core::Result<std::optional<Slot>> slot_of_trial(Reading& tx, const std::string& trial_id) {
  return first(
      slots_where(tx, "join study_trials t on t.slot_id = k.id where t.trial_id = ?", {trial_id}));
}

core::Result<std::optional<StudyTrial>> study_trial_of(Reading& tx, const std::string& trial_id) {
  return one_of(tx.query("select trial_id, slot_id, state, reason, changed_utc_us from "
                         "study_trials where trial_id = ?",
                         {trial_id}),
                judged_trial_from);
}

core::Result<void> announce_for_slot(Writing& tx, const std::string& trial_id,
                                     const std::string& slot_id, std::int64_t now_utc_us) {
  return done(
      tx.query("insert into study_trials (trial_id, slot_id, state, reason, changed_utc_us) "
               "values (?, ?, 'arriving', '', ?)",
               {trial_id, slot_id, now_utc_us}));
}

core::Result<std::string> drilling_of(Reading& tx, const std::string& slot_id) {
  auto rows = TRY(tx.query(
      "select trial_id from study_trials where slot_id = ? and state = 'counts' and tool = 'burr'",
      {slot_id}));
  return rows.empty() ? std::string() : rows.front().text(0);
}

core::Result<void> record_for_slot(Writing& tx, const std::string& trial_id, bool complete,
                                   const AuditStamp& stamp, const Tool& tool) {
  auto found = TRY(slot_of_trial(tx, trial_id));
  if (!found) return {};
  const Slot& slot = *found;
  auto drilling = TRY(drilling_of(tx, slot.id));
  const Judged what = judged(slot, complete, tool, drilling);
  AuditStamp said = stamp;
  if (!what.reason.empty()) said.reason = what.reason;
  TRY(set_trial(tx, trial_id, what.state, said));
  TRY(tx.query("update study_trials set tool = ? where trial_id = ?",
               {name_value(tool.burr ? trial::Tool::burr : trial::Tool::probe), trial_id}));
  const bool counts = what.state == StudyTrialState::counts, to_be_felt = slot.planned && tool.burr;
  const std::string event = !counts      ? std::string(core::name(what.state))
                            : to_be_felt ? "drilled"
                                         : "recorded";
  TRY(add_study_event(tx, slot.study_id, said, event, &slot, trial_id));
  if (what.state == StudyTrialState::invalid) return close_and_repeat(tx, slot, tool, said);
  if (!counts || to_be_felt) return {};
  TRY(set_slot(tx, slot.id, SlotState::recorded, slot.station_id, stamp.at_utc_us));
  return note_progress(tx, slot.study_id, slot.participant);
}

core::Result<void> set_trial_invalid(Writing& tx, const SeriesId& id, const std::string& trial_id,
                                     const AuditStamp& stamp) {
  auto slot = TRY(slot_of_trial(tx, trial_id));
  if (!slot || slot->study_id != id.text())
    return core::Error{core::Errc::not_found,
                       fmt::format("study {} has no trial {}", id.text(), trial_id.substr(0, 32))};
  auto trial = TRY(tx.query("select state, tool from study_trials where trial_id = ?", {trial_id}));
  const auto state = TRY(trial.front().word<StudyTrialState>(0, "study_trials.state"));
  if (state != StudyTrialState::counts)
    return core::Error{core::Errc::conflict,
                       fmt::format("trial {} already does not count", trial_id)};
  const auto with = TRY(trial.front().word<trial::Tool>(1, "study_trials.tool"));
  const Tool tool{.burr = with == trial::Tool::burr};
  TRY(set_trial(tx, trial_id, StudyTrialState::invalid, stamp));
  TRY(add_study_event(tx, id.text(), stamp, "invalid", &*slot, trial_id));
  if (tool.burr) TRY(discount(tx, *slot, stamp));
  return close_and_repeat(tx, *slot, tool, stamp);
}

core::Result<std::vector<StudyTrial>> study_trials(Reading& tx, const SeriesId& id) {
  return all_of(
      tx.query(
          "select x.trial_id, x.slot_id, x.state, x.reason, x.changed_utc_us, s.name, "
          "t.duration_s, "
          "t.samples, t.started_utc_us, t.sha256, t.correct, t.state, x.tool from study_trials x "
          "join study_slots k on k.id = x.slot_id join uploads u on u.trial_id = x.trial_id "
          "join stations s on s.id = u.station_id left join trials t on t.id = x.trial_id "
          "where k.study_id = ? order by x.changed_utc_us, x.trial_id",
          {id.text()}),
      study_trial_from);
}

}  // namespace store
}  // namespace tractus
