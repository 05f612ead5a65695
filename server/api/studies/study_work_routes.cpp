/// A station's part of a study: the next trials of a participant, sealed.
#include <fmt/format.h>

#include "core/try.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/studies/study_slots.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/api/trials/uploads.hpp"
#include "server/jobs/scenario_facts.hpp"
#include "study/sealed_law.hpp"
#include "wire/study_work.hpp"

namespace tractus {
namespace api {
namespace {

constexpr int kMaxAhead = 400;

/// Result of the transaction that answers a station's request.
struct GivenWork {
  store::Participant participant;
  store::Taken taken;
  std::string token_hash;
};

core::Result<GivenWork> take(store::Writing& tx, const Call& call) {
  const std::string &id = call.text("id"), &name = call.text("name");
  auto study = TRY(store::find_study(tx, id));
  auto participant = TRY(store::participant_of(tx, study, name));
  if (!participant)
    return core::Error{core::Errc::not_found,
                       "no participant " + name.substr(0, 32) + " in this study"};
  auto token = TRY(store::station_token_hash(tx, call.caller.id));
  auto taken = TRY(store::take_slots(tx, study, *participant, call.caller.id, call.integer("ahead"),
                                     {call.caller.name, call.backend.now_utc_us()}));
  return GivenWork{std::move(*participant), std::move(taken), std::move(token)};
}

core::Result<std::vector<wire::SealedTrial>> sealed_trials(Backend& backend,
                                                           const GivenWork& given) {
  const study::StationKey key(given.token_hash);
  std::vector<wire::SealedTrial> out;
  std::uint64_t number = given.taken.planned - given.taken.unfinished;
  for (const store::Slot& slot : given.taken.slots) {
    auto scenario = TRY(jobs::scenario_of(backend.store, backend.objects, slot.case_id));
    auto law = TRY(scenario.expanded());
    auto sealed = TRY(study::sealed_law(law, slot.id, key));
    out.push_back({slot.id, ++number, std::move(sealed)});
  }
  return out;
}

core::Result<http::Response> take_trials(const Call& call) {
  TRY(check_room(call.backend, kTrialToCome_bytes));
  auto given = TRY(call.backend.store.write(
      [&](store::Writing& tx) -> core::Result<GivenWork> { return take(tx, call); }));
  auto trials = TRY(sealed_trials(call.backend, given));
  const auto& who = given.participant;
  const wire::StudyWork work{call.text("id"),        who.name,
                             who.simulated,          who.experience_years,
                             given.taken.unfinished, given.taken.planned,
                             std::move(trials)};
  return json_response(work.to_json());
}

}  // namespace

std::vector<RouteInfo> study_work_routes() {
  using namespace schema;
  const core::Json trial = object(
      {{"slot", text("Id of the slot, 64 hexadecimal characters; the station writes it as case_id "
                     "into the trial file and the upload")},
       {"number",
        integer("1", "Number of the trial among the participant's trials, counted from 1")},
       {"sealed", text("Parameters of the scenario's law, encrypted for the calling station")}});
  const core::Json answer =
      object({{"study", text("Id of the study")},
              {"participant", text("Pseudonym of the participant")},
              {"simulated", truth("True if the participant is a simulated surgeon")},
              {"experience_years",
               nullable(number("a", "Surgical experience, in years; null if it is not known"))},
              {"unfinished", integer("1",
                                     "Number of trials that the participant still has to do; 0: "
                                     "the participant has finished the study")},
              {"planned", integer("1", "Number of the participant's planned trials")},
              {"trials", array(ref("SealedTrial"),
                               "Trials, in the order in which the participant does them")}});
  RouteInfo take{.method = "POST",
                 .path = "/api/v1/studies/{id}/participants/{name}/take",
                 .id = "takeTrials",
                 .summary =
                     "Take the next trials of a participant for the calling station; a second call "
                     "gives the same trials",
                 .who = {Role::station},
                 .parameters = {path_text("id", "Id of the study"),
                                path_text("name", "Pseudonym of the participant"),
                                {.in = Parameter::In::query,
                                 .name = "ahead",
                                 .kind = Parameter::Kind::integer,
                                 .unit = "1",
                                 .meaning = "Largest number of trials in the answer; more than 1, "
                                            "so that the station can work without the server",
                                 .low = 1,
                                 .high = kMaxAhead,
                                 .fallback = "1"}},
                 .body = "",
                 .answer = "TakenTrials",
                 .schemas = {{"SealedTrial", trial}, {"TakenTrials", answer}},
                 .handle = take_trials};
  return {take};
}

}  // namespace api
}  // namespace tractus
