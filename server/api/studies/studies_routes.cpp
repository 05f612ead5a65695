/// Studies: their list, one whole, what happened; making one and enrolling participants.
#include "core/try.hpp"
#include "db/store/trials/ratings.hpp"
#include "server/api/backend.hpp"
#include "server/api/studies/study_json.hpp"
#include "server/api/studies/study_plan.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::uint64_t kMaxStudyPlan_bytes = 4u << 20, kMaxParticipant_bytes = 4096;

core::Result<http::Response> list_studies(const Call& call) {
  auto found =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::all_studies(tx); }));
  core::Json list = core::Json::array();
  for (const auto& study : found) list.push_back(summary_json(study));
  return json_response({{"studies", list}});
}

core::Result<http::Response> study_response(Backend& backend, const std::string& id) {
  auto facts = TRY(backend.store.read([&](store::Reading& tx) -> core::Result<StudyFacts> {
    auto study = TRY(store::find_study(tx, id));
    return study_facts(tx, study);
  }));
  return json_response(study_json(facts));
}

core::Result<http::Response> one_study(const Call& call) {
  return study_response(call.backend, call.text("id"));
}

core::Result<http::Response> new_study(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  auto plan = TRY(StudyPlan::from_json(json));
  TRY(make_study(call.backend, plan, call.caller.name));
  return study_response(call.backend, plan.study.id);
}

core::Result<http::Response> new_participant(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  auto participant = TRY(participant_from(json, ""));
  const std::string& id = call.text("id");
  TRY(enrol(call.backend, id, participant, call.caller.name));
  return study_response(call.backend, id);
}

core::Result<http::Response> events_of(const Call& call) {
  const std::string& id = call.text("id");
  auto list = TRY(call.backend.store.read([&](store::Reading& tx) -> core::Result<core::Json> {
    const auto study = TRY(store::find_study(tx, id));
    const auto found = TRY(store::study_events(tx, study, call.integer("limit")));
    const auto unlinked = TRY(store::trials_with_hidden_name(tx));
    core::Json out = core::Json::array();
    for (const auto& event : found) out.push_back(event_json(event, unlinked));
    return out;
  }));
  return json_response({{"events", std::move(list)}});
}

}  // namespace

std::vector<RouteInfo> studies_routes() {
  RouteInfo list = research_route("GET", "studies", "studies", "List the studies, newest first",
                                  "StudyList", list_studies);
  list.schemas = study_schemas();
  const RouteInfo make =
      taking(research_route("POST", "studies", "makeStudy",
                            "Create a study with its scenarios, repeats, order and participants",
                            "Study", new_study),
             "NewStudy", kMaxStudyPlan_bytes, study_deed_schemas());
  const RouteInfo one =
      research_route("GET", "studies/{id}", "study",
                     "Read a study with its participants and their trials", "Study", one_study);
  RouteInfo events =
      research_route("GET", "studies/{id}/events", "studyEvents",
                     "List the changes of a study, newest first: who changed what and when",
                     "StudyEvents", events_of);
  events.parameters.push_back({.in = Parameter::In::query,
                               .name = "limit",
                               .kind = Parameter::Kind::integer,
                               .unit = "1",
                               .meaning = "Largest number of changes in the answer",
                               .low = 1,
                               .high = 10000,
                               .fallback = "200"});
  const RouteInfo add =
      taking(research_route("POST", "studies/{id}/participants", "enrolParticipant",
                            "Enrol a participant in a study", "Study", new_participant),
             "NewParticipant", kMaxParticipant_bytes, {});
  return {list, make, one, events, add};
}

}  // namespace api
}  // namespace tractus
