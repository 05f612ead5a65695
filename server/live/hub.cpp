#include "server/live/hub.hpp"

#include <algorithm>

namespace tractus {
namespace live {
namespace {

std::shared_ptr<const std::string> text_of(const core::Json& json) {
  return std::make_shared<const std::string>(
      json.dump(-1, ' ', false, core::Json::error_handler_t::replace));
}

}  // namespace

Hub::Hub(Parts parts) : parts_(std::move(parts)) {}

bool Hub::sees_person(const Known& known, const Viewer& viewer) const {
  if (viewer.sees == Viewer::Sees::everybody) return true;
  return viewer.sees == Viewer::Sees::taught && known.shown.teachers.contains(viewer.account_id);
}

core::Json Hub::json_of(const Known& known, const Viewer& viewer) const {
  const wire::StationStatus& told = known.told;
  core::Json trial;
  if (known.connected && told.trial) {
    const wire::LiveTrial& t = *told.trial;
    trial = {
        {"trial_id", t.trial_id},
        {"rig", core::name(t.rig)},
        {"case_title", core::or_null(known.shown.case_title)},
        {"person", sees_person(known, viewer) ? core::or_null(known.shown.person) : core::Json()},
        {"t_s", t.t_s},
        {"samples", t.samples},
        {"force_N", core::or_null(t.force_N)},
        {"depth_m", core::or_null(t.depth_m)},
        {"late_ticks", t.late_ticks}};
  }
  return {
      {"id", known.station.id},
      {"name", known.station.name},
      {"connected", known.connected},
      {"state", core::name(known.connected ? told.state : wire::StationState::away)},
      {"since_utc_us", known.since_utc_us},
      {"last_seen_utc_us", known.seen_utc_us > 0 ? core::Json(known.seen_utc_us) : core::Json()},
      {"version", core::or_null(told.version)},
      {"device", core::or_null(told.device)},
      {"simulated", core::or_null(told.simulated)},
      {"trial", trial},
      {"clock_offset_s", core::or_null(told.clock_offset_s)},
      {"clock_error_s", core::or_null(told.clock_error_s)},
      {"free_disk_bytes", core::or_null(told.free_disk_bytes)},
      {"late_share", core::or_null(told.late_share)},
      {"waiting_trials", core::or_null(told.waiting_trials)},
      {"calibration_due_utc_us", core::or_null(told.calibration_due_utc_us)},
      {"self_test", told.self_test ? told.self_test->to_json() : core::Json()}};
}

core::Json Hub::state_json(const StationRef& station, const Viewer& viewer) const {
  const std::lock_guard held(mutex_);
  const auto found = stations_.find(station.id);
  if (found != stations_.end()) return json_of(found->second, viewer);
  Known away;
  away.station = station;
  return json_of(away, viewer);
}

Hub::Known& Hub::known(const StationRef& station) {
  Known& out = stations_[station.id];
  out.station = station;
  return out;
}

/// The state, and what follows from it.
void Hub::take(Known& known, wire::StationStatus told, std::int64_t seen_utc_us) {
  if (told.state != known.told.state) known.since_utc_us = seen_utc_us;
  // A station that does not say keeps what its reports said.
  if (!told.self_test) told.self_test = std::move(known.told.self_test);
  if (!told.calibration_due_utc_us) told.calibration_due_utc_us = known.told.calibration_due_utc_us;
  if (told.version.empty()) told.version = std::move(known.told.version);
  known.told = std::move(told);
  known.seen_utc_us = seen_utc_us;
  const std::string now_of = known.told.trial ? known.told.trial->case_id : std::string();
  if (now_of == known.shown_of) return;
  known.shown_of = now_of;
  known.shown = {};
  known.shown_due = due_ = !now_of.empty();
  if (known.shown_due) changed_.notify_all();
}

/// To all who look on.
void Hub::show(const Known& known) const {
  Texts texts;
  for (const auto& [_, watching] : viewers_) {
    auto& text = sees_person(known, watching.viewer) ? texts.with : texts.without;
    if (!text) text = text_of({{"kind", "station"}, {"station", json_of(known, watching.viewer)}});
    watching.line->send(known.station.id, text);
  }
}

void Hub::connected(const StationRef& station, std::shared_ptr<http::WebSocketSender> line) {
  const std::lock_guard held(mutex_);
  Known& it = known(station);
  if (it.line) it.line->end();
  it.line = std::move(line);
  it.connected = true;
  it.held_by.clear();
  it.since_utc_us = it.seen_utc_us = parts_.now_utc_us();
  it.told.state = wire::StationState::idle;
  it.told.trial.reset();
  it.untold = it.unkept = due_ = true;
  show(it);
  changed_.notify_all();
}

void Hub::told(const StationRef& station, wire::StationStatus told) {
  const std::lock_guard held(mutex_);
  Known& it = known(station);
  it.untold = it.unkept = true;
  take(it, std::move(told), parts_.now_utc_us());
  show(it);
}

void Hub::left(const StationRef& station, const http::WebSocketSender* line,
               http::CloseReason why) {
  using enum http::CloseReason;
  const std::lock_guard held(mutex_);
  if (why == too_large || why == flood || why == invalid_message)
    refusals_.emplace_back(station, std::string(http::text_of(why)));
  due_ = true;
  changed_.notify_all();
  Known& it = known(station);
  if (it.line.get() != line) return;  // another has taken its place
  it.line.reset();
  it.connected = false;
  it.since_utc_us = parts_.now_utc_us();
  it.untold = it.unkept = true;
  it.told_others_utc_us = 0;
  show(it);
}

void Hub::watches(const void* key, Viewer viewer, std::shared_ptr<http::WebSocketSender> line) {
  const std::lock_guard held(mutex_);
  core::Json list = core::Json::array();
  std::vector<const Known*> by_name;
  for (const auto& [_, one] : stations_) by_name.push_back(&one);
  std::ranges::sort(by_name, {}, [](const Known* one) { return one->station.name; });
  for (const Known* one : by_name) list.push_back(json_of(*one, viewer));
  line->send("", text_of({{"kind", "stations"}, {"stations", list}}));
  viewers_.insert_or_assign(key, Watching{std::move(viewer), std::move(line)});
}

void Hub::watches_no_more(const void* key) {
  const std::lock_guard held(mutex_);
  viewers_.erase(key);
}

core::Result<void> Hub::command(const std::string& station_id,
                                const wire::StationCommand& command) {
  const core::Error away{core::Errc::conflict, "the station is not connected"};
  {
    const std::lock_guard held(mutex_);
    const auto found = stations_.find(station_id);
    if (found == stations_.end() || !found->second.connected) return away;
    if (found->second.line) {
      found->second.line->send(command.kind == wire::StationCommand::Kind::stop ? "stop" : "limits",
                               text_of(command.to_json()));
      return {};
    }
  }
  if (!listening_) return away;
  return parts_.store.signals().send(
      "live", core::Json{{"to", station_id}, {"command", command.to_json()}}.dump());
}

void Hub::dismiss(const std::string& station_id) {
  const std::lock_guard held(mutex_);
  const auto found = stations_.find(station_id);
  if (found != stations_.end() && found->second.line) found->second.line->end();
}

void Hub::dismiss_viewers(const std::string& account_id) {
  const std::lock_guard held(mutex_);
  for (const auto& [_, watching] : viewers_)
    if (watching.viewer.account_id == account_id) watching.line->end();
}

void Hub::reported(const StationRef& station, const wire::StationReport& report) {
  const std::lock_guard held(mutex_);
  Known& it = known(station);
  const auto newer = [&](std::int64_t at) {
    return !it.told.self_test || at >= it.told.self_test->at_utc_us;
  };
  if (report.self_test && newer(report.self_test->at_utc_us))
    it.told.self_test = report.self_test->summary();
  if (report.calibration && report.calibration->due_utc_us)
    it.told.calibration_due_utc_us = report.calibration->due_utc_us;
  if (!report.version.empty()) it.told.version = report.version;
  if (report.free_disk_bytes) it.told.free_disk_bytes = report.free_disk_bytes;
  it.seen_utc_us = parts_.now_utc_us();
  it.untold = it.unkept = due_ = true;
  show(it);
  changed_.notify_all();
}

}  // namespace live
}  // namespace tractus
