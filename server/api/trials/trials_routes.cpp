/// Trials: the list, one whole, its curves and its path.
#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/finding/list_request.hpp"
#include "server/api/schema.hpp"
#include "server/api/trials/trial_json.hpp"
#include "server/api/trials/trial_signals.hpp"
#include "server/api/trials/uploads.hpp"
#include "server/jobs/case_facts.hpp"
#include "server/jobs/scenario_facts.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace api {
namespace {

constexpr double kLatestTrial_s = 1e6;

core::Result<http::Response> list_trials(const Call& call) {
  store::TrialFilter whose;
  if (call.of == Scope::cohort) whose.taught_by = call.caller.id;
  if (call.of == Scope::own) whose.seen_by = call.caller.id;
  const auto request = TRY(list_request(call, store::trial_list()));
  const auto found = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::find_trials(tx, request, whose); }));
  core::Json list = core::Json::array();
  for (const store::TrialSummary& trial : found.trials) list.push_back(summary_json(trial));
  return json_response(
      with_page({{"trials", list}, {"more", !found.page.next.empty()}}, found.page));
}

struct Found {
  store::TrialRecord trial;
  std::vector<store::ScoreRecord> scores;
};

core::Result<Found> find_trial(const Call& call) {
  const std::string& id = call.text("id");
  return call.backend.store.read([&](store::Reading& tx) -> core::Result<Found> {
    auto trial = TRY(store::trial_of(tx, id));
    if (!trial) return core::Error{core::Errc::not_found, "no trial " + id.substr(0, 32)};
    auto scores = TRY(store::scores_of(tx, id));
    return Found{std::move(*trial), std::move(scores)};
  });
}

core::Json truth_json(const std::optional<cases::Truth>& truth) {
  if (!truth) return {};
  core::Json out = truth->to_json();
  core::Json shown = core::Json::object();  // without the salt
  for (const char* field : {"breached", "breach_m", "breach_depth_m", "wall_thickness_m"})
    shown[field] = out.contains(field) ? out[field] : core::Json();
  if (truth->breached && !truth->breach_m)
    shown["wall_thickness_m"] = nullptr;  // a trainee drilled the hole
  return shown;
}

/// The place of the trial in its study; none for a trial without a study.
core::Result<std::optional<StudyPlace>> study_place(Backend& backend, const std::string& trial_id) {
  using Place = std::optional<StudyPlace>;
  return backend.store.read([&](store::Reading& tx) -> core::Result<Place> {
    auto slot = TRY(store::slot_of_trial(tx, trial_id));
    if (!slot) return Place();
    auto title = TRY(store::series_title(tx, slot->study_id));
    auto trial = TRY(store::study_trial_of(tx, trial_id));
    return Place(StudyPlace{std::move(title), std::move(*slot), trial->state, trial->reason});
  });
}

core::Result<TrialFacts> trial_facts(Backend& backend, const store::TrialRecord& trial) {
  auto header = TRY(header_of(trial));
  const std::string& case_id = trial.summary.case_id;
  TrialFacts out;
  auto study = TRY(study_place(backend, trial.summary.id));
  out.study = std::move(study);
  auto clock = TRY(backend.store.read(
      [&](store::Reading& tx) { return store::trial_clock_of(tx, trial.summary.id); }));
  out.clock = clock;
  if (header.rig == trial::Rig::probing) {
    auto scenario = TRY(jobs::scenario_of(backend.store, backend.objects, case_id));
    out.scenario = std::move(scenario);
    return out;
  }
  auto facts = TRY(jobs::facts_of_trial(backend.store, backend.objects, case_id, header));
  out.tract = facts.definition.tract;
  out.truth = truth_json(facts.truth);
  return out;
}

core::Result<http::Response> one_trial(const Call& call) {
  auto found = TRY(find_trial(call));
  auto facts = TRY(trial_facts(call.backend, found.trial));
  if (found.trial.summary.name_hidden && call.of != Scope::own) {
    found.trial.summary.operator_name.clear(), found.trial.summary.person.clear();
    facts.study.reset();  // the place in a study or an assignment tells whose trial it is
  }
  return json_response(trial_json(found.trial, found.scores, facts));
}

