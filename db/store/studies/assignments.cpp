#include "db/store/studies/assignments.hpp"

#include "core/require.hpp"
#include "core/try.hpp"
#include "db/store/rows.hpp"
#include "db/store/studies/assignment_list.hpp"

namespace tractus {
namespace store {

core::Result<AssignmentId> add_assignment(Writing& tx, const Assignment& a,
                                          const std::vector<std::string>& case_ids,
                                          const AuditStamp& stamp) {
  TRY(add_series(tx, a.study, SeriesKind::assignment, case_ids, stamp));
  TRY(done(tx.query(
      "insert into assignments (study_id, cohort_id, due_utc_us, release, made_by_id) values "
      "(?, ?, ?, ?, ?)",
      {a.study.id, or_null(a.cohort_id), or_null(a.due_utc_us), name_value(a.release),
       a.made_by_id})));
  TRY(add_assignment_entry(tx, a.study.id));
  return find_assignment(tx, a.study.id);
}

core::Result<void> set_assigned_name(Writing& tx, const AssignmentId& id,
                                     const std::string& case_id, const std::string& name) {
  return done(tx.query(
      "insert into assignment_names (study_id, case_id, name) values (?, ?, ?) on conflict "
      "(study_id, case_id) do update set name = ?",
      {id.text(), case_id, name, name}));
}

core::Result<std::string> assigned_name(Reading& tx, const AssignmentId& id,
                                        const std::string& case_id) {
  auto rows = TRY(tx.query("select name from assignment_names where study_id = ? and case_id = ?",
                           {id.text(), case_id}));
  return rows.empty() ? std::string() : rows.front().text(0);
}

core::Result<void> add_assigned_person(Writing& tx, const AssignmentId& id,
                                       const std::string& account_id,
                                       const std::string& participant) {
  auto added = done(
      tx.query("insert into assignment_people (study_id, account_id, participant) values (?, ?, ?)",
               {id.text(), account_id, participant}));
  if (!added && added.error().code == core::Errc::conflict)
    return core::Error{core::Errc::conflict, "the assignment already includes this person"};
  TRY(added);
  TRY(
      tx.query("insert into assigned_progress (account_id, study_id, participant, finished) values "
               "(?, ?, ?, 1)",
               {account_id, id.text(), participant}));
  return note_progress(tx, id.text(), participant);
}

core::Result<void> set_release(Writing& tx, const AssignmentId& id, Release release,
                               const AuditStamp& stamp) {
  TRY(done(tx.query("update assignments set release = ? where study_id = ?",
                    {name_value(release), id.text()})));
  TRY(tx.query("update assignment_entries set release = ? where study_id = ?",
               {name_value(release), id.text()}));
  return add_study_event(tx, id.text(), stamp, "results " + std::string(core::name(release)));
}

core::Result<void> set_due(Writing& tx, const AssignmentId& id,
                           const std::optional<std::int64_t>& due_utc_us, const AuditStamp& stamp) {
  TRY(done(tx.query("update assignments set due_utc_us = ? where study_id = ?",
                    {or_null(due_utc_us), id.text()})));
  TRY(tx.query("update assignment_entries set due_utc_us = ? where study_id = ?",
               {due_utc_us.value_or(kNeverDue_utc_us), id.text()}));
  return add_study_event(tx, id.text(), stamp, "due date changed");
}

core::Result<std::vector<Assignment>> assignments_of(Reading& tx, const AssignmentFilter& whose) {
  const std::string &me = whose.done_by, &leader = whose.led_by;
  return all_of(tx.query(std::string(kAssignment) + "where " + kAssignmentReached +
                             " order by a.due_utc_us is null, a.due_utc_us, s.made_utc_us, s.id",
                         {me, me, me, me, me, me, leader, leader, leader, me, me}),
                assignment_from);
}

core::Result<Assignment> assignment_of(Reading& tx, const AssignmentId& id,
                                       const std::string& done_by) {
  auto rows = TRY(tx.query(std::string(kAssignment) + "where a.study_id = ?",
                           {done_by, done_by, done_by, done_by, done_by, done_by, id.text()}));
  core::require(!rows.empty(), "who has an assignment's id has looked it up");
  return assignment_from(rows.front());
}

core::Result<std::vector<AssignmentId>> assignments_of_cohort(Reading& tx,
                                                              const std::string& cohort_id) {
  auto rows = TRY(tx.query("select study_id from assignments where cohort_id = ?", {cohort_id}));
  std::vector<AssignmentId> out;
  for (const Row& row : rows) {
    auto id = TRY(find_assignment(tx, row.text(0)));
    out.push_back(std::move(id));
  }
  return out;
}

core::Result<std::vector<AssignedPerson>> assigned_people(Reading& tx, const AssignmentId& id) {
  auto rows = TRY(tx.query(
      "select p.account_id, u.name, p.participant, (select count(*) from study_slots k where "
      "k.study_id = p.study_id and k.participant = p.participant and k.state = 'recorded'), "
      "(select count(*) from study_slots k where k.study_id = p.study_id and k.participant = "
      "p.participant and k.state <> 'invalid') from assignment_people p join accounts u on u.id = "
      "p.account_id where p.study_id = ? order by u.name",
      {id.text()}));
  std::vector<AssignedPerson> out;
  for (const Row& row : rows)
    out.push_back({row.text(0), row.text(1), row.text(2), row.count(3), row.count(4)});
  return out;
}

core::Result<std::string> participant_for(Reading& tx, const AssignmentId& id,
                                          const std::string& account_id) {
  auto rows = TRY(
      tx.query("select participant from assignment_people where study_id = ? and account_id = ?",
               {id.text(), account_id}));
  return rows.empty() ? std::string() : rows.front().text(0);
}

}  // namespace store
}  // namespace tractus
