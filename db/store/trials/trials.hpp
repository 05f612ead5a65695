/// Trials and their scores.
#pragma once

#include <vector>

#include "db/store/finding/list.hpp"
#include "db/store/store.hpp"

namespace tractus::store {

/// How far the computation of a trial's scores has come.
enum class AssessmentState { assessing, assessed, failed };
constexpr auto words(AssessmentState) {
  using enum AssessmentState;
  return std::to_array<core::Word<AssessmentState>>(
      {{assessing, "assessing"}, {assessed, "assessed"}, {failed, "failed"}});
}

/// What a list shows of a trial.
struct TrialSummary {
  std::string id, case_id, case_title, station, operator_name;
  bool simulated = false;
  std::int64_t started_utc_us = 0;
  double duration_s = 0.0;
  std::uint64_t samples = 0;
  AssessmentState state = AssessmentState::assessing;
  std::optional<bool> correct;  ///< the answer against the truth, when there is an answer
  /// Name of the account to which the trial was assigned, else empty; filled by `find_trials` and
  /// `trial_of` alone.
  std::string person = {};
  /// Whether those who rate the trial may not see its trainee's name yet (ratings.hpp); filled by
  /// `trial_of` alone, while `find_trials` leaves such names empty.
  bool name_hidden = false;
};

/// A trial as it was committed. Texts `header` and `events` are JSON.
struct TrialRecord {
  TrialSummary summary;
  std::string station_id;
  std::string sha256;  ///< of the object that is its file
  bool complete = false;
  std::uint64_t late_ticks = 0, not_converged = 0, skipped_ticks = 0;
  std::string header, events;
  std::string failure;                  ///< why the assessment failed, or empty
  std::optional<std::string> coverage;  ///< JSON, once assessed
};

struct ScoreRecord {
  std::string metric_id;
  std::optional<double> value;
  std::string note;
};

/// Of the summary, `case_title`, `station`, `state` and `correct` are not taken: a new trial is
/// "assessing".
core::Result<void> add_trial(Writing& tx, const TrialRecord& trial, std::int64_t now_utc_us);
core::Result<std::optional<TrialRecord>> trial_of(Reading& tx, const std::string& id);

/// Whose trials a list is of. Both empty: everybody's.
struct TrialFilter {
  std::string taught_by = {};  ///< those of people whom this account teaches
  std::string seen_by = {};    ///< this account's own, as far as their results are released
};
/// Newest first by start, of those started before `before_utc_us`; at most `limit`. Without those
/// that are blind (blinding.hpp).
core::Result<std::vector<TrialSummary>> trials_before(Reading& tx, std::int64_t before_utc_us,
                                                      std::int64_t limit,
                                                      const TrialFilter& whose = {});

/// The list of trials (finding/list.hpp): its orders and filters.
const ListShape& trial_list();

struct FoundTrials {
  std::vector<TrialSummary> trials;
  ListPage page;
};
/// Without those that are blind (blinding.hpp). A name that is hidden is neither told nor found,
/// but to the trainee.
core::Result<FoundTrials> find_trials(Reading& tx, const ListRequest& request,
                                      const TrialFilter& whose);

/// Puts scores, coverage (JSON) and the verdict in place of whatever was there; the trial is then
/// "assessed".
core::Result<void> set_assessment(Writing& tx, const std::string& id,
                                  const std::vector<ScoreRecord>& scores,
                                  std::optional<bool> correct, const std::string& coverage);
core::Result<void> set_assessment_failed(Writing& tx, const std::string& id,
                                         const std::string& why);
/// In the order they were given to set_assessment.
core::Result<std::vector<ScoreRecord>> scores_of(Reading& tx, const std::string& trial_id);

}  // namespace tractus::store
