/// A trainee's assignments, as a station asks for them.
#pragma once

#include "station/uplink/server.hpp"
#include "wire/assigned_work.hpp"
#include "wire/trial_result.hpp"

namespace tractus::uplink {

struct Ticket {
  std::string text;           ///< opens the trainee's assignments to this station alone
  std::string name;           ///< to greet by
  std::string language = {};  ///< of the person's screens; empty: not chosen
};
/// Errors: unauthorised (badge or PIN), unavailable (locked out for a while, or no server).
core::Result<Ticket> sign_in(Server& server, const std::string& badge, const std::string& pin);
/// Exactly the next trial; the same until it was handed over. Errors: conflict when another station
/// holds it (the server's own words).
core::Result<wire::AssignedWork> next_trial(Server& server, const Ticket& ticket);
/// As far as the trainee may see it now.
core::Result<wire::TrialResult> trial_result(Server& server, const Ticket& ticket,
                                             const std::string& trial_id);
/// What cannot be said now ends by itself.
/// @param unstarted  slot of the trial that was read and not begun, which another station can then
///                   have; empty if there is none
void sign_out(Server& server, const Ticket& ticket, const std::string& unstarted);

}  // namespace tractus::uplink
