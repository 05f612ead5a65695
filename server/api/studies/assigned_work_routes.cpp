/// A trainee at a station: badge and PIN in, the next assigned trial out.
#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/people/people.hpp"
#include "db/store/studies/assignments.hpp"
#include "db/store/studies/blinding.hpp"
#include "db/store/trials/trials.hpp"
#include "metrics/metric.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/group_admission.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/people/throttle.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/passing.hpp"
#include "server/api/trials/uploads.hpp"
#include "server/jobs/scenario_facts.hpp"
#include "study/sealed_law.hpp"
#include "trial/trial.hpp"
#include "wire/assigned_work.hpp"
#include "wire/trial_result.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using store::AccountState;

constexpr std::uint64_t kMaxAssignedWork_bytes = 1024;

/// A ticket is a session of one trainee at one station: it is not valid at other stations, and a
/// browser's cookie is not valid as a ticket.
std::string ticket_hash(const Call& call, const std::string& ticket) {
  return token_hash("ticket " + call.caller.id + " " + ticket);
}

Result<store::Account> let_in(Backend& backend, const store::Attempt& attempt,
                              const std::string& pin) {
  auto account = TRY(backend.store.read(
      [&](store::Reading& tx) { return store::account_with_badge(tx, attempt.name); }));
  const bool right = password_matches(account ? account->pin_hash : "", pin);
  if (!account) store::AuditScope::without_detail();
  if (right && account->state == AccountState::active && account->role == Role::trainee)
    return std::move(*account);
  TRY(note_failure(backend, attempt));
  return Error{Errc::unauthorised, "badge or PIN is wrong"};
}

/// Somebody whom the identity provider has not vouched for in too long has left, badge or not.
Result<void> refuse_absent(const Call& call, const store::Account& account, std::int64_t now) {
  const auto absent =
      TRY(call.backend.store.read([&](store::Reading& tx) { return is_absent(tx, account, now); }));
  if (!absent) return {};
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return disable_absent(tx, account, now); }));
  return Error{Errc::unauthorised, "badge or PIN is wrong"};
}

Result<http::Response> sign_in_at_station(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string badge = fields.text("badge", kMaxBadge), pin = fields.text("pin", kMaxPin);
  TRY(fields.done());
  const store::Attempt attempt{store::Secret::badge_pin, badge, call.caller.id};
  auto early = TRY(too_early(call.backend, attempt));
  if (early) return std::move(*early);
  auto account = TRY(let_in(call.backend, attempt, pin));
  const std::int64_t now = call.backend.now_utc_us();
  TRY(refuse_absent(call, account, now));
  const std::string ticket = new_token();
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(check_unchanged(tx, account));
    TRY(note_success(tx, account.id, attempt, now));
    return store::add_session(tx, ticket_hash(call, ticket), account.id, now);
  }));
  core::Json answer{{"ticket", ticket}, {"name", account.name}};
  if (!account.language.empty()) answer["language"] = account.language;
  return json_response(answer);
}

/// The account to which the ticket belongs. Errors: forbidden if the ticket is unknown or has
/// expired.
Result<store::Account> holder_of(const Call& call, const std::string& hash) {
  auto session =
      TRY(call.backend.store.read([&](store::Reading& tx) { return store::session_of(tx, hash); }));
  const std::int64_t now = call.backend.now_utc_us();
  if (!session || now - session->seen_utc_us > kSessionIdle_us ||
      now - session->made_utc_us > kSessionAge_us || session->account.state != AccountState::active)
    return Error{Errc::forbidden, "sign in at this station first"};
  return std::move(session->account);
}

/// Of the ticket in the body, which holds nothing else.
Result<store::Account> holder(const Call& call, std::string& hash) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  hash = ticket_hash(call, fields.text("ticket", 64));
  TRY(fields.done());
  return holder_of(call, hash);
}

/// Releases a slot that was handed out to the calling station for this trainee and that has no
/// trial, so that the trainee can go on at another station. Any other slot stays as it is.
Result<void> release_unstarted(store::Writing& tx, const Call& call, const store::Account& account,
                               const std::string& slot_id) {
  auto slot = TRY(store::slot_of(tx, slot_id));
  if (!slot) return {};
  auto id = store::find_assignment(tx, slot->study_id);
  if (!id && id.error().code == core::Errc::not_found)
    return {};  // of a study, whose slots a researcher releases
  if (!id) return id.error();
  auto participant = TRY(store::participant_for(tx, *id, account.id));
  if (slot->participant != participant) return {};
  return store::release_unstarted_slot(tx, *slot, call.caller.id,
                                       {call.caller.name, call.backend.now_utc_us()});
}

Result<http::Response> sign_out_at_station(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string hash = ticket_hash(call, fields.text("ticket", 64));
  const std::string unstarted = fields.text_or("unstarted", "", 64);
  TRY(fields.done());
  auto account = TRY(holder_of(call, hash));
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    if (!unstarted.empty()) TRY(release_unstarted(tx, call, account, unstarted));
    return store::remove_session(tx, hash);
  }));
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

