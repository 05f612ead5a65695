#include "server/jobs/cohort_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/bytes.hpp"
#include "core/csv.hpp"
#include "db/store/trials/ratings.hpp"
#include "metrics/metric.hpp"

namespace tractus {
namespace jobs {
namespace {

std::string cell(std::string_view text) { return core::csv_person_cell(text); }

std::string cell(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "";
}

/// @param running  number of the trial among the participant's in this table, counted from 1
std::string row_of(const store::ReleasedTrial& t, std::size_t running,
                   const std::vector<std::string>& metrics) {
  std::string out = fmt::format(
      "{},{},{},{},{},{},{},{},{},{:.4f},{},{},{},{}", t.id, cell(t.participant), cell(t.study),
      t.study.empty() ? "" : std::to_string(t.number), running, cell(t.cohort), cell(t.level),
      cell(t.experience_years), t.date, t.year, cell(t.case_title), trial::name(t.rig),
      t.simulated ? 1 : 0, t.correct ? (*t.correct ? "1" : "0") : "");
  for (const auto& id : metrics) {
    const auto at = t.metrics.find(id);
    out += ',' + (at == t.metrics.end() ? "" : cell(std::optional(at->second)));
  }
  return out + '\n';
}

/// Metrics that any trial has, in the order of a trial's page; those of another version last.
std::vector<std::string> metrics_of(const std::vector<store::ReleasedTrial>& trials) {
  std::set<std::string> there;
  for (const auto& trial : trials)
    for (const auto& [id, _] : trial.metrics) there.insert(id);
  std::vector<std::string> out;
  for (const auto& info : metrics::all())
    if (there.erase(info.id) > 0) out.push_back(info.id);
  out.insert(out.end(), there.begin(), there.end());
  return out;
}

/// The trials that make a row; the others are counted.
std::vector<store::ReleasedTrial> counting(std::vector<store::ReleasedTrial> trials,
                                           CohortTable& out) {
  std::erase_if(trials, [&](const store::ReleasedTrial& trial) {
    const bool counts =
        trial.complete && (trial.study.empty() || trial.place == store::StudyTrialState::counts);
    if (!counts) ++out.invalid;
    if (counts && !trial.assessed) ++out.unscored;
    return !counts || !trial.assessed;
  });
  return trials;
}

std::map<std::string, std::string> meanings_of(const std::vector<std::string>& metrics) {
  std::map<std::string, std::string> out = {
      {"trial", "pseudonym of the trial, the same in every export"},
      {"participant", "pseudonym of the person, the same in every export"},
      {"study", "id of the study; empty if the trial belongs to no study"},
      {"number", "number of the trial among the participant's trials in the study, counted from 1"},
      {"running_number",
       "number of the trial among all trials of the participant in this table, counted from 1"},
      {"cohort",
       "cohort of the assignment, else the first that the person joined; empty if there is none"},
      {"level", "level of training, as the study states it"},
      {"date", "day of the trial in UTC"},
      {"year", "day of the trial in years, for example 2026.4986 for 2 July 2026"},
      {"experience_years", "surgical experience in years, as the study states it"},
      {"case", "title of the case"},
      {"rig", "palpation or probing"},
      {"simulated", "1 if a simulated hand or machine did the trial, else 0"},
      {"correct", "1 if the answer about the breach was correct, else 0"}};
  for (const auto& info : metrics::all())
    if (std::ranges::find(metrics, info.id) != metrics.end())
      out[info.id] =
          fmt::format("{}, {}: {} {}", info.label, info.unit, info.definition, info.source);
  for (const auto& id : metrics)
    if (id.starts_with(store::kRatingScore))
      out[id] =
          "rating by people, 1: mean over the raters of the sum of the items' scores; named by the "
          "rubric and its version";
  return out;
}

}  // namespace

CohortTable cohort_table(const store::ReleasedTrials& released) {
  CohortTable out;
  out.without_consent = released.without_consent();
  out.blind = released.blind();
  const auto trials = counting(released.all(), out);
  const auto metrics = metrics_of(trials);
  out.csv =
      "trial,participant,study,number,running_number,cohort,level,experience_years,date,year,case,"
      "rig,simulated,correct";
  for (const auto& id : metrics) out.csv += ',' + cell(id);
  out.csv += '\n';
  std::map<std::string, std::size_t> done;
  for (const auto& trial : trials) out.csv += row_of(trial, ++done[trial.participant], metrics);
  out.rows = trials.size();
  out.simulated = static_cast<std::size_t>(
      std::ranges::count_if(trials, [](const auto& trial) { return trial.simulated; }));
  out.sha256 = core::sha256(core::bytes_of(out.csv));
  out.meanings = meanings_of(metrics);
  return out;
}

}  // namespace jobs
}  // namespace tractus
