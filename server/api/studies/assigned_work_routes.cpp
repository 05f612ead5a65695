/// A trainee at a station: badge and PIN in, the next assigned trial out.
#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/studies/assignments.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/people/throttle.hpp"
#include "server/api/schema.hpp"
#include "server/api/trials/uploads.hpp"
#include "server/jobs/scenario_facts.hpp"
#include "study/sealed_law.hpp"
#include "wire/assigned_work.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr std::uint64_t kMaxBody_bytes = 1024;

/// A ticket is a session of this trainee at this station: it opens nothing elsewhere, and no
/// browser's cookie is one.
std::string ticket_hash(const Call& call, const std::string& ticket) {
  return token_hash("ticket " + call.caller.id + " " + ticket);
}

Result<store::Account> let_in(Backend& backend, const store::Attempt& attempt,
                              const std::string& pin) {
  auto account = TRY(backend.store.read(
      [&](store::Reading& tx) { return store::account_with_badge(tx, attempt.name); }));
  const bool right = password_matches(account ? account->pin_hash : "", pin);
  if (!account) store::AuditScope::without_detail();
  if (right && account->state == "active" && account->role == name(Role::trainee))
    return std::move(*account);
  TRY(note_failure(backend, attempt));
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
  const std::string ticket = new_token();
  const std::int64_t now = call.backend.now_utc_us();
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(check_unchanged(tx, account));
    TRY(note_success(tx, account.id, attempt, now));
    return store::add_session(tx, ticket_hash(call, ticket), account.id, now);
  }));
  return json_response({{"ticket", ticket}, {"name", account.name}});
}

/// Whose ticket the body holds, as long as it lasts.
Result<store::Account> holder(const Call& call, std::string& hash) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  hash = ticket_hash(call, fields.text("ticket", 64));
  TRY(fields.done());
  auto session =
      TRY(call.backend.store.read([&](store::Reading& tx) { return store::session_of(tx, hash); }));
  const std::int64_t now = call.backend.now_utc_us();
  if (!session || now - session->seen_utc_us > kSessionIdle_us ||
      now - session->made_utc_us > kSessionAge_us || session->account.state != "active")
    return Error{Errc::forbidden, "sign in at this station first"};
  return std::move(session->account);
}

Result<http::Response> sign_out_at_station(const Call& call) {
  std::string hash;
  TRY(holder(call, hash));
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return store::remove_session(tx, hash); }));
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

/// The next slot of whichever assignment is to be done first, given to this station.
struct Given {
  wire::AssignedWork work;
  std::optional<store::Slot> slot = {};
  std::string token_hash = {};
};

/// What the station is told of the trial that is next.
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
  if (trial.rig == store::kPalpation) trial.case_id = slot.case_id;
  if (slot.planned) {
    auto drilling = TRY(store::drilling_of(tx, slot.id));
    trial.drills = drilling.empty();
    trial.drilled = std::move(drilling);
  }
  return trial;
}

/// Gives the account's next slot of one assignment, where it has one now.
Result<void> take_of(store::Writing& tx, const Call& call, const store::Assignment& assignment,
                     const store::Account& account, Given& given) {
  if (assignment.study.state == "paused") return {};
  auto id = TRY(store::find_assignment(tx, assignment.study.id));
  auto participant = TRY(store::participant_for(tx, id, account.id));
  auto person = TRY(store::participant_of(tx, id, participant));
  if (!person || person->state == "paused") return {};
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
  store::AuditScope::is_by(account.name + " at " + call.caller.name, account.role);
  auto given = TRY(call.backend.store.write([&](store::Writing& tx) -> Result<Given> {
    TRY(store::touch_session(tx, hash, call.backend.now_utc_us()));
    return take(tx, call, account);
  }));
  if (given.slot && given.work.trial->rig == store::kProbing) {
    auto scenario =
        TRY(jobs::scenario_of(call.backend.store, call.backend.objects, given.slot->case_id));
    auto law = TRY(scenario.expanded());
    auto sealed = TRY(study::sealed_law(law, given.slot->id, study::StationKey(given.token_hash)));
    given.work.trial->sealed = std::move(sealed);
  }
  return json_response(given.work.to_json());
}

RouteInfo route(std::string tail, std::string id, std::string summary, std::string body,
                std::string answer, Result<http::Response> (*handle)(const Call&)) {
  return {.method = "POST",
          .path = "/api/v1/work/" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::station},
          .parameters = {},
          .body = std::move(body),
          .body_limit_bytes = kMaxBody_bytes,
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> assigned_work_routes() {
  using namespace schema;
  RouteInfo in = route("sign-in", "signInAtStation",
                       "A trainee by badge and PIN; after five failures at a station, one attempt "
                       "in three minutes",
                       "BadgeAndPin", "Ticket", sign_in_at_station);
  in.lane = http::Lane::hashing;
  in.schemas = {{"BadgeAndPin", object({{"badge", text("as read")}, {"pin", text("as typed")}})},
                {"Ticket", object({{"ticket", text("for this station alone")},
                                   {"name", text("of the account, to greet by")}})}};
  RouteInfo next = route("next", "nextTrial",
                         "Exactly the next assigned trial; the same until it is handed over",
                         "TicketShown", "AssignedWork", next_trial);
  next.schemas = {
      {"TicketShown", object({{"ticket", text("from signInAtStation")}})},
      {"AssignedTrial",
       object({{"slot", text("64 hexadecimal characters: the trial's case_id")},
               {"rig", one_of({"palpation", "probing"}, "that it is for")},
               {"name", text("what the trainee is shown")},
               {"assignment", text("its title")},
               {"number", integer("1", "of the trainee's trials in it, from 1")},
               {"planned", integer("1", "in all")},
               {"case_id", text("of a palpation case; else empty")},
               {"sealed", text("of a scenario, for this station alone; else empty")},
               {"tool", optional(one_of({"probe", "burr"},
                                        "burr: the bone is whole, the channel "
                                        "is drilled now; probe without"))},
               {"drilled", optional(text("trial of this station whose channel is felt now"))}})},
      {"AssignedWork", object({{"participant", text("a pseudonym; empty without a trial")},
                               {"left", integer("1", "still to be done")},
                               {"trial", nullable(ref("AssignedTrial"))}})}};
  RouteInfo out = route("sign-out", "signOutAtStation", "The trainee leaves the station",
                        "TicketShown", "", sign_out_at_station);
  return {in, next, out};
}

}  // namespace api
}  // namespace tractus
