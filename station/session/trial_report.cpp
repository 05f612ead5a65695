#include "station/session/trial_report.hpp"

namespace tractus::session {

core::Json TrialReport::to_json() const {
  core::Json out = {{"trial_id", trial_id},
                    {"file", file.string()},
                    {"simulated", simulated},
                    {"complete", complete},
                    {"fault", fault},
                    {"duration_s", duration_s},
                    {"wake_p50_us", wake_p50_us},
                    {"wake_p99_us", wake_p99_us},
                    {"work_p50_us", work_p50_us},
                    {"work_p99_us", work_p99_us},
                    {"injected_J", injected_J},
                    {"realtime", grant.to_json()},
                    {"ticks", counts.samples},
                    {"late_ticks", counts.late},
                    {"skipped_ticks", counts.skipped},
                    {"not_converged", counts.not_converged},
                    {"limited", counts.limited},
                    {"stale", counts.stale},
                    {"lost_samples", lost}};
  if (bus)
    out["bus"] = {{"missed_periods", counts.missed},
                  {"lost_exchanges", counts.bus_lost},
                  {"restarts", bus->restarts},
                  {"round_trip_p50_us", bus->p50_us},
                  {"round_trip_p99_us", bus->p99_us}};
  if (!headset.is_null()) out["headset"] = headset;
  if (drilled) {
    out["drilled"] = drilled->detail;
    out["drilled"]["lag_p50_s"] = drilled->lag_p50_s;
    out["drilled"]["lag_p99_s"] = drilled->lag_p99_s;
  }
  out["answer"] = answer ? answer->to_json() : core::Json();
  return out;
}

}  // namespace tractus::session
