#include "server/api/studies/study_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "study/order.hpp"
#include "study/sealed_law.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr long kMaxRepeats = 20;
constexpr std::size_t kMaxScenarios = 16, kMaxParticipants = 500, kMaxCode = 32,
                      kMaxStudyTitle = 200;
constexpr long kMaxSeed = 9'007'199'254'740'991;  // exact wherever JSON goes

bool is_study_id(const std::string& text) {
  return !text.empty() && text.size() <= kMaxCode && text.front() != '-' &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
}

bool is_participant(const std::string& text) {
  return !text.empty() && text.size() <= kMaxCode && std::ranges::all_of(text, [](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ||
           c == '_';
  });
}

bool flag(core::Fields& fields, const char* key) {
  const Json* found = fields.member(key, false);
  if (found && !found->is_boolean()) fields.wrong(key, "true or false is expected");
  return found && found->is_boolean() && found->get<bool>();
}

Result<scenarios::Scenario> read_scenario(const Json& json, const std::string& where) {
  if (!json.is_object() || !json.contains("tuned"))
    return scenarios::Scenario::from_json(json, where + ": ");
  core::Fields fields(json, where);
  const auto kind = fields.word<scenarios::Kind>("tuned");
  TRY(fields.done());
  return scenarios::tuned(kind);
}

/// Can it be handed out blind? Tried with a key of no station.
Result<void> check_fits(const scenarios::Scenario& scenario, const std::string& where) {
  auto law = TRY(scenario.expanded());
  auto sealed = study::sealed_law(law, "", study::StationKey(""));
  if (!sealed) return Error{Errc::bad_input, where + ": " + sealed.error().what};
  return {};
}

Result<const Json*> array_of(const Json& json, const char* key, std::size_t least,
                             std::size_t most) {
  if (!json.contains(key) || !json[key].is_array() || json[key].size() < least ||
      json[key].size() > most)
    return Error{Errc::bad_input,
                 fmt::format("/{}: an array of {} to {} is expected", key, least, most)};
  return &json[key];
}

Result<std::vector<scenarios::Scenario>> scenarios_from(const Json& json) {
  auto list = TRY(array_of(json, "scenarios", 1, kMaxScenarios));
  std::vector<scenarios::Scenario> out;
  std::set<std::string> ids;
  for (const Json& one : *list) {
    const std::string where = fmt::format("/scenarios/{}", out.size());
    auto scenario = TRY(scenario_from(one, where));
    if (!ids.insert(scenario.id()).second)
      return Error{Errc::bad_input, where + ": this scenario occurs twice; use repeats instead"};
    out.push_back(std::move(scenario));
  }
  return out;
}

Result<std::vector<store::Participant>> participants_from(const Json& json) {
  auto list = TRY(array_of(json, "participants", 0, kMaxParticipants));
  std::vector<store::Participant> out;
  for (const Json& one : *list) {
    const std::string where = fmt::format("/participants/{}", out.size());
    auto participant = TRY(participant_from(one, where));
    if (std::ranges::find(out, participant.name, &store::Participant::name) != out.end())
      return Error{Errc::bad_input, where + "/name: " + participant.name + " occurs twice"};
    out.push_back(std::move(participant));
  }
  return out;
}

store::CaseOrder case_order(study::Ordering ordering) {
  return ordering == study::Ordering::random ? store::CaseOrder::random
                                             : store::CaseOrder::balanced;
}

/// @param order  not fixed
study::Ordering ordering_of(store::CaseOrder order) {
  return order == store::CaseOrder::random ? study::Ordering::random : study::Ordering::balanced;
}

Result<store::Study> study_from(const Json& json) {
  core::Fields fields(json, "");
  store::Study out;
  out.id = fields.text("id", kMaxCode);
  if (!is_study_id(out.id))
    fields.wrong("id", "1 to 32 of the characters a-z, 0-9 and - are expected");
  out.title = fields.text("title", kMaxStudyTitle);
  out.repeats = fields.integer("repeats", 1, kMaxRepeats);
  out.ordering = case_order(fields.word_or("ordering", study::Ordering::random));
  out.on_invalid = fields.word_or("on_invalid", store::Repetition::at_end);
  const auto drawn = core::random_bytes(4);
  long seed = 0;
  for (const std::byte b : drawn) seed = seed * 256 + std::to_integer<long>(b);
  out.seed = fields.integer_or("seed", seed, 0, kMaxSeed);
  fields.skip("scenarios");
  fields.skip("participants");
  TRY(fields.done());
  return out;
}

}  // namespace

