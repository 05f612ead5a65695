/// The hub's own thread: what waits for the database, and for the other processes.
#include "core/try.hpp"
#include "db/store/people/accounts.hpp"
#include "server/live/hub.hpp"

namespace tractus {
namespace live {
namespace {

constexpr const char* kChannel = "live";
constexpr std::chrono::milliseconds kTick{50};
constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::int64_t kTellEvery_us = kSecond_us / 5, kAliveEvery_us = 5 * kSecond_us;
constexpr std::int64_t kSilent_us = 15 * kSecond_us, kKeepEvery_us = 10 * kSecond_us;
constexpr std::int64_t kNamesEvery_us = 5 * kSecond_us;

core::Json for_others(const StationRef& station, bool connected, std::int64_t since_utc_us,
                      std::int64_t seen_utc_us, const wire::StationStatus& told) {
  return {{"id", station.id},           {"name", station.name},
          {"connected", connected},     {"since_utc_us", since_utc_us},
          {"seen_utc_us", seen_utc_us}, {"told", told.to_json()}};
}

}  // namespace

core::Result<void> Hub::start() {
  auto kept = TRY(parts_.store.read([](store::Reading& tx) { return store::stations_last(tx); }));
  refresh_names();
  {
    const std::lock_guard held(mutex_);
    for (const store::StationLast& last : kept) {
      const auto found = stations_.find(last.station_id);
      if (found == stations_.end()) continue;
      const auto json = core::parse_json(last.told, "station_states");
      if (!json) continue;  // of another release: the station says it anew
      auto told = wire::StationStatus::from_json(*json, "station_states");
      if (!told) continue;
      told->trial.reset();
      found->second.told = std::move(*told);
      found->second.since_utc_us = found->second.seen_utc_us = last.seen_utc_us;
    }
  }
  auto listening = TRY(parts_.store.signals().listen(
      kChannel, [this](const store::Signal& signal) { hear_other(signal); }));
  listening_ = std::move(listening);
  send({{"ask", true}});
  thread_ = std::thread([this] { keep(); });
  return {};
}

Hub::~Hub() {
  listening_.reset();
  {
    const std::lock_guard held(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Hub::note(const core::Error& error) const {
  if (parts_.log) parts_.log({{"what", "live"}, {"error", error.what}});
}

void Hub::keep() {
  std::int64_t kept = parts_.now_utc_us(), named = kept;
  for (bool last = false; !last;) {
    {
      std::unique_lock held(mutex_);
      changed_.wait_for(held, kTick, [this] { return ending_ || due_; });
      last = ending_;
      due_ = false;
    }
    catch_up();
    const std::int64_t now = parts_.now_utc_us();
    if (now - named > kNamesEvery_us) {
      refresh_names();
      forget_silent();
      named = now;
    }
    if (last || now - kept > kKeepEvery_us) {
      keep_states();
      kept = now;
    }
  }
}

void Hub::catch_up() {
  look_up_shown();
  note_refusals();
  tell_others();
}

void Hub::look_up_shown() {
  std::vector<std::pair<std::string, std::string>> wanted;
  {
    const std::lock_guard held(mutex_);
    for (auto& [id, one] : stations_)
      if (std::exchange(one.shown_due, false)) wanted.emplace_back(id, one.shown_of);
  }
  for (const auto& [id, case_id] : wanted) {
    auto shown =
        parts_.store.read([&](store::Reading& tx) { return store::shown_trial(tx, id, case_id); });
    if (!shown) {
      note(shown.error());
      continue;
    }
    const std::lock_guard held(mutex_);
    Known& one = stations_[id];
    if (one.shown_of != case_id) continue;
    one.shown = std::move(*shown);
    show(one);
  }
}

void Hub::keep_states() {
  std::vector<store::StationLast> states;
  {
    const std::lock_guard held(mutex_);
    for (auto& [id, one] : stations_) {
      if (!one.unkept || !one.held_by.empty()) continue;
      one.unkept = false;
      states.push_back({id, one.seen_utc_us, one.told.to_json().dump()});
    }
  }
  if (states.empty()) return;
  const auto kept = parts_.store.write([&](store::Writing& tx) -> core::Result<void> {
    for (const auto& state : states) TRY(store::set_station_last(tx, state));
    return {};
  });
  if (!kept) note(kept.error());
}

void Hub::note_refusals() {
  std::vector<std::pair<StationRef, std::string>> refusals;
  {
    const std::lock_guard held(mutex_);
    refusals.swap(refusals_);
  }
  if (!parts_.refused) return;
  for (const auto& [station, why] : refusals) parts_.refused(station, why);
}

void Hub::refresh_names() {
  auto found = parts_.store.read([](store::Reading& tx) { return store::all_stations(tx); });
  if (!found) return note(found.error());
  const std::lock_guard held(mutex_);
  for (const store::StationEntry& entry : *found) {
    if (entry.revoked_utc_us) {
      const auto gone = stations_.find(entry.station.id);
      if (gone == stations_.end()) continue;
      if (gone->second.line) gone->second.line->end();
      if (!gone->second.connected) stations_.erase(gone);
    } else if (!stations_.contains(entry.station.id)) {
      show(known({entry.station.id, entry.station.name}));
    }
  }
  // Who teaches whom may have changed: who left a cohort no longer sees its people.
  for (auto& [_, one] : stations_)
    if (!one.shown_of.empty()) one.shown_due = due_ = true;
}

/// States of this process's own stations, several in one message.
void Hub::tell_others() {
  constexpr std::size_t kMost = store::Signals::kMostPayload_bytes - 64;
  std::vector<core::Json> messages;
  std::size_t size = kMost;
  {
    const std::lock_guard held(mutex_);
    const std::int64_t now = parts_.now_utc_us();
    for (auto& [_, one] : stations_) {
      if (!one.held_by.empty()) continue;
      const std::int64_t ago = now - one.told_others_utc_us;
      const bool alive = one.connected && ago > kAliveEvery_us;
      if (!alive && !(one.untold && ago > kTellEvery_us)) continue;
      one.untold = false;
      one.told_others_utc_us = now;
      core::Json state =
          for_others(one.station, one.connected, one.since_utc_us, one.seen_utc_us, one.told);
      const std::size_t more = state.dump().size() + 1;
      if (size + more > kMost) {
        messages.push_back({{"stations", core::Json::array()}});
        size = 0;
      }
      messages.back()["stations"].push_back(std::move(state));
      size += more;
    }
  }
  for (const core::Json& message : messages) send(message);
}

void Hub::send(const core::Json& message) {
  if (!listening_) return;
  if (auto sent = parts_.store.signals().send(kChannel, message.dump()); !sent) note(sent.error());
}

/// What another process holds and has not spoken of for a while is away.
void Hub::forget_silent() {
  const std::lock_guard held(mutex_);
  const std::int64_t now = parts_.now_utc_us();
  for (auto& [_, one] : stations_) {
    if (one.held_by.empty() || !one.connected || now - one.told_others_utc_us < kSilent_us)
      continue;
    one.connected = false;
    one.since_utc_us = now;
    show(one);
  }
}

void Hub::hear_other(const store::Signal& signal) {
  if (signal.from == parts_.store.signals().own_id()) return;
  const auto json = core::parse_json(signal.payload.empty() ? R"({"ask":true})" : signal.payload,
                                     "live signal", core::kStoredJson);
  if (!json || !json->is_object()) return;
  const std::lock_guard held(mutex_);
  if (json->contains("ask"))
    for (auto& [_, one] : stations_)
      if (one.line) one.untold = due_ = true, one.told_others_utc_us = 0;
  if (json->contains("stations") && (*json)["stations"].is_array())
    for (const core::Json& one : (*json)["stations"]) take_from_other(one, signal.from);
  if (json->contains("to") && json->contains("command")) {
    const auto found = stations_.find(json->value("to", ""));
    const auto command = wire::StationCommand::from_json((*json)["command"], "live signal");
    if (found != stations_.end() && found->second.line && command)
      found->second.line->send(
          command->kind == wire::StationCommand::Kind::stop ? "stop" : "limits",
          std::make_shared<const std::string>((*json)["command"].dump()));
  }
  changed_.notify_all();
}

void Hub::take_from_other(const core::Json& one, const std::string& from) {
  core::Fields fields(one, "live signal");
  const StationRef station{fields.text("id", 64), fields.text("name", 256)};
  const core::Json* connected = fields.member("connected");
  const std::int64_t since = fields.integer("since_utc_us", 0, INT64_MAX);
  const std::int64_t seen = fields.integer("seen_utc_us", 0, INT64_MAX);
  const core::Json* said = fields.member("told");
  if (!fields.done() || !connected->is_boolean()) return;
  auto told = wire::StationStatus::from_json(*said, "live signal");
  if (!told) return;
  Known& it = known(station);
  if (it.line) return;  // it is here
  take(it, std::move(*told), seen);
  it.connected = connected->get<bool>();
  it.held_by = from;
  it.since_utc_us = since;
  it.told_others_utc_us = parts_.now_utc_us();
  it.unkept = false;
  show(it);
}

}  // namespace live
}  // namespace tractus
