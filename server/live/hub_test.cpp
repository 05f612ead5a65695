/// Two servers on one database: what one hears, the other shows; what one is asked, the other does.
#include "server/live/hub.hpp"

#include <gtest/gtest.h>

#include "core/clock.hpp"
#include "db/store/people/accounts.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace live {
namespace {
using test_support::DatabaseKind;
using test_support::TestDatabase;

/// Keeps what was said last under each key, for a test to wait for.
class Ear final : public http::WebSocketSender {
 public:
  void send(const std::string& key, std::shared_ptr<const std::string> text) override {
    const std::lock_guard held(mutex_);
    said_[key] = core::Json::parse(*text, nullptr, false);
    changed_.notify_all();
  }
  void end() override {}
  /// Until `wanted` takes what was said under `key`.
  template <class Wanted>
  bool hears(const std::string& key, Wanted wanted) {
    std::unique_lock held(mutex_);
    return changed_.wait_for(held, std::chrono::seconds(20), [&] {
      const auto found = said_.find(key);
      return found != said_.end() && wanted(found->second);
    });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, core::Json> said_;
};

auto in_state(const char* state) {
  return [state](const core::Json& frame) { return frame["station"]["state"] == state; };
}

class Hubs : public ::testing::Test {
 protected:
  Hubs() {
    const auto added = here_store_.write([](store::Writing& tx) {
      return store::add_station(tx, {"s1", "station-1"}, std::string(64, 'a'), 0);
    });
    EXPECT_TRUE(added);
    EXPECT_TRUE(here_.start());
    EXPECT_TRUE(there_.start());
  }
  static MayStay always() {
    return [] { return true; };
  }
  std::shared_ptr<http::WebSocketHandler> wall(Hub& hub, const std::shared_ptr<Ear>& ear) {
    auto talk = hub.viewer_talk({.account_id = "ann", .sees = Viewer::Sees::everybody}, always());
    EXPECT_TRUE(talk);
    (*talk)->begin(ear);
    return *talk;
  }

  TestDatabase database_{DatabaseKind::postgresql};
  store::Store here_store_ = database_.open(), there_store_ = database_.open();
  Hub here_{{.store = here_store_, .now_utc_us = core::utc_us}};
  Hub there_{{.store = there_store_, .now_utc_us = core::utc_us}};
};

TEST_F(Hubs, AWallAtOneServerShowsTheStationsOfAnother) {
  const auto ear = std::make_shared<Ear>();
  const auto watching = wall(there_, ear);
  const auto talk = here_.station_talk({"s1", "station-1"}, always());
  talk->begin(std::make_shared<Ear>());
  EXPECT_TRUE(ear->hears("s1", in_state("idle")));
  ASSERT_TRUE(talk->on_message(R"({"kind":"state","state":"preparing","version":"7"})"));
  EXPECT_TRUE(ear->hears("s1", in_state("preparing")));
  talk->ended(http::CloseReason::disconnected);
  EXPECT_TRUE(ear->hears("s1", in_state("away")));
  watching->ended(http::CloseReason::disconnected);
}

TEST_F(Hubs, AServerThatComesLaterAsksWhoIsThere) {
  const auto talk = here_.station_talk({"s1", "station-1"}, always());
  talk->begin(std::make_shared<Ear>());
  ASSERT_TRUE(talk->on_message(R"({"kind":"state","state":"questions"})"));
  store::Store later_store = database_.open();
  Hub later({.store = later_store, .now_utc_us = core::utc_us});
  ASSERT_TRUE(later.start());
  const auto ear = std::make_shared<Ear>();
  const auto watching = wall(later, ear);
  EXPECT_TRUE(ear->hears("s1", in_state("questions")));
  watching->ended(http::CloseReason::disconnected);
  talk->ended(http::CloseReason::disconnected);
}

TEST_F(Hubs, AStopReachesTheStationWhicheverServerHoldsItsLine) {
  const auto line = std::make_shared<Ear>();
  const auto ear = std::make_shared<Ear>();
  const auto watching = wall(there_, ear);
  const auto talk = here_.station_talk({"s1", "station-1"}, always());
  talk->begin(line);
  ASSERT_TRUE(ear->hears("s1", in_state("idle")));
  ASSERT_TRUE(there_.command("s1", {.reason = "look at the hand"}));
  EXPECT_TRUE(line->hears("stop", [](const core::Json& said) {
    return said == core::Json{{"kind", "stop"}, {"reason", "look at the hand"}};
  }));
  EXPECT_FALSE(there_.command("s2", {.reason = "nobody"}));
  talk->ended(http::CloseReason::disconnected);
  watching->ended(http::CloseReason::disconnected);
}

}  // namespace
}  // namespace live
}  // namespace tractus
