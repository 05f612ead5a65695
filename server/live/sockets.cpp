/// The two kinds of conversation that a hub holds.
#include <atomic>

#include "server/live/hub.hpp"

namespace tractus::live {

/// A station says its state, and hears commands.
class StationTalk final : public http::WebSocketHandler {
 public:
  StationTalk(Hub& hub, StationRef station, MayStay still_allowed)
      : hub_(hub), station_(std::move(station)), may_stay_(std::move(still_allowed)) {}
  http::WebSocketLimits limits() const override {
    return {.max_message_bytes = 8 * 1024, .messages_per_s = 30.0, .pause = {}};
  }
  void begin(std::shared_ptr<http::WebSocketSender> line) override {
    line_ = line.get();
    hub_.connected(station_, std::move(line));
  }
  bool on_message(std::string_view text) override {
    const auto json = core::parse_json(text, "state");
    if (!json) return false;
    auto told = wire::StationStatus::from_json(*json, "state");
    if (!told) return false;
    hub_.told(station_, std::move(*told));
    return true;
  }
  bool still_allowed() override { return may_stay_(); }
  void ended(http::CloseReason why) override { hub_.left(station_, line_, why); }

 private:
  Hub& hub_;
  StationRef station_;
  MayStay may_stay_;
  const http::WebSocketSender* line_ = nullptr;
};

/// Somebody looks on. What they send is not listened to.
class ViewerTalk final : public http::WebSocketHandler {
 public:
  ViewerTalk(Hub& hub, Viewer viewer, MayStay still_allowed)
      : hub_(hub), viewer_(std::move(viewer)), may_stay_(std::move(still_allowed)) {}
  http::WebSocketLimits limits() const override {
    return {
        .max_message_bytes = 1024, .messages_per_s = 5.0, .pause = std::chrono::milliseconds(50)};
  }
  void begin(std::shared_ptr<http::WebSocketSender> line) override {
    hub_.watches(this, viewer_, std::move(line));
  }
  bool on_message(std::string_view) override { return true; }
  bool still_allowed() override { return may_stay_(); }
  void ended(http::CloseReason) override { hub_.watches_no_more(this); }

 private:
  Hub& hub_;
  Viewer viewer_;
  MayStay may_stay_;
};

std::shared_ptr<http::WebSocketHandler> Hub::station_talk(const StationRef& station,
                                                          MayStay still_allowed) {
  return std::make_shared<StationTalk>(*this, station, std::move(still_allowed));
}

core::Result<std::shared_ptr<http::WebSocketHandler>> Hub::viewer_talk(const Viewer& viewer,
                                                                       MayStay still_allowed) {
  {
    const std::lock_guard held(mutex_);
    std::size_t own = 0;
    for (const auto& [_, watching] : viewers_)
      own += watching.viewer.account_id == viewer.account_id;
    if (viewers_.size() >= kMostViewers || own >= kMostViewersOfOne)
      return core::Error{core::Errc::unavailable, "too many live pages are open: close some first"};
  }
  return std::shared_ptr<http::WebSocketHandler>(
      std::make_shared<ViewerTalk>(*this, viewer, std::move(still_allowed)));
}

}  // namespace tractus::live
