#include "db/store/cohort/analyses.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kPlan =
    "select id, title, study, plan, data_seen, trials_then, made_utc_us, made_by "
    "from analysis_plans ";
constexpr const char* kRun =
    "select id, plan_id, study, plan, state, share, snapshot, description, result, report, data, "
    "error, made_utc_us, made_by from analyses ";

AnalysisPlan plan_from(const Row& row) {
  return {row.text(0),  row.text(1),    row.text(2),    row.text(3),
          row.truth(4), row.integer(5), row.integer(6), row.text(7)};
}

core::Result<AnalysisRun> run_from(const Row& row) {
  const auto state = TRY(row.word<AnalysisState>(4, "analyses.state"));
  return AnalysisRun{row.text(0),
                     row.text_or_null(1),
                     row.text(2),
                     row.text(3),
                     state,
                     row.number(5),
                     row.text_or_null(6),
                     row.text_or_null(7),
                     row.text_or_null(8),
                     row.text_or_null(9),
                     row.text_or_null(10),
                     row.text(11),
                     row.integer(12),
                     row.text(13)};
}

}  // namespace

core::Result<void> add_analysis_plan(Writing& tx, const AnalysisPlan& plan) {
  return done(tx.query(
      "insert into analysis_plans (id, title, study, plan, data_seen, trials_then, made_utc_us, "
      "made_by) values (?, ?, ?, ?, ?, ?, ?, ?)",
      {plan.id, plan.title, plan.study, plan.plan, bool_value(plan.data_seen), plan.trials_then,
       plan.made_utc_us, plan.made_by}));
}

core::Result<std::optional<AnalysisPlan>> analysis_plan_of(Reading& tx, const std::string& id) {
  auto rows = TRY(tx.query(std::string(kPlan) + "where id = ?", {id}));
  if (rows.empty()) return std::optional<AnalysisPlan>();
  return std::optional(plan_from(rows.front()));
}

core::Result<std::vector<AnalysisPlan>> all_analysis_plans(Reading& tx) {
  auto rows = TRY(tx.query(std::string(kPlan) + "order by made_utc_us desc, id"));
  std::vector<AnalysisPlan> out;
  for (const Row& row : rows) out.push_back(plan_from(row));
  return out;
}

core::Result<void> add_analysis(Writing& tx, const AnalysisRun& run) {
  return done(tx.query(
      "insert into analyses (id, plan_id, study, plan, state, share, snapshot, description, error, "
      "made_utc_us, made_by, changed_utc_us) values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {run.id, or_null(run.plan_id), run.study, run.plan, name_value(run.state), run.share,
       or_null(run.snapshot), or_null(run.description), run.error, run.made_utc_us, run.made_by,
       run.made_utc_us}));
}

core::Result<std::optional<AnalysisRun>> analysis_of(Reading& tx, const std::string& id) {
  return one_of(tx.query(std::string(kRun) + "where id = ?", {id}), run_from);
}

core::Result<std::vector<AnalysisRun>> analyses_of_plan(Reading& tx, const std::string& plan_id) {
  return all_of(
      tx.query(std::string(kRun) + "where plan_id = ? order by made_utc_us desc, id", {plan_id}),
      run_from);
}

core::Result<std::optional<AnalysisRun>> analysis_repeated_by(Reading& tx, const AnalysisRun& run) {
  if (!run.snapshot || !run.description) return std::optional<AnalysisRun>();
  return one_of(
      tx.query(std::string(kRun) +
                   "where plan = ? and snapshot = ? and description = ? and state = 'done' "
                   "and made_utc_us < ? and id <> ? order by made_utc_us, id limit 1",
               {run.plan, *run.snapshot, *run.description, run.made_utc_us, run.id}),
      run_from);
}

core::Result<bool> note_analysis_share(Writing& tx, const std::string& id, double share,
                                       std::int64_t now_utc_us) {
  const auto rows =
      TRY(tx.query("update analyses set state = 'running', share = ?, changed_utc_us = ? "
                   "where id = ? and state in ('queued', 'running') returning id",
                   {share, now_utc_us, id}));
  return !rows.empty();
}

core::Result<void> note_analysis_snapshot(Writing& tx, const std::string& id,
                                          const std::string& snapshot,
                                          const std::string& description, std::int64_t now_utc_us) {
  return done(
      tx.query("update analyses set snapshot = ?, description = ?, changed_utc_us = ? where id = ?",
               {snapshot, description, now_utc_us, id}));
}

core::Result<void> finish_analysis(Writing& tx, const AnalysisRun& run, std::int64_t now_utc_us) {
  return done(
      tx.query("update analyses set state = 'done', share = 1.0, result = ?, report = ?, data = ?, "
               "changed_utc_us = ? where id = ? and state in ('queued', 'running')",
               {or_null(run.result), or_null(run.report), or_null(run.data), now_utc_us, run.id}));
}

core::Result<void> end_analysis(Writing& tx, const std::string& id, AnalysisState state,
                                const std::string& why, std::int64_t now_utc_us) {
  return done(
      tx.query("update analyses set state = ?, error = ?, changed_utc_us = ? "
               "where id = ? and state in ('queued', 'running')",
               {name_value(state), why, now_utc_us, id}));
}

}  // namespace store
}  // namespace tractus
