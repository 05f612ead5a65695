#include "db/store/studies/studies.hpp"

#include "core/bytes.hpp"
#include "core/require.hpp"
#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kStudy =
    "select s.id, s.title, s.state, s.ordering, s.repeats, s.seed, s.on_invalid, s.made_utc_us, "
    "s.made_by";
constexpr const char* kParticipant =
    "select name, state, level, experience_years, simulated from study_participants ";
constexpr std::size_t kSlotName_bytes = 32;

core::Result<void> done(const core::Result<Rows>& rows) {
  if (!rows) return rows.error();
  return {};
}

Study study_from(const Row& row) {
  return {row.text(0),    row.text(1), row.text(2),    row.text(3), row.integer(4),
          row.integer(5), row.text(6), row.integer(7), row.text(8)};
}

Participant participant_from(const Row& row) {
  return {row.text(0), row.text(1), row.text(2), row.number_or_null(3), row.truth(4)};
}

Value text_or_null(const std::string& text) { return text.empty() ? Value() : Value(text); }

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

core::Result<void> add_series(Writing& tx, const Study& study, const std::string& kind,
                              const std::vector<std::string>& case_ids, const AuditStamp& stamp) {
  auto added = tx.query(
      "insert into studies (id, title, state, ordering, repeats, seed, on_invalid, made_utc_us, "
      "made_by, kind) values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {study.id, study.title, study.state, study.ordering, study.repeats, study.seed,
       study.on_invalid, stamp.at_utc_us, stamp.who, kind});
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
  TRY(add_series(tx, study, "study", case_ids, stamp));
  return find_study(tx, study.id);
}

core::Result<void> add_participant(Writing& tx, const SeriesId& id, const Participant& participant,
                                   const std::vector<std::string>& case_order,
                                   const AuditStamp& stamp) {
  TRY(tx.query(
      "insert into study_participants (study_id, name, position, state, level, experience_years, "
      "simulated, enrolled_utc_us) values (?, ?, (select count(*) from study_participants where "
      "study_id = ?), ?, ?, ?, ?, ?)",
      {id.text(), participant.name, id.text(), participant.state, participant.level,
       or_null(participant.experience_years), bool_value(participant.simulated), stamp.at_utc_us}));
  TRY(add_slots(tx, id.text(), participant.name, case_order, stamp));
  return add_study_event(tx, id.text(), stamp, "enrolled", nullptr, {}, participant.name);
}

core::Result<void> set_study_state(Writing& tx, const StudyId& id, const std::string& state,
                                   const AuditStamp& stamp) {
  TRY(tx.query("update studies set state = ? where id = ?", {state, id.text()}));
  return add_study_event(tx, id.text(), stamp, state);
}

core::Result<void> set_participant_state(Writing& tx, const StudyId& id, const std::string& name,
                                         const std::string& state, const AuditStamp& stamp) {
  TRY(tx.query("update study_participants set state = ? where study_id = ? and name = ?",
               {state, id.text(), name}));
  return add_study_event(tx, id.text(), stamp, state, nullptr, {}, name);
}

core::Result<std::vector<StudySummary>> all_studies(Reading& tx) {
  auto rows = TRY(tx.query(
      std::string(kStudy) +
      ", (select count(*) from study_participants p where p.study_id = s.id), "
      "(select count(*) from study_slots k where k.study_id = s.id and k.state = 'recorded'), "
      "(select count(*) from study_slots k where k.study_id = s.id and k.state <> 'invalid') "
      "from studies s where s.kind = 'study' "
      "order by s.made_utc_us desc, s.id"));
  std::vector<StudySummary> out;
  for (const Row& row : rows)
    out.push_back({study_from(row), row.count(9), row.count(10), row.count(11)});
  return out;
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
  auto rows = TRY(tx.query(std::string(kParticipant) + "where study_id = ? order by position, name",
                           {id.text()}));
  std::vector<Participant> out;
  for (const Row& row : rows) out.push_back(participant_from(row));
  return out;
}

core::Result<std::optional<Participant>> participant_of(Reading& tx, const SeriesId& id,
                                                        const std::string& name) {
  auto rows = TRY(
      tx.query(std::string(kParticipant) + "where study_id = ? and name = ?", {id.text(), name}));
  if (rows.empty()) return std::optional<Participant>();
  return std::optional(participant_from(rows.front()));
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
