#include "server/api/trials/trial_json.hpp"

#include <algorithm>

#include "metrics/metric.hpp"
#include "trial/trial.hpp"

namespace tractus {
namespace api {
namespace {

core::Json vector_json(const math::Vec3& v) { return core::Json::array({v.x(), v.y(), v.z()}); }

core::Json tract_json(const volume::Tract& tract) {
  return {{"entry_m", vector_json(tract.entry_m)},
          {"axis", vector_json(tract.axis)},
          {"length_m", tract.length_m},
          {"radius_m", tract.radius_m},
          {"medial", vector_json(tract.medial)},
          {"superior", vector_json(tract.superior)}};
}

core::Json scores_json(const std::vector<store::ScoreRecord>& scores) {
  const auto known = metrics::all();
  core::Json out = core::Json::array();
  for (const store::ScoreRecord& score : scores) {
    const auto info = std::ranges::find(known, score.metric_id, &metrics::MetricInfo::id);
    if (info == known.end()) continue;  // scored by another version
    out.push_back(metrics::to_json(*info, {score.value, score.note}));
  }
  return out;
}

core::Json scenario_json(const scenarios::Scenario& scenario) {
  const auto law = scenario.expanded();
  core::require(bool(law), "a scenario that was read can be expanded");
  core::Json layers = core::Json::array(), walls = core::Json::array();
  for (const auto& layer : law->layers)
    layers.push_back({{"start_m", layer.start_m},
                      {"thickness_m", layer.thickness_m},
                      {"stiffness_N_per_m", layer.stiffness_N_per_m},
                      {"damping_Ns_per_m", layer.damping_Ns_per_m}});
  for (const auto& wall : law->walls)
    walls.push_back({{"position_m", wall.position_m},
                     {"resistance_interval_m", wall.resistance_interval_m},
                     {"breach_interval_m", wall.breach_interval_m}});
  return {{"id", scenario.id()},
          {"name", scenario.name},
          {"travel_m", scenario.travel_m},
          {"layers", layers},
          {"walls", walls}};
}

core::Json study_json(const StudyPlace& place) {
  return {{"id", place.slot.study_id},
          {"title", place.title},
          {"participant", place.slot.participant},
          {"number", place.slot.position + 1},
          {"state", name(place.state)},
          {"reason", place.reason}};
}

}  // namespace

core::Json answer_json(const core::Json& events) {
  trial::Trial trial;
  for (const core::Json& event : events)
    trial.events.push_back({event.at("t_s"), event.at("kind"), event.at("detail")});
  const auto answer = trial.answer();
  if (!answer) return {};
  return {{"breach", answer->breach},
          {"wall", answer->wall ? core::Json(*answer->wall) : core::Json()},
          {"confidence", answer->confidence ? core::Json(*answer->confidence) : core::Json()},
          {"depth_m", answer->depth_m ? core::Json(*answer->depth_m) : core::Json()}};
}

core::Json summary_json(const store::TrialSummary& trial) {
  return {{"id", trial.id},
          {"case_id", trial.case_id},
          {"case_title", trial.case_title},
          {"station", trial.station},
          {"operator_name", trial.operator_name},
          {"person", trial.person},
          {"simulated", trial.simulated},
          {"started_utc_us", trial.started_utc_us},
          {"duration_s", trial.duration_s},
          {"samples", trial.samples},
          {"state", name(trial.state)},
          {"correct", trial.correct ? core::Json(*trial.correct) : core::Json()}};
}

core::Json trial_json(const store::TrialRecord& trial,
                      const std::vector<store::ScoreRecord>& scores, const TrialFacts& facts) {
  const core::Json header = core::stored_json(trial.header);
  const core::Json events = core::stored_json(trial.events);
  core::Json out = summary_json(trial.summary);
  out["rig"] = header.value("rig", "palpation");
  out["device"] = header.value("device", "");
  out["rate_Hz"] = header.value("rate_Hz", 0.0);
  out["complete"] = trial.complete;
  out["failure"] = trial.failure.empty() ? core::Json() : core::Json(trial.failure);
  out["late_ticks"] = trial.late_ticks;
  out["not_converged"] = trial.not_converged;
  out["skipped_ticks"] = trial.skipped_ticks;
  out["clock_offset_s"] = facts.clock ? core::Json(facts.clock->offset_s) : core::Json();
  out["clock_error_s"] = facts.clock ? core::Json(facts.clock->error_s) : core::Json();
  out["answer"] = answer_json(events);
  out["events"] = events;
  out["truth"] = facts.truth;
  out["metrics"] = scores_json(scores);
  out["tract"] = facts.tract ? tract_json(*facts.tract) : core::Json();
  out["scenario"] = facts.scenario ? scenario_json(*facts.scenario) : core::Json();
  out["study"] = facts.study ? study_json(*facts.study) : core::Json();
  out["coverage"] = trial.coverage ? core::stored_json(*trial.coverage) : core::Json();
  out["probe"] = header.value("probe", core::Json::object());
  return out;
}

}  // namespace api
}  // namespace tractus
