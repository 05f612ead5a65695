#include "server/api/people/token_scopes.hpp"

#include <algorithm>

#include "server/api/backend.hpp"

namespace tractus {
namespace api {
namespace {

struct ScopeFacts {
  TokenScope scope;
  std::string_view meaning;
  std::vector<std::string_view> routes;  ///< ids
};

/// A program learns with any scope whose token it has, and what the server offers.
constexpr std::array<std::string_view, 3> kOfAnyScope{"whoAmI", "description", "metrics"};

/// Never here: signing in, tokens and accounts, consent, the key of the pseudonyms, the audit trail,
/// and what a person must judge (ratings, releases).
const std::vector<ScopeFacts>& table_of_scopes() {
  using enum TokenScope;
  static const std::vector<ScopeFacts> kTable{
      {trials_read,
       "Read trials, their recordings, scores, comments and ratings",
       {"trials", "trial", "trialSignals", "trialPath", "trialForceDepth", "trialComments",
        "trialReferences", "referenceWay", "trialRatings", "ratingRequests", "ratingAgreement",
        "rubrics"}},
      {trials_write,
       "Comment on trials and offer them as examples",
       {"addComment", "removeComment", "setReference"}},
      {cohort_read,
       "Export released trials by pseudonym; read analysis plans and results",
       {"exportTrials", "exportScores", "exportDictionary", "exportSamples", "exportSummary",
        "exportCohort", "cohortTable", "analysisPlans", "analysisPlan", "cohortAnalysis",
        "cohortAnalysisPart"}},
      {analyses_run,
       "Lock analysis plans, run analyses and read their results",
       {"lockAnalysisPlan", "analyseCohort", "stopCohortAnalysis", "cohortAnalysis",
        "cohortAnalysisPart"}},
      {lab_read,
       "Read models, measurement sets and runs of the model lab",
       {"models", "modelFile", "measurementSets", "effects", "labRuns", "labRun", "labRunReport",
        "labRunModel", "runSignals"}},
      {lab_run,
       "Add models and measurement sets, run the model lab and read the run",
       {"addModel", "addMeasurements", "checkEffect", "startDiagnosis", "startComparison",
        "startFit", "stopLabRun", "publishLabRun", "labRun", "labRunReport", "labRunModel"}},
      {cases_read,
       "Read cases and scenarios",
       {"cases", "case", "casePart", "casePreview", "caseMakings", "caseMaking", "scenarios",
        "scenario"}},
      {cases_write,
       "Make, publish and retire cases and scenarios",
       {"planTract", "certifyTract", "makeCase", "caseMaking", "retireCase", "checkScenario",
        "addScenario", "publishScenario"}},
      {volumes_read,
       "Read CT volumes",
       {"volumes", "volume", "volumeSlice", "volumePreview", "volumeReport"}},
      {volumes_write,
       "Upload CT volumes, which a person must release",
       {"addVolume", "storeSeries", "volume"}},
      {studies_read, "Read studies", {"studies", "study", "studyEvents"}},
      {studies_write,
       "Make studies, enrol participants, pause and continue",
       {"makeStudy", "enrolParticipant", "setStudyState", "setParticipantState",
        "releaseParticipant", "markTrialInvalid"}},
      {teaching_read,
       "Read cohorts, assignments, criteria and progress",
       {"cohorts", "cohort", "trainees", "trainee", "cohortProgress", "assignments", "assignment",
        "assignmentPassing", "casePassing", "criteria", "curricula", "curriculumProgress",
        "expertBound"}},
      {stations_read, "Read the state of stations", {"stations", "station", "sentModel"}},
      {operations_read,
       "Read the server's metrics and the list of backups",
       {"serverMetrics", "backups"}}};
  return kTable;
}

bool is_of_any_scope(const RouteInfo& route) {
  return std::ranges::count(kOfAnyScope, route.id) > 0;
}

}  // namespace

std::vector<TokenScope> scopes_of(const RouteInfo& route) {
  std::vector<TokenScope> out;
  for (const ScopeFacts& facts : table_of_scopes())
    if (is_of_any_scope(route) || std::ranges::count(facts.routes, route.id) > 0)
      out.push_back(facts.scope);
  return out;
}

bool allows(const std::vector<TokenScope>& held, const RouteInfo& route) {
  const auto needed = scopes_of(route);
  return std::ranges::find_first_of(held, needed) != held.end();
}

std::vector<TokenScope> scopes_for(Role role) {
  std::vector<TokenScope> out;
  for (const ScopeFacts& facts : table_of_scopes())
    if (std::ranges::any_of(routes(), [&](const RouteInfo& route) {
          return std::ranges::count(facts.routes, route.id) > 0 &&
                 std::ranges::count(route.who, role, &Grant::role) > 0;
        }))
      out.push_back(facts.scope);
  return out;
}

std::string_view meaning(TokenScope scope) {
  const auto& table = table_of_scopes();
  return std::ranges::find(table, scope, &ScopeFacts::scope)->meaning;
}

store::TokenEnd token_end_of(const Call& call) {
  return {call.caller.name, call.backend.now_utc_us()};
}

std::vector<std::string_view> routes_of_scopes() {
  std::vector<std::string_view> out(kOfAnyScope.begin(), kOfAnyScope.end());
  for (const ScopeFacts& facts : table_of_scopes())
    out.insert(out.end(), facts.routes.begin(), facts.routes.end());
  return out;
}

}  // namespace api
}  // namespace tractus