/// The next slot of the assignment that is due first, handed out to the calling station.
struct Given {
  wire::AssignedWork work;
  std::optional<store::Slot> slot = {};
  std::string token_hash = {};
};

/// The description of the next trial for the station.
Result<wire::AssignedTrial> trial_of_slot(store::Reading& tx, const store::AssignmentId& id,
                                          const std::string& title, const store::Taken& taken) {
  const store::Slot& slot = taken.slots.front();
  auto name = TRY(store::assigned_name(tx, id, slot.case_id));
  auto of = TRY(store::case_of(tx, slot.case_id));
  wire::AssignedTrial trial{.slot = slot.id,
                            .rig = of->kind,
                            .name = name,
                            .assignment = title,
                            .number = taken.planned - taken.unfinished + 1,
                            .planned = taken.planned,
                            .case_id = "",
                            .sealed = ""};
  if (trial.name.empty()) trial.name = "Trial " + std::to_string(trial.number);
  if (trial.rig == trial::Rig::palpation) trial.case_id = slot.case_id;
  if (slot.planned) {
    auto drilling = TRY(store::drilling_of(tx, slot.id));
    trial.drills = drilling.empty();
    trial.drilled = std::move(drilling);
  }
  return trial;
}

/// Hands out the account's next slot of one assignment, if there is one now.
Result<void> take_of(store::Writing& tx, const Call& call, const store::Assignment& assignment,
                     const store::Account& account, Given& given) {
  if (assignment.study.state == store::StudyState::paused) return {};
  const auto offered = TRY(may_be_handed_out(tx, account.id, assignment.study.id));
  if (!offered) return {};
  auto id = TRY(store::find_assignment(tx, assignment.study.id));
  auto participant = TRY(store::participant_for(tx, id, account.id));
  auto person = TRY(store::participant_of(tx, id, participant));
  if (!person || person->state == store::StudyState::paused) return {};
  auto taken = TRY(store::take_slots(tx, id, *person, call.caller.id, 1,
                                     {call.caller.name, call.backend.now_utc_us()}));
  given.work.left += taken.unfinished;
  if (taken.slots.empty()) return {};
  auto trial = TRY(trial_of_slot(tx, id, assignment.study.title, taken));
  given.work.participant = participant;
  given.work.trial = std::move(trial);
  given.slot = taken.slots.front();
  return {};
}

Result<Given> take(store::Writing& tx, const Call& call, const store::Account& account) {
  Given given;
  auto token = TRY(store::station_token_hash(tx, call.caller.id));
  given.token_hash = token;
  auto assignments = TRY(store::assignments_of(tx, {.led_by = "", .done_by = account.id}));
  for (const store::Assignment& assignment : assignments) {
    if (given.slot) {
      given.work.left += assignment.planned - assignment.done;
      continue;
    }
    TRY(take_of(tx, call, assignment, account, given));
  }
  return given;
}

Result<http::Response> next_trial(const Call& call) {
  std::string hash;
  auto account = TRY(holder(call, hash));
  TRY(check_room(call.backend, kTrialToCome_bytes));
  store::AuditScope::is_by(account.name + " at " + call.caller.name, name(account.role));
  auto given = TRY(call.backend.store.write([&](store::Writing& tx) -> Result<Given> {
    TRY(store::touch_session(tx, hash, call.backend.now_utc_us()));
    return take(tx, call, account);
  }));
  if (given.slot && given.work.trial->rig == trial::Rig::probing) {
    auto scenario =
        TRY(jobs::scenario_of(call.backend.store, call.backend.objects, given.slot->case_id));
    auto law = TRY(scenario.expanded());
    auto sealed = TRY(study::sealed_law(law, given.slot->id, study::StationKey(given.token_hash)));
    given.work.trial->sealed = std::move(sealed);
  }
  return json_response(given.work.to_json());
}

wire::ResultState result_state(store::AssessmentState state) {
  switch (state) {
    case store::AssessmentState::assessing:
      return wire::ResultState::assessing;
    case store::AssessmentState::assessed:
      return wire::ResultState::assessed;
    case store::AssessmentState::failed:
      return wire::ResultState::failed;
  }
  return wire::ResultState::failed;
}

/// The scores that a trainee's page follows, in its order.
std::vector<wire::ResultScore> followed_scores(const std::vector<store::ScoreRecord>& scores) {
  auto known = metrics::all();
  std::erase_if(known, [](const metrics::MetricInfo& info) { return info.followed == 0; });
  std::ranges::sort(known, {}, &metrics::MetricInfo::followed);
  std::vector<wire::ResultScore> out;
  for (const metrics::MetricInfo& info : known) {
    const auto found = std::ranges::find(scores, info.id, &store::ScoreRecord::metric_id);
    if (found == scores.end() || !found->value) continue;
    out.push_back({info.label, info.unit, std::string(name(info.shown_as)), *found->value});
  }
  return out;
}

