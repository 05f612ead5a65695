/// What a person decides in a running study: pause and go on, give back what a station holds, say
/// that a trial does not count. Each is kept with who, when and why.
#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/study_json.hpp"

namespace tractus {
namespace api {
namespace {

using store::StudyState;

constexpr std::uint64_t kMaxDeed_bytes = 4096;
constexpr std::size_t kMaxStudyReason = 500;

core::Error no_participant(const std::string& name) {
  return {core::Errc::not_found, "no participant " + name.substr(0, 32) + " in this study"};
}

/// Reads the body's "reason" (and "state", where there is one).
struct Said {
  std::string reason;
  StudyState state = StudyState::running;
};
core::Result<Said> said(const Call& call, bool with_state, bool needs_reason) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "");
  Said out;
  out.reason = fields.text_or("reason", "", kMaxStudyReason);
  if (needs_reason && out.reason.find_first_not_of(" \t\n") == std::string::npos)
    fields.wrong("reason", "a reason is expected");
  if (with_state) out.state = fields.word<StudyState>("state");
  TRY(fields.done());
  return out;
}

/// Runs `work(tx, study, stamp)` in one transaction and answers with the study as it then is.
template <class Work>
core::Result<http::Response> act_on_study(const Call& call, const std::string& reason, Work work) {
  const std::string& id = call.text("id");
  auto facts = TRY(call.backend.store.write([&](store::Writing& tx) -> core::Result<StudyFacts> {
    auto study = TRY(store::find_study(tx, id));
    const store::AuditStamp done_by{call.caller.name, call.backend.now_utc_us(), reason};
    TRY(work(tx, study, done_by));
    return study_facts(tx, study);
  }));
  return json_response(study_json(facts));
}

core::Result<http::Response> set_study_state(const Call& call) {
  auto asked = TRY(said(call, true, false));
  return act_on_study(call, asked.reason,
                      [&](store::Writing& tx, const store::StudyId& study,
                          const store::AuditStamp& by) -> core::Result<void> {
                        auto now = TRY(store::study_of(tx, study));
                        if (now.state == asked.state) return {};
                        return store::set_study_state(tx, study, asked.state, by);
                      });
}

core::Result<http::Response> set_participant(const Call& call) {
  auto asked = TRY(said(call, true, false));
  const std::string& name = call.text("name");
  return act_on_study(call, asked.reason,
                      [&](store::Writing& tx, const store::StudyId& study,
                          const store::AuditStamp& by) -> core::Result<void> {
                        auto who = TRY(store::participant_of(tx, study, name));
                        if (!who) return no_participant(name);
                        if (who->state == asked.state) return {};
                        return store::set_participant_state(tx, study, name, asked.state, by);
                      });
}

core::Result<http::Response> release(const Call& call) {
  auto asked = TRY(said(call, false, true));
  const std::string& name = call.text("name");
  return act_on_study(call, asked.reason,
                      [&](store::Writing& tx, const store::StudyId& study,
                          const store::AuditStamp& by) -> core::Result<void> {
                        auto who = TRY(store::participant_of(tx, study, name));
                        if (!who) return no_participant(name);
                        TRY(store::release_slots(tx, study, name, by));
                        return {};
                      });
}

core::Result<http::Response> invalidate_slot(const Call& call) {
  auto asked = TRY(said(call, false, true));
  return act_on_study(
      call, asked.reason,
      [&](store::Writing& tx, const store::StudyId& study, const store::AuditStamp& by) {
        return store::set_trial_invalid(tx, study, call.text("trial_id"), by);
      });
}

RouteInfo study_actions_route(std::string tail, std::string id, std::string summary,
                              std::string body) {
  return {.method = "POST",
          .path = "/api/v1/studies/{id}" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin, Role::researcher},
          .parameters = {path_text("id", "Id of the study")},
          .body = std::move(body),
          .body_limit_bytes = kMaxDeed_bytes,
          .answer = "Study",
          .schemas = {},
          .handle = nullptr};
}

}  // namespace

std::vector<RouteInfo> study_actions_routes() {
  using namespace schema;
  const core::Json reason =
      text("Reason for the change, shown in the list of changes, at most 500 characters");
  const Parameter name = path_text("name", "Pseudonym of the participant");
  RouteInfo whole =
      study_actions_route("/state", "setStudyState", "Pause or continue a study", "StateChange");
  whole.schemas = {
      {"StateChange",
       object({{"state", one_of<StudyState>("New state; paused: stations receive no trials")},
               {"reason", optional(reason)}})},
      {"Reason", object({{"reason", reason}})}};
  whole.handle = set_study_state;
  RouteInfo one = study_actions_route("/participants/{name}/state", "setParticipantState",
                                      "Pause or continue a participant of a study", "StateChange");
  one.parameters.push_back(name);
  one.handle = set_participant;
  RouteInfo free =
      study_actions_route("/participants/{name}/release", "releaseParticipant",
                          "Release the trials of a participant that a station has taken, so that "
                          "any station can take them again",
                          "Reason");
  free.parameters.push_back(name);
  free.handle = release;
  RouteInfo invalid =
      study_actions_route("/trials/{trial_id}/invalid", "markTrialInvalid",
                          "Mark a trial invalid, so that it does not count; the server keeps the "
                          "trial and repeats its place as the study states",
                          "Reason");
  invalid.parameters.push_back(path_text("trial_id", "Id of the trial, 32 hexadecimal characters"));
  invalid.handle = invalidate_slot;
  return {whole, one, free, invalid};
}

}  // namespace api
}  // namespace tractus
