/// The stations of this server's database as they are just now.
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

/// Who looks on, and which people they may see.
struct Viewer {
  std::string account_id;
  enum class Sees { nobody, taught, everybody } sees = Sees::nobody;
};

/// Asked now and then on a worker: are the credentials that opened the line still good?
using MayStay = std::function<bool()>;

/// Safe from several threads.
class Hub {
 public:
  struct Parts {
    store::Store& store;
    std::function<std::int64_t()> now_utc_us;
    /// A station was hung up on for what it sent; from the hub's own thread.
    std::function<void(const StationRef&, const std::string& why)> refused = {};
    std::function<void(const core::Json&)> log = {};
  };
  explicit Hub(Parts parts);
  ~Hub();
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;

  /// Reads what is kept, listens to the other processes, starts the hub's thread. Without it a hub
  /// works for itself alone (tests).
  core::Result<void> start();

  /// A line of a station's; a second one takes the first's place.
  std::shared_ptr<http::WebSocketHandler> station_talk(const StationRef& station,
                                                       MayStay still_allowed);
  /// Errors: unavailable when too many look on.
  core::Result<std::shared_ptr<http::WebSocketHandler>> viewer_talk(const Viewer& viewer,
                                                                    MayStay still_allowed);

  /// StationState of the contract. Of a station that was never heard: away.
  core::Json state_json(const StationRef& station, const Viewer& viewer) const;
  /// Hands it to the station's line, whichever process holds it. Errors: conflict when none does.
  core::Result<void> command(const std::string& station_id, const wire::StationCommand& command);
  /// Hangs up on a station that was shut out.
  void dismiss(const std::string& station_id);
  /// Hangs up on those who look on by this account: its sessions were ended.
  void dismiss_viewers(const std::string& account_id);
  /// What a report said, into the state that is shown.
  void reported(const StationRef& station, const wire::StationReport& report);

  /// Does at once what waits for the database; the hub's thread does it by itself.
  void catch_up();

  static constexpr std::size_t kMostViewers = 128, kMostViewersOfOne = 12;

 private:
  friend class StationTalk;
  friend class ViewerTalk;
  struct Known {
    StationRef station;
    bool connected = false;
    std::string held_by;  ///< the process; empty: this one
    wire::StationStatus told;
    std::int64_t since_utc_us = 0, seen_utc_us = 0;
    store::ShownTrial shown;
    std::string shown_of;  ///< the case id that `shown` is of
    bool shown_due = false;
    std::shared_ptr<http::WebSocketSender> line;
    bool untold = false, unkept = false;  ///< to the other processes, on the disk
    std::int64_t told_others_utc_us = 0;
  };
  struct Watching {
    Viewer viewer;
    std::shared_ptr<http::WebSocketSender> line;
  };
  /// One state as text, made once for all who see the person and once for the others.
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
