#include "db/store/trials/trials.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"
#include "db/store/studies/blinding.hpp"
#include "db/store/trials/ratings.hpp"
#include "db/store/trials/summary_row.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kFrom =
    " from trials t join cases c on c.id = t.case_id join stations s on s.id = t.station_id ";

core::Result<void> add_score(Writing& tx, const std::string& trial_id, std::int64_t position,
                             const ScoreRecord& score) {
  return done(
      tx.query("insert into trial_metrics (trial_id, metric_id, position, value, note) "
               "values (?, ?, ?, ?, ?)",
               {trial_id, score.metric_id, position, or_null(score.value), score.note}));
}

/// " and …" for the trials that `whose` reaches and that are not blind; its values are added.
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

std::string answer_sql(AnswerFilter answer) {
  switch (answer) {
    case AnswerFilter::any:
      return "";
    case AnswerFilter::correct:
      return " and t.correct = 1";
    case AnswerFilter::incorrect:
      return " and t.correct = 0";
    case AnswerFilter::none:
      return " and t.correct is null";
  }
  return "";
}

/// A column that names the trainee; empty where the name is hidden from everybody else.
std::string name_sql(const std::string& column, const TrialFilter& whose) {
  if (!whose.seen_by.empty()) return column;
  return "case when " + name_hidden_sql() + " then '' else " + column + " end";
}

/// " and …" for the trials of which a shown text contains `text`, in which % and _ are themselves.
std::string text_sql(const std::string& text, const TrialFilter& whose,
                     std::vector<Value>& values) {
  if (text.empty()) return "";
  std::string pattern = "%";
  for (const char c : text) {
    if (c == '%' || c == '_' || c == '!') pattern += '!';
    pattern += c;
  }
  pattern += '%';
  std::string out;
  for (const std::string& column :
       {std::string("c.title"), std::string("s.name"), name_sql("t.operator_name", whose),
        name_sql(kPersonColumn, whose)}) {
    out += std::string(out.empty() ? " and (" : " or ") + "lower(" + column +
           ") like lower(?) escape '!'";
    values.emplace_back(pattern);
  }
  return out + ")";
}

std::string order_sql(TrialOrder order, const TrialFilter& whose) {
  switch (order) {
    case TrialOrder::started:
      return "t.started_utc_us";
    case TrialOrder::case_title:
      return "c.title";
    case TrialOrder::person:
      return name_sql("coalesce(" + std::string(kPersonColumn) + ", t.operator_name)", whose);
    case TrialOrder::station:
      return "s.name";
    case TrialOrder::duration:
      return "t.duration_s";
  }
  return "t.started_utc_us";
}

}  // namespace

core::Result<TrialSummary> summary_from(const Row& row) {
  const auto state = TRY(row.word<AssessmentState>(9, "trials.state"));
  return TrialSummary{.id = row.text(0),
                      .case_id = row.text(1),
                      .case_title = row.text(2),
                      .station = row.text(3),
                      .operator_name = row.text(4),
                      .simulated = row.truth(5),
                      .started_utc_us = row.integer(6),
                      .duration_s = row.number(7),
                      .samples = row.count(8),
                      .state = state,
                      .correct = row.truth_or_null(10)};
}

core::Result<void> add_trial(Writing& tx, const TrialRecord& trial, std::int64_t now_utc_us) {
  const TrialSummary& s = trial.summary;
  return done(tx.query(
      "insert into trials (id, case_id, station_id, sha256, operator_name, simulated, "
      "started_utc_us, received_utc_us, duration_s, samples, complete, late_ticks, not_converged, "
      "skipped_ticks, header, events, state, failure) "
      "values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, 'assessing', '')",
      {s.id, s.case_id, trial.station_id, trial.sha256, s.operator_name, bool_value(s.simulated),
       s.started_utc_us, now_utc_us, s.duration_s, count_value(s.samples),
       bool_value(trial.complete), count_value(trial.late_ticks), count_value(trial.not_converged),
       count_value(trial.skipped_ticks), trial.header, trial.events}));
}

