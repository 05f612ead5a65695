#include "server/api/studies/study_json.hpp"

#include <algorithm>
#include <map>

#include "core/try.hpp"
#include "db/store/trials/ratings.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using store::SlotState;

template <core::Named E>
Json name_or_null(const std::optional<E>& value) {
  return value ? Json(name(*value)) : Json();
}

Json study_fields(const store::Study& study) {
  return {{"id", study.id},
          {"title", study.title},
          {"state", name(study.state)},
          {"ordering", name(study.ordering)},
          {"repeats", study.repeats},
          {"on_invalid", name(study.on_invalid)},
          {"made_utc_us", study.made_utc_us},
          {"made_by", study.made_by}};
}

/// @param told  whether the result may state if the answer was correct
Json trial_json(const store::StudyTrial& trial, bool told) {
  return {{"id", trial.trial_id},
          {"state", name(trial.state)},
          {"reason", trial.reason},
          {"station", trial.station},
          {"changed_utc_us", trial.changed_utc_us},
          {"started_utc_us", core::or_null(trial.started_utc_us)},
          {"duration_s", core::or_null(trial.duration_s)},
          {"samples", core::or_null(trial.samples)},
          {"sha256", core::or_null(trial.sha256)},
          {"assessment", name_or_null(trial.assessment)},
          {"correct", told ? core::or_null(trial.correct) : Json()}};
}

bool unfinished(const store::Slot& slot) {
  return slot.state == SlotState::waiting || slot.state == SlotState::taken;
}

/// The trials, titles and numbers from which the participants' rows are made.
struct Index {
  std::map<std::string, std::vector<const store::StudyTrial*>> trials;  // by slot
  std::map<std::string, std::string> titles;                            // by case
  std::map<std::string, int> numbers;                                   // of slots, from 1

  explicit Index(const StudyFacts& facts) {
    for (const auto& trial : facts.trials) trials[trial.slot_id].push_back(&trial);
    for (const auto& scenario : facts.scenarios) titles[scenario.case_id] = scenario.title;
    std::map<std::string, int> seen;
    for (const auto& slot : facts.slots) numbers[slot.id] = ++seen[slot.participant];
  }
};

Json slot_json(const StudyFacts& facts, const store::Slot& slot, const Index& index, bool told) {
  Json trials = Json::array();
  if (const auto found = index.trials.find(slot.id); found != index.trials.end())
    for (const auto* trial : found->second)
      if (!facts.unlinked.contains(trial->trial_id)) trials.push_back(trial_json(*trial, told));
  Json repeats;
  if (slot.repeat_of) repeats = index.numbers.at(*slot.repeat_of);
  return {{"number", index.numbers.at(slot.id)},
          {"state", name(slot.state)},
          {"repeat_of", repeats},
          {"scenario", told ? Json(index.titles.at(slot.case_id)) : Json()},
          {"trials", trials}};
}

struct Tally {
  int done = 0, planned = 0, judged = 0, recognised = 0;

  void add(const store::Slot& slot, const Index& index) {
    planned += slot.state != SlotState::invalid;
    done += slot.state == SlotState::recorded;
    const auto found = index.trials.find(slot.id);
    if (found == index.trials.end()) return;
    for (const auto* trial : found->second) {
      if (trial->state != store::StudyTrialState::counts || !trial->correct) continue;
      ++judged;
      recognised += *trial->correct;
    }
  }
};

/// The station that last uploaded a trial of the participant; null if there is none.
Json station_of(const StudyFacts& facts, const store::Participant& who, const Index& index) {
  const store::StudyTrial* last = nullptr;
  for (const auto& slot : facts.slots) {
    if (slot.participant != who.name) continue;
    const auto found = index.trials.find(slot.id);
    if (found == index.trials.end()) continue;
    for (const auto* trial : found->second)
      if (!last || trial->changed_utc_us > last->changed_utc_us) last = trial;
  }
  return last ? Json(last->station) : Json();
}

Json participant_json(const StudyFacts& facts, const store::Participant& who, const Index& index) {
  bool left = false, at_station = false;
  for (const auto& slot : facts.slots) {
    left = left || (slot.participant == who.name && unfinished(slot));
    at_station = at_station || (slot.participant == who.name && slot.state == SlotState::taken);
  }
  Tally tally;
  Json slots = Json::array();
  for (const auto& slot : facts.slots) {
    if (slot.participant != who.name) continue;
    tally.add(slot, index);
    slots.push_back(slot_json(facts, slot, index, !left));
  }
  return {{"name", who.name},
          {"state", name(who.state)},
          {"level", who.level},
          {"experience_years", core::or_null(who.experience_years)},
          {"simulated", who.simulated},
          {"at_station", at_station},
          {"last_station", station_of(facts, who, index)},
          {"done", tally.done},
          {"planned", tally.planned},
          {"judged", left ? 0 : tally.judged},
          {"recognised", left ? 0 : tally.recognised},
          {"slots", slots}};
}

}  // namespace

core::Result<StudyFacts> study_facts(store::Reading& tx, const store::StudyId& id) {
  auto study = TRY(store::study_of(tx, id));
  StudyFacts out;
  out.study = std::move(study);
  auto scenarios = TRY(store::study_scenarios(tx, id));
  out.scenarios = std::move(scenarios);
  auto participants = TRY(store::study_participants(tx, id));
  out.participants = std::move(participants);
  auto slots = TRY(store::study_slots(tx, id));
  out.slots = std::move(slots);
  auto trials = TRY(store::study_trials(tx, id));
  out.trials = std::move(trials);
  out.unlinked = TRY(store::trials_with_hidden_name(tx));
  return out;
}

Json summary_json(const store::StudySummary& summary) {
  Json out = study_fields(summary.study);
  out["participants"] = summary.participants;
  out["done"] = summary.done;
  out["planned"] = summary.planned;
  return out;
}

Json study_json(const StudyFacts& facts) {
  const Index index(facts);
  Json out = study_fields(facts.study);
  const bool left = std::ranges::any_of(facts.slots, unfinished);
  out["seed"] = left || facts.slots.empty() ? Json() : Json(facts.study.seed);
  out["scenarios"] = Json::array();
  for (const auto& scenario : facts.scenarios)
    out["scenarios"].push_back({{"case_id", scenario.case_id}, {"title", scenario.title}});
  out["participants"] = Json::array();
  for (const auto& who : facts.participants)
    out["participants"].push_back(participant_json(facts, who, index));
  return out;
}

Json event_json(const store::StudyEvent& event, const std::set<std::string>& unlinked) {
  const bool linked = event.trial_id && !unlinked.contains(*event.trial_id);
  return {{"at_utc_us", event.at_utc_us},
          {"who", event.who},
          {"what", event.what},
          {"participant", core::or_null(event.participant)},
          {"trial_id", linked ? Json(*event.trial_id) : Json()},
          {"reason", event.reason}};
}

}  // namespace api
}  // namespace tractus
