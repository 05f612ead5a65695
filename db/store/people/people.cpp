#include "db/store/people/people.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

core::Result<bool> any(const core::Result<Rows>& rows) {
  if (!rows) return rows.error();
  return !rows->empty();
}

/// An assignment's trial `t.trial_id` and the account `p.account_id` that did it.
constexpr const char* kAssignedTrial =
    "study_trials t join study_slots s on s.id = t.slot_id join assignment_people p on "
    "p.study_id = s.study_id and p.participant = s.participant ";

constexpr const char* kCohort =
    "select c.id, c.name, c.made_utc_us, c.made_by, (select count(*) from cohort_people p where "
    "p.cohort_id = c.id and p.part = 'trainee') from cohorts c ";

Cohort cohort_from(const Row& row) {
  return {row.text(0), row.text(1), row.integer(2), row.text(3), row.count(4)};
}

core::Result<CohortPerson> person_from(const Row& row) {
  const auto role = TRY(row.word<Role>(2, "accounts.role"));
  const auto part = TRY(row.word<CohortPart>(3, "cohort_people.part"));
  const auto state = TRY(row.word<AccountState>(4, "accounts.state"));
  return CohortPerson{row.text(0), row.text(1), role, part, state, row.text(5)};
}

}  // namespace

core::Result<void> add_cohort(Writing& tx, const Cohort& cohort) {
  auto added =
      done(tx.query("insert into cohorts (id, name, made_utc_us, made_by) values (?, ?, ?, ?)",
                    {cohort.id, cohort.name, cohort.made_utc_us, cohort.made_by}));
  if (!added && added.error().code == core::Errc::conflict)
    return core::Error{core::Errc::conflict, "a cohort named " + cohort.name + " exists already"};
  return added;
}

core::Result<std::optional<Cohort>> cohort_of(Reading& tx, const std::string& id) {
  auto rows = TRY(tx.query(std::string(kCohort) + "where c.id = ?", {id}));
  if (rows.empty()) return std::optional<Cohort>();
  return std::optional(cohort_from(rows.front()));
}

core::Result<std::vector<Cohort>> cohorts_of(Reading& tx, const std::string& account_id) {
  auto rows = TRY(tx.query(std::string(kCohort) +
                               "where ? = '' or exists (select 1 from cohort_people p where "
                               "p.cohort_id = c.id and p.account_id = ?) order by c.name",
                           {account_id, account_id}));
  std::vector<Cohort> out;
  for (const Row& row : rows) out.push_back(cohort_from(row));
  return out;
}

core::Result<std::vector<CohortPerson>> people_of(Reading& tx, const std::string& cohort_id) {
  return all_of(
      tx.query(
          "select a.id, a.name, a.role, p.part, a.state, coalesce(a.pseudonym, '') from "
          "cohort_people p join accounts a on a.id = p.account_id where p.cohort_id = ? order by "
          "a.name",
          {cohort_id}),
      person_from);
}

core::Result<void> put_into_cohort(Writing& tx, const std::string& cohort_id,
                                   const std::string& account_id, CohortPart part,
                                   std::int64_t now_utc_us) {
  return done(
      tx.query("insert into cohort_people (cohort_id, account_id, part, since_utc_us) values "
               "(?, ?, ?, ?) on conflict (cohort_id, account_id) do update set part = ?",
               {cohort_id, account_id, name_value(part), now_utc_us, name_value(part)}));
}

core::Result<void> take_from_cohort(Writing& tx, const std::string& cohort_id,
                                    const std::string& account_id) {
  return done(tx.query("delete from cohort_people where cohort_id = ? and account_id = ?",
                       {cohort_id, account_id}));
}

core::Result<bool> leads_cohort(Reading& tx, const std::string& account_id,
                                const std::string& cohort_id) {
  return any(tx.query(
      "select 1 from cohort_people where cohort_id = ? and account_id = ? and part = 'faculty'",
      {cohort_id, account_id}));
}

core::Result<bool> is_in_cohort(Reading& tx, const std::string& account_id,
                                const std::string& cohort_id) {
  return any(tx.query("select 1 from cohort_people where cohort_id = ? and account_id = ?",
                      {cohort_id, account_id}));
}

core::Result<bool> teaches(Reading& tx, const std::string& account_id,
                           const std::string& trainee_id) {
  return any(
      tx.query("select 1 from cohort_people t join cohort_people f on f.cohort_id = t.cohort_id "
               "where t.account_id = ? and t.part = 'trainee' and f.account_id = ? and f.part = "
               "'faculty' limit 1",
               {trainee_id, account_id}));
}

core::Result<bool> leads_with(Reading& tx, const std::string& account_id,
                              const std::string& person_id) {
  return any(
      tx.query("select 1 from cohort_people p join cohort_people f on f.cohort_id = p.cohort_id "
               "where p.account_id = ? and f.account_id = ? and f.part = 'faculty' limit 1",
               {person_id, account_id}));
}

core::Result<bool> teaches_trial(Reading& tx, const std::string& account_id,
                                 const std::string& trial_id) {
  return any(tx.query(std::string("select 1 from ") + kAssignedTrial +
                          "join cohort_people c on c.account_id = p.account_id and c.part = "
                          "'trainee' join cohort_people f on f.cohort_id = c.cohort_id and f.part "
                          "= 'faculty' where t.trial_id = ? and f.account_id = ? limit 1",
                      {trial_id, account_id}));
}

core::Result<bool> sees_own_trial(Reading& tx, const std::string& account_id,
                                  const std::string& trial_id) {
  return any(tx.query(std::string("select 1 from ") + kAssignedTrial +
                          "join assignments a on a.study_id = s.study_id where t.trial_id = ? and "
                          "p.account_id = ? and a.release <> 'held' limit 1",
                      {trial_id, account_id}));
}

core::Result<bool> sees_own_case(Reading& tx, const std::string& account_id,
                                 const std::string& case_id) {
  return any(tx.query(std::string("select 1 from ") + kAssignedTrial +
                          "join assignments a on a.study_id = s.study_id where s.case_id = ? and "
                          "p.account_id = ? and a.release <> 'held' limit 1",
                      {case_id, account_id}));
}

core::Result<bool> leads_assignment(Reading& tx, const std::string& account_id,
                                    const std::string& assignment_id) {
  return any(tx.query(
      "select 1 from assignments a where a.study_id = ? and (a.made_by_id = ? or exists (select 1 "
      "from cohort_people f where f.cohort_id = a.cohort_id and f.account_id = ? and f.part = "
      "'faculty'))",
      {assignment_id, account_id, account_id}));
}

core::Result<bool> has_assignment(Reading& tx, const std::string& account_id,
                                  const std::string& assignment_id) {
  return any(tx.query("select 1 from assignment_people where study_id = ? and account_id = ?",
                      {assignment_id, account_id}));
}

}  // namespace store
}  // namespace tractus
