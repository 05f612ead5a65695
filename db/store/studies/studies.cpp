#include "db/store/studies/studies.hpp"

#include "core/bytes.hpp"
#include "core/require.hpp"
#include "core/try.hpp"
#include "db/store/rows.hpp"
#include "db/store/studies/assignment_list.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kStudy =
    "select s.id, s.title, s.state, s.ordering, s.repeats, s.seed, s.on_invalid, s.made_utc_us, "
    "s.made_by";
constexpr const char* kParticipant =
    "select name, state, level, experience_years, simulated from study_participants ";
constexpr std::size_t kSlotName_bytes = 32;

core::Result<StudySummary> study_summary_from(const Row& row) {
  auto study = TRY(study_from(row));
  return StudySummary{std::move(study), row.count(9), row.count(10), row.count(11)};
}

core::Result<Participant> participant_from(const Row& row) {
  const auto state = TRY(row.word<StudyState>(1, "study_participants.state"));
  return Participant{row.text(0), state, row.text(2), row.number_or_null(3), row.truth(4)};
}

core::Result<void> add_slots(Writing& tx, const std::string& study_id, const std::string& name,
                             const std::vector<std::string>& case_order, const AuditStamp& stamp) {
  for (std::size_t i = 0; i < case_order.size(); ++i) {
    TRY(tx.query(
        "insert into study_slots (id, study_id, participant, position, attempt, case_id, state, "
        "changed_utc_us) values (?, ?, ?, ?, 0, ?, 'waiting', ?)",
        {core::hex(core::random_bytes(kSlotName_bytes)), study_id, name,
         static_cast<std::int64_t>(i), case_order[i], stamp.at_utc_us}));
  }
  return {};
}

}  // namespace

core::Result<Study> study_from(const Row& row) {
  const auto state = TRY(row.word<StudyState>(2, "studies.state"));
  const auto ordering = TRY(row.word<CaseOrder>(3, "studies.ordering"));
  const auto on_invalid = TRY(row.word<Repetition>(6, "studies.on_invalid"));
  return Study{row.text(0),    row.text(1), state,          ordering,   row.integer(4),
               row.integer(5), on_invalid,  row.integer(7), row.text(8)};
}

core::Result<void> add_study_event(Writing& tx, const std::string& series_id,
                                   const AuditStamp& stamp, const std::string& what,
                                   const Slot* slot, const std::string& trial_id,
                                   const std::string& participant) {
  return done(tx.query(
      "insert into study_events (study_id, number, at_utc_us, who, what, participant, slot_id, "
      "trial_id, reason) values (?, (select count(*) + 1 from study_events where study_id = ?), ?, "
      "?, ?, ?, ?, ?, ?)",
      {series_id, series_id, stamp.at_utc_us, stamp.who, what,
       text_or_null(slot ? slot->participant : participant), slot ? Value(slot->id) : Value(),
       text_or_null(trial_id), stamp.reason}));
}

core::Result<void> add_series(Writing& tx, const Study& study, SeriesKind kind,
                              const std::vector<std::string>& case_ids, const AuditStamp& stamp) {
  auto added = tx.query(
      "insert into studies (id, title, state, ordering, repeats, seed, on_invalid, made_utc_us, "
      "made_by, kind) values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {study.id, study.title, name_value(study.state), name_value(study.ordering), study.repeats,
       study.seed, name_value(study.on_invalid), stamp.at_utc_us, stamp.who, name_value(kind)});
  if (!added) return added.error();
  for (std::size_t i = 0; i < case_ids.size(); ++i) {
    added = tx.query("insert into study_scenarios (study_id, position, case_id) values (?, ?, ?)",
                     {study.id, static_cast<std::int64_t>(i), case_ids[i]});
    if (!added) return added.error();
  }
  return add_study_event(tx, study.id, stamp, "made");
}

core::Result<StudyId> add_study(Writing& tx, const Study& study,
                                const std::vector<std::string>& case_ids, const AuditStamp& stamp) {
  TRY(add_series(tx, study, SeriesKind::study, case_ids, stamp));
  return find_study(tx, study.id);
}