std::vector<std::string> channels_of(const Call& call, const trial::Signals& signals) {
  if (call.text("channels") == "all") return signals.channels();
  std::vector<std::string> out;
  std::string_view rest = call.text("channels");
  while (!rest.empty()) {
    const auto end = std::min(rest.find(','), rest.size());
    out.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return out;
}

core::Result<http::Response> trial_signals(const Call& call) {
  auto signals = TRY(signals_of(call.backend, call.text("id")));
  const auto channels = channels_of(call, *signals);
  if (channels.size() > trial::kChannels.size())
    return core::Error{core::Errc::bad_input, "channels: a channel may be named only once"};
  auto view = TRY(signals->view(channels, call.number("from_s"), call.number("to_s"),
                                static_cast<std::size_t>(call.integer("points"))));
  core::Json shown = core::Json::object();
  for (const auto& [name, envelope] : view.channels)
    shown[name] = {{"min", envelope.min}, {"max", envelope.max}};
  return json_response({{"t_s", view.t_s},
                        {"channels", shown},
                        {"from_s", view.from_s},
                        {"to_s", view.to_s},
                        {"samples_per_point", view.samples_per_point}});
}

core::Result<http::Response> trial_path(const Call& call) {
  auto signals = TRY(signals_of(call.backend, call.text("id")));
  const trial::Path path = signals->path(static_cast<std::size_t>(call.integer("points")));
  core::Json tips = core::Json::array();
  for (const math::Vec3& tip : path.tip_m) tips.push_back({tip.x(), tip.y(), tip.z()});
  return json_response({{"t_s", path.t_s}, {"tip_m", tips}, {"force_N", path.force_N}});
}

core::Result<http::Response> trial_force_depth(const Call& call) {
  auto signals = TRY(signals_of(call.backend, call.text("id")));
  if (signals->rig() != trial::Rig::probing)
    return core::Error{
        core::Errc::not_found,
        "force against depth exists only for probing trials; this is a palpation trial"};
  const auto curve = signals->force_against_depth(static_cast<std::size_t>(call.integer("points")));
  core::Json modes = core::Json::array();
  for (const trial::ProbingMode mode : curve.mode) modes.push_back(trial::name(mode));
  return json_response({{"t_s", curve.t_s},
                        {"depth_m", curve.depth_m},
                        {"force_N", curve.force_N},
                        {"mode", modes}});
}

Parameter query(std::string name, Parameter::Kind kind, std::string unit, std::string meaning,
                double low, double high, std::string fallback) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = kind,
          .unit = std::move(unit),
          .meaning = std::move(meaning),
          .low = low,
          .high = high,
          .fallback = std::move(fallback)};
}

RouteInfo trial_route(std::string tail, std::string id, std::string summary, std::string answer) {
  return {.method = "GET",
          .path = "/api/v1/trials" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin,
                  Role::director,
                  {Role::faculty, Scope::cohort},
                  {Role::trainee, Scope::own}},
          .object = tail.empty() ? Object::none : Object::trial,
          .parameters = {},
          .body = "",
          .answer = std::move(answer),
          .schemas = {},
          .handle = nullptr};
}

}  // namespace

std::vector<RouteInfo> trials_routes() {
  using Kind = Parameter::Kind;
  const Parameter id = path_text("id", "Id of the trial, 32 hexadecimal characters");
  RouteInfo list = trial_route(
      "", "trials", "List trials, newest first or in another order, all or those of a search",
      "TrialList");
  list.parameters = list_parameters(store::trial_list(), "person, operator, case or station");
  list.schemas = trial_schemas();
  list.handle = list_trials;

  RouteInfo one = trial_route("/{id}", "trial",
                              "Read one trial with its scores and the truth of its case", "Trial");
  one.parameters = {id};
  one.handle = one_trial;

  RouteInfo curves = trial_route("/{id}/signals", "trialSignals",
                                 "Read channels of a trial over time; each point states the "
                                 "smallest and largest value of its samples",
                                 "TrialSignals");
  curves.parameters = {
      id,
      query("channels", Kind::text, "",
            "Names of channels, separated by commas; all: every channel of the trial", 0, 0, "all"),
      query("from_s", Kind::number, "s",
            "Start of the time range, in seconds since the start of the trial", 0, kLatestTrial_s,
            "0"),
      query("to_s", Kind::number, "s",
            "End of the time range, in seconds since the start of the trial", 0, kLatestTrial_s,
            "1000000"),
      query("points", Kind::integer, "1", "Largest number of points in the answer", 1, 20000,
            "1000")};
  curves.schemas = curve_schemas();
  curves.handle = trial_signals;

  RouteInfo path =
      trial_route("/{id}/path", "trialPath",
                  "Read the path of the probe's tip in a palpation trial", "TrialPath");
  path.parameters = {id, query("points", Kind::integer, "1",
                               "Largest number of points in the answer", 1, 20000, "2000")};
  path.handle = trial_path;

  RouteInfo depths = trial_route("/{id}/force-depth", "trialForceDepth",
                                 "Read force against depth of a probing trial, in order of time",
                                 "TrialForceDepth");
  depths.parameters = {id, query("points", Kind::integer, "1",
                                 "Largest number of points in the answer", 2, 20000, "2000")};
  depths.handle = trial_force_depth;
  return {list, one, curves, path, depths};
}

}  // namespace api
}  // namespace tractus
