/// Locked analysis plans and their runs on frozen snapshots of the cohort.
#pragma once

#include <vector>

#include "db/store/operations/jobs.hpp"

namespace tractus::store {

/// A locked plan, which never changes: another plan is another row.
struct AnalysisPlan {
  std::string id, title;
  std::string study;             ///< id of the study whose trials the plan uses; empty: all trials
  std::string plan;              ///< object: tractus-plan/1 with its lock
  bool data_seen = false;        ///< as the lock states
  std::int64_t trials_then = 0;  ///< scored trials for it on the server when it was locked
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

/// `cancelled`: a person stopped it.
enum class AnalysisState { queued, running, done, failed, cancelled };
constexpr auto words(AnalysisState) {
  using enum AnalysisState;
  return std::to_array<core::Word<AnalysisState>>({{queued, "queued"},
                                                   {running, "running"},
                                                   {done, "done"},
                                                   {failed, "failed"},
                                                   {cancelled, "cancelled"}});
}

/// A run of an analysis.
struct AnalysisRun {
  std::string id;
  std::optional<std::string> plan_id;  ///< none: one method, without a locked plan
  std::string study;
  std::string plan;  ///< object: the plan that is run
  AnalysisState state = AnalysisState::queued;
  double share = 0.0;                                ///< of the work, 0 … 1
  std::optional<std::string> snapshot, description;  ///< objects: the frozen CSV, snapshot.json
  std::optional<std::string> result, report, data;   ///< objects, once done
  std::string error;                                 ///< why it failed, or who stopped it
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

core::Result<void> add_analysis_plan(Writing& tx, const AnalysisPlan& plan);
core::Result<std::optional<AnalysisPlan>> analysis_plan_of(Reading& tx, const std::string& id);
/// Newest first.
core::Result<std::vector<AnalysisPlan>> all_analysis_plans(Reading& tx);

core::Result<void> add_analysis(Writing& tx, const AnalysisRun& run);
core::Result<std::optional<AnalysisRun>> analysis_of(Reading& tx, const std::string& id);
/// Newest first.
core::Result<std::vector<AnalysisRun>> analyses_of_plan(Reading& tx, const std::string& plan_id);
/// The first finished run of the same plan on the same data, before this run.
core::Result<std::optional<AnalysisRun>> analysis_repeated_by(Reading& tx, const AnalysisRun& run);

/// False: it was stopped, or is done; nothing was noted.
core::Result<bool> note_analysis_share(Writing& tx, const std::string& id, double share,
                                       std::int64_t now_utc_us);
/// Records the frozen data of the run.
core::Result<void> note_analysis_snapshot(Writing& tx, const std::string& id,
                                          const std::string& snapshot,
                                          const std::string& description, std::int64_t now_utc_us);
/// `done` as in AnalysisRun: result, report, data. An analysis that was stopped stays so.
core::Result<void> finish_analysis(Writing& tx, const AnalysisRun& done, std::int64_t now_utc_us);
/// Of one that is queued or running; any other stays as it is.
/// @param state  failed or cancelled
core::Result<void> end_analysis(Writing& tx, const std::string& id, AnalysisState state,
                                const std::string& why, std::int64_t now_utc_us);

}  // namespace tractus::store