core::Result<void> add_participant(Writing& tx, const SeriesId& id, const Participant& participant,
                                   const std::vector<std::string>& case_order,
                                   const AuditStamp& stamp) {
  TRY(tx.query(
      "insert into study_participants (study_id, name, position, state, level, experience_years, "
      "simulated, enrolled_utc_us) values (?, ?, (select count(*) from study_participants where "
      "study_id = ?), ?, ?, ?, ?, ?)",
      {id.text(), participant.name, id.text(), name_value(participant.state), participant.level,
       or_null(participant.experience_years), bool_value(participant.simulated), stamp.at_utc_us}));
  TRY(add_slots(tx, id.text(), participant.name, case_order, stamp));
  TRY(note_progress(tx, id.text(), participant.name));
  return add_study_event(tx, id.text(), stamp, "enrolled", nullptr, {}, participant.name);
}

core::Result<void> set_study_state(Writing& tx, const StudyId& id, StudyState state,
                                   const AuditStamp& stamp) {
  TRY(tx.query("update studies set state = ? where id = ?", {name_value(state), id.text()}));
  return add_study_event(tx, id.text(), stamp, std::string(core::name(state)));
}

core::Result<void> set_participant_state(Writing& tx, const StudyId& id, const std::string& name,
                                         StudyState state, const AuditStamp& stamp) {
  TRY(tx.query("update study_participants set state = ? where study_id = ? and name = ?",
               {name_value(state), id.text(), name}));
  return add_study_event(tx, id.text(), stamp, std::string(core::name(state)), nullptr, {}, name);
}

core::Result<std::vector<StudySummary>> all_studies(Reading& tx) {
  return all_of(
      tx.query(
          std::string(kStudy) +
          ", (select count(*) from study_participants p where p.study_id = s.id), "
          "(select count(*) from study_slots k where k.study_id = s.id and k.state = 'recorded'), "
          "(select count(*) from study_slots k where k.study_id = s.id and k.state <> 'invalid') "
          "from studies s where s.kind = 'study' "
          "order by s.made_utc_us desc, s.id"),
      study_summary_from);
}

core::Result<Study> study_of(Reading& tx, const SeriesId& id) {
  auto rows = TRY(tx.query(std::string(kStudy) + " from studies s where s.id = ?", {id.text()}));
  core::require(!rows.empty(), "who has the id of a series has looked it up");
  return study_from(rows.front());
}

core::Result<std::vector<StudyScenario>> study_scenarios(Reading& tx, const SeriesId& id) {
  auto rows = TRY(
      tx.query("select k.case_id, c.title from study_scenarios k join cases c on c.id = k.case_id "
               "where k.study_id = ? order by k.position",
               {id.text()}));
  std::vector<StudyScenario> out;
  for (const Row& row : rows) out.push_back({row.text(0), row.text(1)});
  return out;
}

core::Result<std::vector<Participant>> study_participants(Reading& tx, const SeriesId& id) {
  return all_of(tx.query(std::string(kParticipant) + "where study_id = ? order by position, name",
                         {id.text()}),
                participant_from);
}

core::Result<std::optional<Participant>> participant_of(Reading& tx, const SeriesId& id,
                                                        const std::string& name) {
  return one_of(
      tx.query(std::string(kParticipant) + "where study_id = ? and name = ?", {id.text(), name}),
      participant_from);
}

core::Result<std::vector<StudyEvent>> study_events(Reading& tx, const StudyId& id,
                                                   std::int64_t limit) {
  auto rows = TRY(tx.query(
      "select at_utc_us, who, what, participant, slot_id, trial_id, reason from study_events "
      "where study_id = ? order by number desc limit ?",
      {id.text(), limit}));
  std::vector<StudyEvent> out;
  for (const Row& row : rows)
    out.push_back({row.integer(0), row.text(1), row.text(2), row.text_or_null(3),
                   row.text_or_null(4), row.text_or_null(5), row.text(6)});
  return out;
}

}  // namespace store
}  // namespace tractus
