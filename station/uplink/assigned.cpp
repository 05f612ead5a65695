#include "station/uplink/assigned.hpp"

#include "core/try.hpp"

namespace tractus {
namespace uplink {
namespace {

core::Result<core::Json> asked(Server& server, const std::string& tail, const core::Json& body) {
  const std::string text = body.dump();
  const Request request{.method = "POST",
                        .path = "/api/v1/work/" + tail,
                        .headers = {{"Content-Type", "application/json"}},
                        .body = core::bytes_of(text)};
  auto answer = TRY(server.send(request));
  if (answer.status == 204) return core::Json::object();
  return json_of(request, answer);
}

}  // namespace

core::Result<Ticket> sign_in(Server& server, const std::string& badge, const std::string& pin) {
  auto json = TRY(asked(server, "sign-in", {{"badge", badge}, {"pin", pin}}));
  core::Fields fields(json, "the server's ticket: ");
  Ticket out{fields.text("ticket", 64), fields.text("name", 200),
             fields.text_or("language", "", 16)};
  TRY(fields.done());
  return out;
}

core::Result<wire::AssignedWork> next_trial(Server& server, const Ticket& ticket) {
  auto json = TRY(asked(server, "next", {{"ticket", ticket.text}}));
  return wire::AssignedWork::from_json(json, "the server's trial: ");
}

core::Result<wire::TrialResult> trial_result(Server& server, const Ticket& ticket,
                                             const std::string& trial_id) {
  auto json = TRY(asked(server, "result", {{"ticket", ticket.text}, {"trial", trial_id}}));
  return wire::TrialResult::from_json(json, "the server's result: ");
}

void sign_out(Server& server, const Ticket& ticket, const std::string& unstarted) {
  core::Json body{{"ticket", ticket.text}};
  if (!unstarted.empty()) body["unstarted"] = unstarted;
  [[maybe_unused]] const auto said = asked(server, "sign-out", body);
}

}  // namespace uplink
}  // namespace tractus
