/// Finding trials. The narrow rows of `trial_entries` find a page; what is shown of it, and that the caller may see it,
/// comes from the trials themselves.
#include "core/try.hpp"
#include "db/store/rows.hpp"
#include "db/store/studies/blinding.hpp"
#include "db/store/trials/ratings.hpp"
#include "db/store/trials/summary_row.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kTaught =
    " from cohort_people c join cohort_people f on f.cohort_id = c.cohort_id where c.part = "
    "'trainee' "
    "and f.part = 'faculty' and f.account_id = ?";
constexpr std::int64_t kFewTrainees = 2000;

/// A trial of a study of research whose participant still has trials to do, as in blinding.hpp.
constexpr const char* kEntryBlind =
    "exists (select 1 from studies b where b.id = e.study_id and b.kind = 'study' and exists "
    "(select 1 from study_slots o where o.study_id = e.study_id and o.participant = e.participant "
    "and o.state in ('waiting', 'taken')))";

/// Few trainees are looked up at once, and their trials by an index; of many it is asked for each trial.
enum class Trainees { few, many };
core::Result<Trainees> trainees_of(Reading& tx, const std::string& taught_by) {
  if (taught_by.empty()) return Trainees::few;
  const auto rows =
      TRY(tx.query(std::string("select count(*) from (select 1") + kTaught + " limit ?) few",
                   {taught_by, kFewTrainees + 1}));
  return rows.front().integer(0) > kFewTrainees ? Trainees::many : Trainees::few;
}

/// @param account  the column with the account of an assigned trial, so written that an index is used or is not
std::string entries_sql(const TrialFilter& whose, const std::string& account, Trainees trainees) {
  std::string out;
  if (!whose.taught_by.empty())
    out +=
        trainees == Trainees::few
            ? " and " + account + " in (select c.account_id" + kTaught + ")"
            : std::string(" and exists (select 1") + kTaught + " and c.account_id = e.account_id)";
  if (!whose.seen_by.empty())
    out += " and " + account +
           " = ? and exists (select 1 from assignments a where a.study_id = e.study_id and "
           "a.release <> 'held')";
  return out + " and (e.study_id is null or not " + kEntryBlind + ")";
}

Reach entries_reached(const TrialFilter& whose, Trainees trainees) {
  Reach out{.sql = entries_sql(whose, "e.account_id", trainees),
            .walked = entries_sql(whose, "coalesce(e.account_id, '')", trainees)};
  for (const std::string* account : {&whose.taught_by, &whose.seen_by})
    if (!account->empty()) out.values.emplace_back(*account);
  return out;
}

core::Result<TrialSummary> summary_with_person(const Row& row) {
  auto summary = TRY(summary_from(row));
  summary.person = row.text_or_null(11).value_or("");
  summary.operator_name = row.text(12);
  return summary;
}

/// A column that names the trainee; empty where the name is hidden from everybody else.
std::string name_sql(const std::string& column, const TrialFilter& whose) {
  if (!whose.seen_by.empty()) return column;
  return "case when " + name_hidden_sql() + " then '' else " + column + " end";
}

}  // namespace

std::string reached_sql(const TrialFilter& whose, std::vector<Value>& values) {
  constexpr const char* kAssigned =
      "exists (select 1 from study_trials st join study_slots sl on sl.id = st.slot_id join "
      "assignment_people p on p.study_id = sl.study_id and p.participant = sl.participant ";
  std::string out = " and not " + blinded_sql();
  if (!whose.taught_by.empty()) {
    out += std::string(" and ") + kAssigned +
           "join cohort_people c on c.account_id = p.account_id and c.part = 'trainee' join "
           "cohort_people f on f.cohort_id = c.cohort_id and f.part = 'faculty' where st.trial_id "
           "= t.id and f.account_id = ?)";
    values.emplace_back(whose.taught_by);
  }
  if (!whose.seen_by.empty()) {
    out += std::string(" and ") + kAssigned +
           "join assignments a on a.study_id = sl.study_id where st.trial_id = t.id and "
           "p.account_id = ? and a.release <> 'held')";
    values.emplace_back(whose.seen_by);
  }
  return out;
}

core::Result<void> add_trial_entry(Writing& tx, const std::string& id) {
  // A name that is hidden (ratings.hpp) is in no word by which the trial is found or sorted.
  const std::string hidden = "case when " + name_hidden_sql() + " then '' else ";
  return done(tx.query(
      "insert into trial_entries (trial_id, started_utc_us, duration_s, case_title, station, "
      "person, correct, state, study_id, participant, account_id, words) select t.id, "
      "t.started_utc_us, t.duration_s, c.title, s.name, " +
          hidden + "coalesce(u.name, t.operator_name) end, t.correct, t.state, k.study_id, " +
          "k.participant, p.account_id, c.title || ' ' || s.name || " + hidden +
          "' ' || t.operator_name || ' ' || coalesce(u.name, '') end from trials t join cases c "
          "on c.id = t.case_id join stations s on s.id = t.station_id left join study_trials x on "
          "x.trial_id = t.id left join study_slots k on k.id = x.slot_id left join "
          "assignment_people p on p.study_id = k.study_id and p.participant = k.participant left "
          "join accounts u on u.id = p.account_id where t.id = ?",
      {id}));
}

core::Result<void> renew_trial_entry(Writing& tx, const std::string& id) {
  TRY(tx.query("delete from trial_entries where trial_id = ?", {id}));
  return add_trial_entry(tx, id);
}

const ListShape& trial_list() {
  using enum ColumnType;
  const OrderColumn key{"e.trial_id"};
  static const ListShape kShape{
      .from = "trial_entries e",
      .searched = "e.words",
      .orders = {{"started", {{"e.started_utc_us", integer}, key}, true},
                 {"case", {{"e.case_title"}, key}},
                 {"person", {{"e.person"}, key}},
                 {"station", {{"e.station"}, key}},
                 {"duration", {{"e.duration_s", number}, key}}},
      .filters = {{"answer",
                   "Only trials whose answer is correct, or incorrect, or that have none",
                   {{"correct", "e.correct = 1"},
                    {"incorrect", "e.correct = 0"},
                    {"none", "e.correct is null"}}},
                  {"state",
                   "Only trials whose scores are being computed (assessing), are there (assessed), "
                   "or could not be "
                   "computed (failed)",
                   choices_of<AssessmentState>("e.state")}}};
  return kShape;
}

core::Result<FoundTrials> find_trials(Reading& tx, const ListRequest& request,
                                      const TrialFilter& whose) {
  const auto trainees = TRY(trainees_of(tx, whose.taught_by));
  auto found = TRY(find_keys(tx, trial_list(), request, entries_reached(whose, trainees)));
  SqlPart reached;
  reached.sql = reached_sql(whose, reached.values);
  const SqlPart select{std::string("select ") + kSummaryColumns + ", " +
                       name_sql(kPersonColumn, whose) + ", " + name_sql("t.operator_name", whose) +
                       kTrialsFrom + "where t.id in"};
  auto trials = TRY(all_of(rows_of_keys(tx, select, found.keys, reached), summary_with_person));
  return FoundTrials{std::move(trials), std::move(found.page)};
}

}  // namespace store
}  // namespace tractus