core::Result<std::optional<TrialRecord>> trial_of(Reading& tx, const std::string& id) {
  auto rows =
      TRY(tx.query(std::string("select ") + kSummaryColumns +
                       ", t.station_id, t.sha256, t.complete, t.late_ticks, t.not_converged, "
                       "t.skipped_ticks, t.header, t.events, t.failure, t.coverage, " +
                       kPersonColumn + ", case when " + name_hidden_sql() + " then 1 else 0 end" +
                       kFrom + "where t.id = ?",
                   {id}));
  if (rows.empty()) return std::optional<TrialRecord>();
  const Row& row = rows.front();
  auto summary = TRY(summary_from(row));
  summary.person = row.text_or_null(21).value_or("");
  summary.name_hidden = row.truth(22);
  return std::optional(TrialRecord{.summary = std::move(summary),
                                   .station_id = row.text(11),
                                   .sha256 = row.text(12),
                                   .complete = row.truth(13),
                                   .late_ticks = row.count(14),
                                   .not_converged = row.count(15),
                                   .skipped_ticks = row.count(16),
                                   .header = row.text(17),
                                   .events = row.text(18),
                                   .failure = row.text(19),
                                   .coverage = row.text_or_null(20)});
}

core::Result<std::vector<TrialSummary>> trials_before(Reading& tx, std::int64_t before_utc_us,
                                                      std::int64_t limit,
                                                      const TrialFilter& whose) {
  std::vector<Value> values{before_utc_us};
  const std::string reached = reached_sql(whose, values);
  values.emplace_back(limit);
  return all_of(tx.query_with(std::string("select ") + kSummaryColumns + kFrom +
                                  "where t.started_utc_us < ?" + reached +
                                  " order by t.started_utc_us desc, t.id desc limit ?",
                              values),
                summary_from);
}

core::Result<FoundTrials> find_trials(Reading& tx, const TrialSearch& search,
                                      const TrialFilter& whose) {
  std::vector<Value> values{search.before_utc_us};
  std::string where = "where t.started_utc_us < ?" + reached_sql(whose, values);
  where += answer_sql(search.answer);
  where += text_sql(search.text, whose, values);
  auto counted = TRY(tx.query_with(std::string("select count(*)") + kFrom + where, values));
  values.insert(values.end(), {search.limit, search.offset});
  const std::string way = search.ascending ? " asc" : " desc";
  auto rows = TRY(tx.query_with(std::string("select ") + kSummaryColumns + ", " +
                                    name_sql(kPersonColumn, whose) + ", " +
                                    name_sql("t.operator_name", whose) + kFrom + where +
                                    " order by " + order_sql(search.order, whose) + way +
                                    ", t.started_utc_us desc, t.id desc limit ? offset ?",
                                values));
  FoundTrials out;
  out.total = counted.front().count(0);
  for (const Row& row : rows) {
    auto summary = TRY(summary_from(row));
    summary.person = row.text_or_null(11).value_or("");
    summary.operator_name = row.text(12);
    out.trials.push_back(std::move(summary));
  }
  return out;
}

core::Result<void> set_assessment(Writing& tx, const std::string& id,
                                  const std::vector<ScoreRecord>& scores,
                                  std::optional<bool> correct, const std::string& coverage) {
  TRY(tx.query("delete from trial_metrics where trial_id = ?", {id}));
  for (std::size_t i = 0; i < scores.size(); ++i)
    TRY(add_score(tx, id, static_cast<std::int64_t>(i), scores[i]));
  return done(tx.query(
      "update trials set state = 'assessed', failure = '', correct = ?, coverage = ? where id = ?",
      {correct ? bool_value(*correct) : Value(), coverage, id}));
}

core::Result<void> set_assessment_failed(Writing& tx, const std::string& id,
                                         const std::string& why) {
  return done(tx.query("update trials set state = 'failed', failure = ? where id = ?", {why, id}));
}

core::Result<std::vector<ScoreRecord>> scores_of(Reading& tx, const std::string& trial_id) {
  auto rows = TRY(tx.query(
      "select metric_id, value, note from trial_metrics where trial_id = ? order by position",
      {trial_id}));
  std::vector<ScoreRecord> out;
  for (const Row& row : rows) out.push_back({row.text(0), row.number_or_null(1), row.text(2)});
  return out;
}

}  // namespace store
}  // namespace tractus