/// What the trainee's own page shows of the trial now: nothing of one that is another's, held back
/// or blinded.
Result<wire::TrialResult> result_of(store::Reading& tx, const std::string& account_id,
                                    const std::string& trial_id) {
  auto seen = TRY(store::sees_own_trial(tx, account_id, trial_id));
  auto blind = TRY(store::is_blinded(tx, trial_id));
  if (!seen || blind) return wire::TrialResult{};
  auto trial = TRY(store::trial_of(tx, trial_id));
  if (!trial) return wire::TrialResult{};
  auto scores = TRY(store::scores_of(tx, trial_id));
  return wire::TrialResult{.state = result_state(trial->summary.state),
                           .correct = trial->summary.correct,
                           .scores = followed_scores(scores)};
}

Result<http::Response> trial_result(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string hash = ticket_hash(call, fields.text("ticket", 64));
  const std::string trial_id = fields.text("trial", 32);
  TRY(fields.done());
  auto account = TRY(holder_of(call, hash));
  auto result = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return result_of(tx, account.id, trial_id); }));
  return json_response(result.to_json());
}

RouteInfo assigned_work_route(std::string tail, std::string id, std::string summary,
                              std::string body, std::string answer,
                              Result<http::Response> (*handle)(const Call&)) {
  return {.method = "POST",
          .path = "/api/v1/work/" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::station},
          .parameters = {},
          .body = std::move(body),
          .body_limit_bytes = kMaxAssignedWork_bytes,
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> assigned_work_routes() {
  using namespace schema;
  RouteInfo in = assigned_work_route(
      "sign-in", "signInAtStation",
      "Sign a trainee in at the calling station with badge and PIN; after five "
      "failed attempts at a station, one attempt is allowed every three minutes",
      "BadgeAndPin", "Ticket", sign_in_at_station);
  in.lane = http::Lane::hashing;
  in.schemas = {
      {"BadgeAndPin", object({{"badge", text("Text that the station read from the badge")},
                              {"pin", text("PIN that the trainee typed")}})},
      {"Ticket",
       object({{"ticket", text("Ticket for further requests, valid only at the calling station")},
               {"name", text("Name of the account, for the greeting")},
               {"language", optional(text("Language that the person chose, for example de"))}})}};
  RouteInfo next =
      assigned_work_route("next", "nextTrial",
                          "Read the next assigned trial of the trainee; the answer stays the same "
                          "until the trial is uploaded",
                          "TicketShown", "AssignedWork", next_trial);
  next.schemas = {
      {"TicketShown", object({{"ticket", text("Ticket from signInAtStation")}})},
      {"AssignedTrial",
       object(
           {{"slot", text("Id of the slot, 64 hexadecimal characters; the station writes it as "
                          "case_id into the trial file and the upload")},
            {"rig", one_of<trial::Rig>("Rig for the trial")},
            {"name", text("Name of the trial that the trainee sees")},
            {"assignment", text("Title of the assignment")},
            {"number", integer("1",
                               "Number of the trial among the trainee's trials in the assignment, "
                               "counted from 1")},
            {"planned", integer("1", "Number of the trainee's trials in the assignment")},
            {"case_id", text("Id of the palpation case; empty for a probing trial")},
            {"sealed", text("Parameters of the scenario, encrypted for the calling station; empty "
                            "for a palpation trial")},
            {"tool", optional(one_of<trial::Tool>(
                         "burr: the bone is whole, and the trainee drills the channel "
                         "in this trial; probe (default): the trainee palpates"))},
            {"drilled", optional(text("Id of the trial at this station that drilled the channel "
                                      "which the trainee now palpates"))}})},
      {"AssignedWork",
       object({{"participant", text("Pseudonym of the trainee; empty if there is no trial")},
               {"left", integer("1", "Number of trials that the trainee still has to do")},
               {"trial", nullable(ref("AssignedTrial"))}})}};
  RouteInfo out = assigned_work_route("sign-out", "signOutAtStation",
                                      "Sign the trainee out at the calling station", "SignOut", "",
                                      sign_out_at_station);
  out.schemas = {
      {"SignOut",
       object({{"ticket", text("Ticket from signInAtStation")},
               {"unstarted", optional(text("Slot from nextTrial that the trainee did not begin: it "
                                           "is released, and another station can have it"))}})}};
  RouteInfo result = assigned_work_route(
      "result", "trialResultAtStation",
      "Read the result of a trial that the signed-in trainee did, as far as the trainee's own "
      "page shows it now",
      "TrialOfTicket", "TrialResult", trial_result);
  result.schemas = {
      {"TrialOfTicket", object({{"ticket", text("Ticket from signInAtStation")},
                                {"trial", text("Id of the trial, 32 hexadecimal characters")}})},
      {"ResultScore",
       object({{"label", text("Name of the metric")},
               {"unit", text("Unit of the value; 1 for a number without a unit")},
               {"shown_as", one_of<metrics::ShownAs>("How to write the value")},
               {"value", number("its unit", "Value, in the unit that the field unit states")}})},
      {"TrialResult",
       object({{"state", one_of<wire::ResultState>(
                             "held: the trainee may not see the result now; the other fields are "
                             "empty then")},
               {"correct", nullable(truth("True if the answer agrees with the truth; null if the "
                                          "answer or the truth is missing"))},
               {"scores", array(ref("ResultScore"), "Scores that the trainee's page follows")}})}};
  return {in, next, result, out};
}

}  // namespace api
}  // namespace tractus
