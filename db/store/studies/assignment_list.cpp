#include "db/store/studies/assignment_list.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

std::optional<std::int64_t> integer_or_null(const Row& row, std::size_t column) {
  const auto* held = std::get_if<std::int64_t>(&row.value(column));
  return held ? std::optional(*held) : std::nullopt;
}

std::vector<ListFilter> assignment_filters(const std::string& finished) {
  return {{"state",
           "Only assignments with trials still to be done (unfinished), or without (finished); for "
           "a trainee only the own trials count",
           // Not by an index: few columns' values are as common as these two.
           {{"unfinished", finished + " + 0 = 0"}, {"finished", finished + " + 0 = 1"}}},
          {"release",
           "Only assignments whose results trainees see: held = not yet, released = now, at_once = "
           "as soon as a trial is uploaded",
           choices_of<Release>("e.release")}};
}

/// @param finished  the column that tells whether there is nothing left to do
ListShape shape_of(const std::string& from, const std::string& finished) {
  using enum ColumnType;
  const OrderColumn key{"e.study_id"}, due{"e.due_utc_us", integer};
  return {.from = from,
          .searched = "e.words",
          .orders = {{"urgency", {{finished, integer}, due, key}},
                     {"due", {due, key}},
                     {"made", {{"e.made_utc_us", integer}, key}, true},
                     {"title", {{"e.title"}, key}},
                     {"cohort", {{"e.cohort_name"}, key}}},
          .filters = assignment_filters(finished)};
}

const ListShape& own_list() {
  static const ListShape kShape = shape_of(
      "assigned_progress p join assignment_entries e on e.study_id = p.study_id", "p.finished");
  return kShape;
}

std::string led_sql(const std::string& maker, const std::string& cohort) {
  return " and (" + maker + " = ? or " + cohort +
         " in (select cohort_id from cohort_people where account_id = ? and part = 'faculty'))";
}

Reach assignments_reached(const AssignmentFilter& whose) {
  Reach out;
  if (!whose.done_by.empty()) {
    out.sql = out.walked = " and p.account_id = ?";
    out.values = {whose.done_by};
  }
  if (whose.led_by.empty()) return out;
  out.sql += led_sql("e.made_by_id", "e.cohort_id");
  out.walked += led_sql("coalesce(e.made_by_id, '')", "coalesce(e.cohort_id, '')");
  out.values.insert(out.values.end(), {whose.led_by, whose.led_by});
  return out;
}

}  // namespace

const char* const kAssignment =
    "select a.study_id, s.title, s.state, s.ordering, s.repeats, s.seed, s.on_invalid, "
    "s.made_utc_us, s.made_by, a.cohort_id, a.due_utc_us, a.release, a.made_by_id, "
    "coalesce(c.name, ''), (select count(*) from assignment_people p where p.study_id = "
    "a.study_id), (select count(*) from study_slots k join assignment_people p on p.study_id = "
    "k.study_id and p.participant = k.participant where k.study_id = a.study_id and k.state = "
    "'recorded' and (? = '' or p.account_id = ?)), (select count(*) from study_slots k join "
    "assignment_people p on p.study_id = k.study_id and p.participant = k.participant where "
    "k.study_id = a.study_id and k.state <> 'invalid' and (? = '' or p.account_id = ?)), (select "
    "count(*) from study_slots k join cases d on d.id = k.case_id join assignment_people p on "
    "p.study_id = k.study_id and p.participant = k.participant where k.study_id = a.study_id and "
    "k.state <> 'invalid' and d.planned = 1 and (? = '' or p.account_id = ?)) "
    "from assignments a join studies s on s.id = a.study_id left join cohorts c on c.id = "
    "a.cohort_id ";

const char* const kAssignmentReached =
    "(? = '' or a.made_by_id = ? or exists (select 1 from cohort_people f where f.cohort_id = "
    "a.cohort_id and f.account_id = ? and f.part = 'faculty')) and (? = '' or exists (select 1 "
    "from "
    "assignment_people p where p.study_id = a.study_id and p.account_id = ?))";

core::Result<Assignment> assignment_from(const Row& row) {
  auto study = TRY(study_from(row));
  const auto release = TRY(row.word<Release>(11, "assignments.release"));
  return Assignment{.study = std::move(study),
                    .cohort_id = row.text_or_null(9),
                    .due_utc_us = integer_or_null(row, 10),
                    .release = release,
                    .made_by_id = row.text(12),
                    .cohort_name = row.text(13),
                    .people = row.count(14),
                    .done = row.count(15),
                    .planned = row.count(16),
                    .to_drill = row.count(17)};
}

core::Result<void> add_assignment_entry(Writing& tx, const std::string& study_id) {
  return done(tx.query(
      "insert into assignment_entries (study_id, finished, due_utc_us, made_utc_us, title, "
      "cohort_name, release, made_by_id, cohort_id, words) select a.study_id, 1, "
      "coalesce(a.due_utc_us, ?), s.made_utc_us, s.title, coalesce(c.name, ''), a.release, "
      "a.made_by_id, a.cohort_id, s.title || ' ' || coalesce(c.name, '') || ' ' || s.made_by from "
      "assignments a join studies s on s.id = a.study_id left join cohorts c on c.id = a.cohort_id "
      "where a.study_id = ?",
      {kNeverDue_utc_us, study_id}));
}

core::Result<void> note_progress(Writing& tx, const std::string& series_id,
                                 const std::string& participant) {
  TRY(tx.query(
      "update assigned_progress set finished = case when exists (select 1 from study_slots k where "
      "k.study_id = ? and k.participant = ? and k.state in ('waiting', 'taken')) then 0 else 1 end "
      "where study_id = ? and participant = ?",
      {series_id, participant, series_id, participant}));
  return done(tx.query(
      "update assignment_entries set finished = case when exists (select 1 from study_slots k "
      "where "
      "k.study_id = ? and k.state in ('waiting', 'taken')) then 0 else 1 end where study_id = ?",
      {series_id, series_id}));
}

const ListShape& assignment_list() {
  static const ListShape kShape = shape_of("assignment_entries e", "e.finished");
  return kShape;
}

core::Result<FoundAssignments> find_assignments(Reading& tx, const ListRequest& request,
                                                const AssignmentFilter& whose) {
  const std::string &me = whose.done_by, &leader = whose.led_by;
  const ListShape& shape = me.empty() ? assignment_list() : own_list();
  auto found = TRY(find_keys(tx, shape, request, assignments_reached(whose)));
  const SqlPart select{std::string(kAssignment) + "where a.study_id in", {me, me, me, me, me, me}};
  const SqlPart reached{std::string(" and ") + kAssignmentReached,
                        {leader, leader, leader, me, me}};
  auto assignments = TRY(all_of(rows_of_keys(tx, select, found.keys, reached), assignment_from));
  return FoundAssignments{std::move(assignments), std::move(found.page)};
}

}  // namespace store
}  // namespace tractus
