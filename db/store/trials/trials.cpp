#include "db/store/trials/trials.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"
#include "db/store/trials/ratings.hpp"
#include "db/store/trials/summary_row.hpp"

namespace tractus {
namespace store {
namespace {

core::Result<void> add_score(Writing& tx, const std::string& trial_id, std::int64_t position,
                             const ScoreRecord& score) {
  return done(
      tx.query("insert into trial_metrics (trial_id, metric_id, position, value, note) "
               "values (?, ?, ?, ?, ?)",
               {trial_id, score.metric_id, position, or_null(score.value), score.note}));
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
  TRY(tx.query(
      "insert into trials (id, case_id, station_id, sha256, operator_name, simulated, "
      "started_utc_us, received_utc_us, duration_s, samples, complete, late_ticks, not_converged, "
      "skipped_ticks, header, events, state, failure) "
      "values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, 'assessing', '')",
      {s.id, s.case_id, trial.station_id, trial.sha256, s.operator_name, bool_value(s.simulated),
       s.started_utc_us, now_utc_us, s.duration_s, count_value(s.samples),
       bool_value(trial.complete), count_value(trial.late_ticks), count_value(trial.not_converged),
       count_value(trial.skipped_ticks), trial.header, trial.events}));
  return add_trial_entry(tx, s.id);
}

core::Result<std::optional<TrialRecord>> trial_of(Reading& tx, const std::string& id) {
  auto rows =
      TRY(tx.query(std::string("select ") + kSummaryColumns +
                       ", t.station_id, t.sha256, t.complete, t.late_ticks, t.not_converged, "
                       "t.skipped_ticks, t.header, t.events, t.failure, t.coverage, " +
                       kPersonColumn + ", case when " + name_hidden_sql() + " then 1 else 0 end" +
                       kTrialsFrom + "where t.id = ?",
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
  return all_of(tx.query_with(std::string("select ") + kSummaryColumns + kTrialsFrom +
                                  "where t.started_utc_us < ?" + reached +
                                  " order by t.started_utc_us desc, t.id desc limit ?",
                              values),
                summary_from);
}

core::Result<void> set_assessment(Writing& tx, const std::string& id,
                                  const std::vector<ScoreRecord>& scores,
                                  std::optional<bool> correct, const std::string& coverage) {
  TRY(tx.query("delete from trial_metrics where trial_id = ?", {id}));
  for (std::size_t i = 0; i < scores.size(); ++i)
    TRY(add_score(tx, id, static_cast<std::int64_t>(i), scores[i]));
  const Value verdict = correct ? bool_value(*correct) : Value();
  TRY(tx.query(
      "update trials set state = 'assessed', failure = '', correct = ?, coverage = ? where id = ?",
      {verdict, coverage, id}));
  return done(
      tx.query("update trial_entries set state = 'assessed', correct = ? where trial_id = ?",
               {verdict, id}));
}

core::Result<void> set_assessment_failed(Writing& tx, const std::string& id,
                                         const std::string& why) {
  TRY(tx.query("update trials set state = 'failed', failure = ? where id = ?", {why, id}));
  return done(tx.query("update trial_entries set state = 'failed' where trial_id = ?", {id}));
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
