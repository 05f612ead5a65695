#include "db/store/cohort/cohort.hpp"

#include <set>

#include "core/try.hpp"
#include "db/store/studies/blinding.hpp"
#include "db/store/trials/ratings.hpp"
#include "db/store/trials/summary_row.hpp"

namespace tractus {
namespace store {
namespace {

const std::string& kTrials() {
  static const std::string sql =
      std::string("select ") + kSummaryColumns +
      ", t.complete, c.kind, l.study_id, l.participant, "
      "p.level, l.position, p.experience_years, m.state, u.name, t.sha256, case when " +
      blinded_sql() +
      " then 1 else 0 end, coalesce(h.name, (select k.name from cohort_people q join cohorts k on "
      "k.id = q.cohort_id where q.account_id = a.account_id and q.part = 'trainee' order by "
      "q.since_utc_us, k.name limit 1), '') from trials t "
      "join cases c on c.id = t.case_id join stations s on s.id = t.station_id "
      "left join study_trials m on m.trial_id = t.id left join study_slots l on l.id = m.slot_id "
      "left join assignment_people a on a.study_id = l.study_id and a.participant = l.participant "
      "left join accounts u on u.id = a.account_id "
      "left join assignments g on g.study_id = l.study_id left join cohorts h on h.id = "
      "g.cohort_id "
      "left join study_participants p on p.study_id = l.study_id and p.name = l.participant "
      "where ? = '' or l.study_id = ? order by t.started_utc_us, t.id limit ?";
  return sql;
}

core::Result<CohortTrial> trial_from(const Row& row) {
  auto summary = TRY(summary_from(row));
  const auto rig = TRY(row.word<trial::Rig>(12, "cases.kind"));
  const auto place = TRY(row.word_or_null<StudyTrialState>(18, "study_trials.state"));
  CohortTrial out{.summary = std::move(summary),
                  .complete = row.truth(11),
                  .rig = rig,
                  .study = row.text_or_null(13).value_or(""),
                  .participant = row.text_or_null(14).value_or(""),
                  .level = row.text_or_null(15).value_or(""),
                  .cohort = row.text(22),
                  .person = row.text_or_null(19).value_or(""),
                  .experience_years = row.number_or_null(17),
                  .place = place,
                  .metrics = {},
                  .sha256 = row.text(20),
                  .blind = row.truth(21)};
  if (!out.study.empty()) out.number = row.integer(16) + 1;
  return out;
}

}  // namespace

core::Result<std::vector<CohortTrial>> CohortRows::read(Reading& tx, const std::string& study_id,
                                                        std::int64_t limit) {
  auto rows = TRY(tx.query(kTrials(), {study_id, study_id, limit + 1}));
  if (rows.size() > static_cast<std::size_t>(limit))
    return core::Error{core::Errc::too_large, "the cohort has more than " + std::to_string(limit) +
                                                  " trials: choose one study"};
  const auto ratings = TRY(rating_scores(tx));
  std::vector<CohortTrial> out;
  for (const Row& row : rows) {
    auto trial = TRY(trial_from(row));
    out.push_back(std::move(trial));
    auto scores = TRY(scores_of(tx, out.back().summary.id));
    for (const ScoreRecord& score : scores)
      if (score.value) out.back().metrics.emplace(score.metric_id, *score.value);
    if (const auto rated = ratings.find(out.back().summary.id); rated != ratings.end())
      out.back().metrics.insert(rated->second.begin(), rated->second.end());
  }
  return out;
}

core::Result<std::vector<CohortTrial>> trials_for_teaching(Reading& tx, const std::string& study_id,
                                                           const TrialFilter& whose,
                                                           std::int64_t limit) {
  constexpr std::int64_t kAnyTime_utc_us = 9'000'000'000'000'000;
  auto trials = CohortRows::read(tx, study_id, limit);
  if (!trials) return trials.error();
  std::erase_if(*trials, [](const CohortTrial& trial) { return trial.blind; });
  if (whose.taught_by.empty() && whose.seen_by.empty()) return trials;
  const auto reached = TRY(trials_before(tx, kAnyTime_utc_us, limit, whose));
  std::set<std::string> ids;
  for (const TrialSummary& trial : reached) ids.insert(trial.id);
  std::erase_if(*trials, [&](const CohortTrial& trial) { return !ids.contains(trial.summary.id); });
  return trials;
}

}  // namespace store
}  // namespace tractus
