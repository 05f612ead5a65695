/// The current state of the stations of this server's database.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "db/store/stations/fleet.hpp"
#include "server/http/websocket_handler.hpp"
#include "wire/live.hpp"

namespace tractus::live {

struct StationRef {
  std::string id, name;
};

/// An account with an open live page, and the people whom it may see.
struct Viewer {
  std::string account_id;
  enum class Sees { nobody, taught, everybody } sees = Sees::nobody;
};

/// Called regularly on a worker thread. Returns whether the credentials that opened the WebSocket
/// are still valid.
using MayStay = std::function<bool()>;

/// Thread-safe.
class Hub {
 public:
  struct Parts {
    store::Store& store;
    std::function<std::int64_t()> now_utc_us;
    /// Called on the hub's own thread when a station's connection was closed because of its
    /// messages.
    std::function<void(const StationRef&, const std::string& why)> refused = {};
    std::function<void(const core::Json&)> log = {};
  };
  explicit Hub(Parts parts);
  ~Hub();
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;

  /// Reads the stored states, subscribes to the signals of the other processes, starts the hub's
  /// thread. Without `start` a hub works only within its process (for tests).
  core::Result<void> start();

  /// The handler for a station's WebSocket; a second connection of the station replaces the first.
  std::shared_ptr<http::WebSocketHandler> station_talk(const StationRef& station,
                                                       MayStay still_allowed);
  /// The handler for a viewer's WebSocket. Errors: unavailable if too many viewers are connected.
  core::Result<std::shared_ptr<http::WebSocketHandler>> viewer_talk(const Viewer& viewer,
                                                                    MayStay still_allowed);

  /// StationState as in the description of the API. A station that never connected is away.
  core::Json state_json(const StationRef& station, const Viewer& viewer) const;
  /// Sends the command over the station's connection, which any process may hold. Errors: conflict
  /// if the station is not connected.
  core::Result<void> command(const std::string& station_id, const wire::StationCommand& command);
  /// Closes the connection of a revoked station.
  void dismiss(const std::string& station_id);
  /// Closes the viewers' connections of this account, whose sessions were ended.
  void dismiss_viewers(const std::string& account_id);
  /// Adds a station's report to the state that viewers see.
  void reported(const StationRef& station, const wire::StationReport& report);

  /// Does the pending database work immediately; otherwise the hub's thread does it.
  void catch_up();

  static constexpr std::size_t kMostViewers = 128, kMostViewersOfOne = 12;

 private:
  friend class StationTalk;
  friend class ViewerTalk;
  struct Known {
    StationRef station;
    bool connected = false;
    std::string held_by;  ///< id of the process with the station's connection; empty: this process
    wire::StationStatus told;
    std::int64_t since_utc_us = 0, seen_utc_us = 0;
    store::ShownTrial shown;
    std::string shown_of;  ///< case id to which `shown` belongs
    bool shown_due = false;
    std::shared_ptr<http::WebSocketSender> line;
    bool untold = false, unkept = false;  ///< not yet sent to the other processes; not yet stored
    std::int64_t told_others_utc_us = 0;
  };
  struct Watching {
    Viewer viewer;
    std::shared_ptr<http::WebSocketSender> line;
  };
  /// One state as text: with the person for viewers who may see the person, and without.
  struct Texts {
    std::shared_ptr<const std::string> with, without;
  };

  void connected(const StationRef& station, std::shared_ptr<http::WebSocketSender> line);
  void told(const StationRef& station, wire::StationStatus told);
  void left(const StationRef& station, const http::WebSocketSender* line, http::CloseReason why);
  void watches(const void* key, Viewer viewer, std::shared_ptr<http::WebSocketSender> line);
  void watches_no_more(const void* key);

  Known& known(const StationRef& station);
  void take(Known& known, wire::StationStatus told, std::int64_t seen_utc_us);
  void show(const Known& known) const;
  core::Json json_of(const Known& known, const Viewer& viewer) const;
  bool sees_person(const Known& known, const Viewer& viewer) const;

  void keep();
  void look_up_shown();
  void keep_states();
  void note_refusals();
  void refresh_names();
  void tell_others();
  void forget_silent();
  void hear_other(const store::Signal& signal);
  void take_from_other(const core::Json& one, const std::string& from);
  void send(const core::Json& message);
  void note(const core::Error& error) const;

  Parts parts_;
  std::unique_ptr<store::Listening> listening_;
  mutable std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  std::map<std::string, Known> stations_;
  std::map<const void*, Watching> viewers_;
  std::vector<std::pair<StationRef, std::string>> refusals_;
  bool ending_ = false, due_ = false;
  std::thread thread_;  ///< runs keep()
};

}  // namespace tractus::live
