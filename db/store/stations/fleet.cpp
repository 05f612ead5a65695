#include "db/store/stations/fleet.hpp"

#include <fmt/format.h>

#include "core/clock.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/rows.hpp"
#include "db/store/studies/study_slots.hpp"

namespace tractus {
namespace store {
core::Result<void> set_station_last(Writing& tx, const StationLast& last) {
  return done(tx.query(
      "insert into station_states (station_id, seen_utc_us, told) values (?, ?, ?) on conflict "
      "(station_id) do update set seen_utc_us = excluded.seen_utc_us, told = excluded.told",
      {last.station_id, last.seen_utc_us, last.told}));
}

core::Result<std::vector<StationLast>> stations_last(Reading& tx) {
  auto rows = TRY(tx.query("select station_id, seen_utc_us, told from station_states"));
  std::vector<StationLast> out;
  for (const Row& row : rows) out.push_back({row.text(0), row.integer(1), row.text(2)});
  return out;
}

core::Result<void> add_station_note(Writing& tx, const StationNote& note, std::int64_t now_utc_us) {
  auto today = TRY(
      tx.query("select count(*) from station_reports where station_id = ? and received_utc_us > ?",
               {note.station_id, now_utc_us - core::kDay_us}));
  if (today.front().integer(0) >= kMostNotesADay)
    return core::Error{
        core::Errc::unavailable,
        fmt::format("this station sent {} reports within a day: no more are accepted today",
                    kMostNotesADay)};
  return done(tx.query(
      "insert into station_reports (station_id, kind, at_utc_us, received_utc_us, body) values "
      "(?, ?, ?, ?, ?) on conflict (station_id, kind, at_utc_us) do nothing",
      {note.station_id, name_value(note.kind), note.at_utc_us, now_utc_us, note.body}));
}

core::Result<std::vector<StationNote>> station_notes(Reading& tx, const std::string& station_id,
                                                     NoteKind kind, std::int64_t limit) {
  auto rows = TRY(tx.query(
      "select at_utc_us, body from station_reports where station_id = ? and kind = ? order by "
      "at_utc_us desc limit ?",
      {station_id, name_value(kind), limit}));
  std::vector<StationNote> out;
  for (const Row& row : rows) out.push_back({station_id, kind, row.integer(0), row.text(1)});
  return out;
}

core::Result<void> add_trial_clock(Writing& tx, const std::string& trial_id,
                                   const TrialClock& clock) {
  return done(
      tx.query("insert into trial_clocks (trial_id, offset_s, error_s) values (?, ?, ?) on "
               "conflict (trial_id) do nothing",
               {trial_id, clock.offset_s, clock.error_s}));
}

core::Result<std::optional<TrialClock>> trial_clock_of(Reading& tx, const std::string& trial_id) {
  auto rows =
      TRY(tx.query("select offset_s, error_s from trial_clocks where trial_id = ?", {trial_id}));
  if (rows.empty()) return std::optional<TrialClock>();
  return std::optional(TrialClock{rows.front().number(0), rows.front().number(1)});
}

namespace {

core::Result<void> add_teachers(Reading& tx, ShownTrial& out) {
  auto rows = TRY(tx.query(
      "select distinct f.account_id from cohort_people t join cohort_people f on f.cohort_id = "
      "t.cohort_id where t.account_id = ? and t.part = 'trainee' and f.part = 'faculty'",
      {out.account_id}));
  for (const Row& row : rows) out.teachers.insert(row.text(0));
  return {};
}

core::Result<ShownTrial> shown_slot(Reading& tx, const Slot& slot) {
  ShownTrial out;
  auto person = TRY(tx.query(
      "select a.id, a.name from assignment_people p join accounts a on a.id = p.account_id where "
      "p.study_id = ? and p.participant = ?",
      {slot.study_id, slot.participant}));
  if (person.empty()) {
    out.person = slot.participant;
    return out;
  }
  out.account_id = person.front().text(0);
  out.person = person.front().text(1);
  auto name = TRY(tx.query("select name from assignment_names where study_id = ? and case_id = ?",
                           {slot.study_id, slot.case_id}));
  if (!name.empty()) out.case_title = name.front().text(0);
  TRY(add_teachers(tx, out));
  return out;
}

}  // namespace

core::Result<ShownTrial> shown_trial(Reading& tx, const std::string& station_id,
                                     const std::string& case_id) {
  auto slot = TRY(slot_of(tx, case_id));
  if (slot) {
    if (slot->station_id != station_id) return ShownTrial{};
    return shown_slot(tx, *slot);
  }
  auto known = TRY(case_of(tx, case_id));
  ShownTrial out;
  if (known && known->kind == trial::Rig::palpation) out.case_title = known->title;
  return out;
}

}  // namespace store
}  // namespace tractus