Result<scenarios::Scenario> scenario_from(const Json& json, const std::string& where) {
  auto scenario = read_scenario(json, where);
  if (!scenario) return scenario;
  TRY(check_fits(*scenario, where));
  return scenario;
}

std::vector<std::string> order_for(const store::Study& study,
                                   const std::vector<store::StudyScenario>& scenarios, int n) {
  std::vector<std::string> out;
  if (study.ordering == store::CaseOrder::fixed) {
    for (std::int64_t round = 0; round < study.repeats; ++round)
      for (const auto& scenario : scenarios) out.push_back(scenario.case_id);
    return out;
  }
  const study::OrderPlan plan{static_cast<int>(scenarios.size()), static_cast<int>(study.repeats),
                              ordering_of(study.ordering), static_cast<std::uint64_t>(study.seed)};
  for (const int i : study::order_of(plan, n)) out.push_back(scenarios[std::size_t(i)].case_id);
  return out;
}

Result<store::CasePart> put_scenario(Backend& backend, const scenarios::Scenario& scenario) {
  const std::string text = scenario.to_json().dump();
  auto sha256 = TRY(backend.objects.put(core::bytes_of(text)));
  return store::CasePart{"scenario.json", sha256, text.size(), true};
}

Result<store::Participant> participant_from(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  store::Participant out;
  out.name = fields.text("name", kMaxCode);
  if (!is_participant(out.name))
    fields.wrong("name", "a pseudonym of 1 to 32 letters, digits, - and _ is expected");
  out.level = fields.text_or("level", "", kMaxCode);
  if (fields.has("experience_years"))
    out.experience_years = fields.number("experience_years", 0.0, 80.0);
  out.simulated = flag(fields, "simulated");
  TRY(fields.done());
  return out;
}

Result<StudyPlan> StudyPlan::from_json(const Json& json) {
  auto study = TRY(study_from(json));
  auto scenarios = TRY(scenarios_from(json));
  auto participants = TRY(participants_from(json));
  return StudyPlan{std::move(study), std::move(scenarios), std::move(participants)};
}

Result<void> make_study(Backend& backend, const StudyPlan& plan, const std::string& who) {
  std::vector<store::CasePart> parts;
  std::vector<store::StudyScenario> named;
  for (const auto& scenario : plan.scenarios) {
    auto part = TRY(put_scenario(backend, scenario));
    parts.push_back(std::move(part));
    named.push_back({scenario.id(), scenario.name});
  }
  const std::int64_t now = backend.now_utc_us();
  const store::AuditStamp stamp{who, now};
  return backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto taken = TRY(store::series_exists(tx, plan.study.id));
    if (taken) return Error{Errc::conflict, "id: there is a study " + plan.study.id + " already"};
    std::vector<std::string> ids;
    for (std::size_t i = 0; i < named.size(); ++i) {
      const auto& scenario = plan.scenarios[i];
      const store::CaseSummary summary{
          named[i].case_id, scenario.name, scenario.origin.who, now, 0, trial::Rig::probing};
      TRY(store::add_case(tx, summary, {parts[i]}, now));
      ids.push_back(named[i].case_id);
    }
    auto id = TRY(store::add_study(tx, plan.study, ids, stamp));
    for (std::size_t n = 0; n < plan.participants.size(); ++n)
      TRY(store::add_participant(tx, id, plan.participants[n], order_for(plan.study, named, int(n)),
                                 stamp));
    return {};
  });
}

Result<void> enrol(Backend& backend, const std::string& study_id,
                   const store::Participant& participant, const std::string& who) {
  return backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto id = TRY(store::find_study(tx, study_id));
    auto study = TRY(store::study_of(tx, id));
    auto there = TRY(store::study_participants(tx, id));
    if (std::ranges::find(there, participant.name, &store::Participant::name) != there.end())
      return Error{Errc::conflict, "name: " + participant.name + " is enrolled already"};
    if (there.size() >= kMaxParticipants)
      return Error{
          Errc::conflict,
          fmt::format("{} participants are enrolled: a study cannot have more", there.size())};
    auto scenarios = TRY(store::study_scenarios(tx, id));
    return store::add_participant(tx, id, participant,
                                  order_for(study, scenarios, int(there.size())),
                                  {who, backend.now_utc_us()});
  });
}

}  // namespace api
}  // namespace tractus
