#include "server/api/stations/station_state.hpp"

#include <algorithm>

#include "core/try.hpp"
#include "trial/trial.hpp"

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
  return core::Error{core::Errc::unavailable, "this server has no live connections to stations"};
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
    return core::Error{core::Errc::not_found, "there is no station with this id"};
  return *found;
}

std::vector<schema::Field> station_state_fields() {
  using namespace schema;
  const core::Json trial = object(
      {{"trial_id", text("Id of the running trial")},
       {"rig", one_of<trial::Rig>("Rig on which the trial runs")},
       {"case_title", nullable(text("Title of the palpation case; for an assigned trial the name "
                                    "that does not reveal the case; null for a scenario"))},
       {"person",
        nullable(
            text("Name of the person at the station; null if the caller may not see this person"))},
       {"t_s", number("s", "Time since the start of the trial, in seconds")},
       {"samples", integer("1", "Number of samples recorded so far")},
       {"force_N", nullable(number("N", "Force on the hand, in newtons; null in a blinded trial"))},
       {"depth_m", nullable(number("m", "Depth of the tip, in metres; null in a blinded trial"))},
       {"late_ticks", integer("1", "Number of late ticks of the haptic loop")}});
  const core::Json self_test = object(
      {{"at_utc_us", integer("us", "Time of the self-test, in microseconds since 1970-01-01 UTC")},
       {"passed", truth("True if every check passed")},
       {"failed",
        array(text("Name of a check"), "Names of the failed checks; empty if all passed")}});
  return {
      {"id", text("Id of the station, which never changes")},
      {"name", text("Name of the station")},
      {"connected", truth("True if the station's connection to the server is open")},
      {"state", one_of<wire::StationState>("State of the station; away: not connected")},
      {"since_utc_us", integer("us",
                               "Time when the station entered this state, in microseconds since "
                               "1970-01-01 UTC; 0 if the station never connected")},
      {"last_seen_utc_us", nullable(integer("us",
                                            "Time of the station's last message, in microseconds "
                                            "since 1970-01-01 UTC; null if there was none"))},
      {"version",
       nullable(text("Version of the station's program; null until the station reports it"))},
      {"device", nullable(text("Device in use, with its name for the option --device; null until "
                               "the station reports it"))},
      {"simulated",
       nullable(truth("True if device and hand are simulated; null until the station reports it"))},
      {"trial", nullable(trial)},
      {"clock_offset_s",
       nullable(number(
           "s",
           "Server's clock minus the station's clock, in seconds; null until it is measured"))},
      {"clock_error_s",
       nullable(number(
           "s", "Bound of the error of clock_offset_s, in seconds; null until it is measured"))},
      {"free_disk_bytes",
       nullable(integer(
           "B", "Free space on the station's disk, in bytes; null until the station reports it"))},
      {"late_share",
       nullable(number("1",
                       "Share of late ticks among all ticks since the station's program started, 0 "
                       "to 1; null until the station reports it"))},
      {"waiting_trials", nullable(integer("1",
                                          "Number of recorded trials that the station has not "
                                          "uploaded yet; null until the station reports it"))},
      {"calibration_due_utc_us",
       nullable(integer("us",
                        "Time when the next calibration is due, in microseconds since 1970-01-01 "
                        "UTC; null if no date is known"))},
      {"self_test", nullable(self_test)}};
}

}  // namespace tractus::api
