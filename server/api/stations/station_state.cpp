#include "server/api/stations/station_state.hpp"

#include <algorithm>

#include "core/try.hpp"

namespace tractus::api {

live::Viewer viewer_of(const Caller& caller) {
  using Sees = live::Viewer::Sees;
  live::Viewer out{.account_id = caller.id, .sees = Sees::nobody};
  if (caller.role == Role::admin || caller.role == Role::director) out.sees = Sees::everybody;
  if (caller.role == Role::faculty) out.sees = Sees::taught;
  return out;
}

core::Result<live::Hub*> hub_of(Backend& backend) {
  if (backend.live) return backend.live;
  return core::Error{core::Errc::unavailable, "this server holds no lines to stations"};
}

core::Json station_json(Backend& backend, const store::StationEntry& entry, const Caller& caller) {
  core::Json out{{"id", entry.station.id}, {"name", entry.station.name}};
  if (backend.live)
    out = backend.live->state_json({entry.station.id, entry.station.name}, viewer_of(caller));
  out["enrolled_utc_us"] = entry.enrolled_utc_us;
  out["revoked_utc_us"] = entry.revoked_utc_us ? core::Json(*entry.revoked_utc_us) : core::Json();
  return out;
}

core::Result<store::StationEntry> station_entry(Backend& backend, const std::string& id) {
  auto all = TRY(backend.store.read([](store::Reading& tx) { return store::all_stations(tx); }));
  const auto found =
      std::ranges::find(all, id, [](const store::StationEntry& entry) { return entry.station.id; });
  if (found == all.end())
    return core::Error{core::Errc::not_found, "there is no station by this id"};
  return *found;
}

std::vector<schema::Field> station_state_fields() {
  using namespace schema;
  const core::Json trial = object(
      {{"trial_id", text("of the trial that runs")},
       {"rig", one_of({"palpation", "probing"}, "it is on")},
       {"case_title", nullable(text("of a palpation case; of an assigned one its blind name"))},
       {"person", nullable(text("at the station; for those alone who may see them"))},
       {"t_s", number("s", "since its start")},
       {"samples", integer("1", "recorded so far")},
       {"force_N", nullable(number("N", "on the hand; null while it is blind"))},
       {"depth_m", nullable(number("m", "of the tip; null while it is blind"))},
       {"late_ticks", integer("1", "of its loop")}});
  const core::Json self_test = object({{"at_utc_us", integer("us", "since 1970, UTC")},
                                       {"passed", truth("every check")},
                                       {"failed", array(text("name of a check"), "that failed")}});
  return {{"id", text("never changes")},
          {"name", text("for people")},
          {"connected", truth("its line is open")},
          {"state", one_of(wire::station_states(), "away: not connected")},
          {"since_utc_us", integer("us", "in this state since, UTC; 0: never heard of")},
          {"last_seen_utc_us", nullable(integer("us", "it last said something, UTC"))},
          {"version", nullable(text("of its program"))},
          {"device", nullable(text("in use, as --device names it"))},
          {"simulated", nullable(truth("device and hand are simulated"))},
          {"trial", nullable(trial)},
          {"clock_offset_s", nullable(number("s", "server's clock less the station's"))},
          {"clock_error_s", nullable(number("s", "bound of the offset's error"))},
          {"free_disk_bytes", nullable(integer("B", "on the station's disk"))},
          {"late_share", nullable(number("1", "late ticks of all, since its program started"))},
          {"waiting_trials", nullable(integer("1", "not handed over yet"))},
          {"calibration_due_utc_us", nullable(integer("us", "UTC"))},
          {"self_test", nullable(self_test)}};
}

}  // namespace tractus::api
