/// The two kinds of conversation that a hub holds.
#include <atomic>

#include "server/live/hub.hpp"

namespace live {

/// A station says its state, and hears commands.
class StationTalk final : public http::Conversation {
 public:
  StationTalk(Hub& hub, StationRef station, MayStay may_stay)
      : hub_(hub), station_(std::move(station)), may_stay_(std::move(may_stay)) {}
  http::ConversationLimits limits() const override {
    return {.max_message_bytes = 8 * 1024, .messages_per_s = 30.0, .pause = {}};
  }
  void begin(std::shared_ptr<http::Line> line) override {
    line_ = line.get();
    hub_.connected(station_, std::move(line));
  }
  bool hear(std::string_view text) override {
    const auto json = core::parse_json(text, "state");
    if (!json) return false;
    auto told = wire::StationTold::from_json(*json, "state");
    if (!told) return false;
    hub_.told(station_, std::move(*told));
    return true;
  }
  bool may_stay() override { return may_stay_(); }
  void ended(http::Parting why) override { hub_.left(station_, line_, why); }

 private:
  Hub& hub_;
  StationRef station_;
  MayStay may_stay_;
  const http::Line* line_ = nullptr;
};

/// Somebody looks on. What they send is not listened to.
class ViewerTalk final : public http::Conversation {
 public:
  ViewerTalk(Hub& hub, Viewer viewer, MayStay may_stay)
      : hub_(hub), viewer_(std::move(viewer)), may_stay_(std::move(may_stay)) {}
  http::ConversationLimits limits() const override {
    return {
        .max_message_bytes = 1024, .messages_per_s = 5.0, .pause = std::chrono::milliseconds(50)};
  }
  void begin(std::shared_ptr<http::Line> line) override {
    hub_.watches(this, viewer_, std::move(line));
  }
  bool hear(std::string_view) override { return true; }
  bool may_stay() override { return may_stay_(); }
  void ended(http::Parting) override { hub_.watches_no_more(this); }

 private:
  Hub& hub_;
  Viewer viewer_;
  MayStay may_stay_;
};

std::shared_ptr<http::Conversation> Hub::station_talk(const StationRef& station, MayStay may_stay) {
  return std::make_shared<StationTalk>(*this, station, std::move(may_stay));
}

core::Result<std::shared_ptr<http::Conversation>> Hub::viewer_talk(const Viewer& viewer,
                                                                   MayStay may_stay) {
  {
    const std::lock_guard held(mutex_);
    std::size_t own = 0;
    for (const auto& [_, watching] : viewers_)
      own += watching.viewer.account_id == viewer.account_id;
    if (viewers_.size() >= kMostViewers || own >= kMostViewersOfOne)
      return core::Error{core::Errc::unavailable, "too many look on already: close some first"};
  }
  return std::shared_ptr<http::Conversation>(
      std::make_shared<ViewerTalk>(*this, viewer, std::move(may_stay)));
}

}  // namespace live
