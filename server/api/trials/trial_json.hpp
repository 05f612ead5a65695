/// Trials in the JSON form of the routes.
#pragma once

#include "db/store/stations/fleet.hpp"
#include "db/store/studies/study_slots.hpp"
#include "db/store/trials/trials.hpp"
#include "scenarios/scenario.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "volume/tract.hpp"

namespace tractus::api {

/// The place of a trial in a study.
struct StudyPlace {
  std::string title;  ///< of the study or assignment
  store::Slot slot;
  store::StudyTrialState state = store::StudyTrialState::arriving;
  std::string reason = {};
};

/// Facts about a trial besides its recording.
struct TrialFacts {
  std::optional<volume::Tract> tract = {};           ///< palpation
  core::Json truth = {};                             ///< palpation: null if the truth is not known
  std::optional<scenarios::Scenario> scenario = {};  ///< probing: includes the truth
  std::optional<StudyPlace> study = {};
  std::optional<store::TrialClock> clock = {};
};

core::Json summary_json(const store::TrialSummary& trial);
core::Json trial_json(const store::TrialRecord& trial,
                      const std::vector<store::ScoreRecord>& scores, const TrialFacts& facts);

/// The schemas TrialSummary, TrialList, Trial, Score, TrialEvent, Tract, Coverage, Truth, Answer,
/// ProbingScenario, StudyPlace.
std::vector<NamedSchema> trial_schemas();
/// TrialSignals, Envelope, TrialPath.
std::vector<NamedSchema> curve_schemas();

/// Fields of a metric as metrics::to_json writes it.
std::vector<schema::Field> metric_fields();

/// The last answer of a trial's events: {"breach", "wall", "confidence", "depth_m"}, or null.
core::Json answer_json(const core::Json& events);

}  // namespace tractus::api
