#include "db/store/studies/criteria.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kCriteria =
    "select k.kind, k.subject, k.version, k.definition, k.reason, k.made_utc_us, k.made_by, "
    "coalesce(c.title, s.title, '') from criteria k left join cases c on k.kind = 'case' and c.id "
    "= "
    "k.subject left join studies s on k.kind = 'assignment' and s.id = k.subject ";
constexpr const char* kCurriculum =
    "select id, version, title, definition, reason, made_utc_us, made_by from curricula ";

core::Result<CriteriaVersion> criteria_from(const Row& row) {
  const auto kind = TRY(row.word<CriteriaKind>(0, "criteria.kind"));
  return CriteriaVersion{.kind = kind,
                         .subject = row.text(1),
                         .version = row.integer(2),
                         .definition = row.text(3),
                         .reason = row.text(4),
                         .made_utc_us = row.integer(5),
                         .made_by = row.text(6),
                         .title = row.text(7)};
}

core::Result<CurriculumVersion> curriculum_from(const Row& row) {
  return CurriculumVersion{row.text(0), row.integer(1), row.text(2), row.text(3),
                           row.text(4), row.integer(5), row.text(6)};
}

core::Result<CurriculumAssignment> curriculum_assignment_from(const Row& row) {
  return CurriculumAssignment{row.text(0), row.text(1), row.integer(2), row.text(3)};
}

}  // namespace

core::Result<void> add_criteria(Writing& tx, const CriteriaVersion& of) {
  const auto before = TRY(criteria_of(tx, of.kind, of.subject));
  return done(tx.query(
      "insert into criteria (kind, subject, version, definition, reason, made_utc_us, made_by) "
      "values (?, ?, ?, ?, ?, ?, ?)",
      {name_value(of.kind), of.subject, std::int64_t(before.size()) + 1, of.definition, of.reason,
       of.made_utc_us, of.made_by}));
}

core::Result<std::vector<CriteriaVersion>> criteria_of(Reading& tx, CriteriaKind kind,
                                                       const std::string& subject) {
  return all_of(
      tx.query(std::string(kCriteria) + "where k.kind = ? and k.subject = ? order by k.version",
               {name_value(kind), subject}),
      criteria_from);
}

core::Result<std::vector<CriteriaVersion>> all_criteria(Reading& tx) {
  return all_of(tx.query(std::string(kCriteria) + "order by k.kind desc, 8, k.subject, k.version"),
                criteria_from);
}

core::Result<std::int64_t> add_curriculum(Writing& tx, const CurriculumVersion& of) {
  const auto before = TRY(curriculum_versions(tx, of.id));
  const std::int64_t version = std::int64_t(before.size()) + 1;
  TRY(tx.query(
      "insert into curricula (id, version, title, definition, reason, made_utc_us, made_by) values "
      "(?, ?, ?, ?, ?, ?, ?)",
      {of.id, version, of.title, of.definition, of.reason, of.made_utc_us, of.made_by}));
  return version;
}

core::Result<std::vector<CurriculumVersion>> all_curricula(Reading& tx) {
  return all_of(tx.query(std::string(kCurriculum) + "order by id, version"), curriculum_from);
}

core::Result<std::vector<CurriculumVersion>> curriculum_versions(Reading& tx,
                                                                 const std::string& id) {
  return all_of(tx.query(std::string(kCurriculum) + "where id = ? order by version", {id}),
                curriculum_from);
}

core::Result<void> add_curriculum_assignment(Writing& tx, const CurriculumAssignment& of) {
  return done(
      tx.query("insert into curriculum_steps (study_id, curriculum_id, version, step_id) values "
               "(?, ?, ?, ?)",
               {of.study_id, of.curriculum_id, of.version, of.step_id}));
}

core::Result<std::vector<CurriculumAssignment>> curriculum_assignments(
    Reading& tx, const std::string& account_id) {
  return all_of(
      tx.query("select k.study_id, k.curriculum_id, k.version, k.step_id from curriculum_steps k "
               "where ? = '' or exists (select 1 from assignment_people p where p.study_id = "
               "k.study_id and p.account_id = ?) order by k.curriculum_id, k.version, k.study_id",
               {account_id, account_id}),
      curriculum_assignment_from);
}

}  // namespace store
}  // namespace tractus
