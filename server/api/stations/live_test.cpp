/// Who sees what of stations at work, without sockets.
#include "db/store/operations/audit.hpp"
#include "server/api/people/people_test_support.hpp"
#include "server/live/hub.hpp"

namespace tractus {
namespace api {
namespace {
using testing::PeopleTest;

/// Keeps what was said last under each key.
class MessageLog final : public http::WebSocketSender {
 public:
  void send(const std::string& key, std::shared_ptr<const std::string> text) override {
    said[key] = core::Json::parse(*text, nullptr, false);
  }
  void end() override { ended = true; }
  std::map<std::string, core::Json> said;
  bool ended = false;
};

class LiveRoutes : public PeopleTest {
 protected:
  std::variant<http::Response, std::shared_ptr<http::WebSocketHandler>> open(
      const std::string& path, std::map<std::string, std::string> headers) {
    headers["host"] = "tractus.example";
    return converse(backend_, routes(), request("GET", "/api/v1" + path, std::move(headers)));
  }
  /// Somebody at a page of ours looks on.
  std::shared_ptr<MessageLog> watching(const std::string& account) {
    auto headers = as(account);
    headers["origin"] = "https://Tractus.example";
    auto opened = open("/live", headers);
    auto* talk = std::get_if<std::shared_ptr<http::WebSocketHandler>>(&opened);
    EXPECT_NE(talk, nullptr) << account;
    auto ear = std::make_shared<MessageLog>();
    if (talk) {
      (*talk)->begin(ear);
      talks_.push_back(*talk);
    }
    return ear;
  }
  std::shared_ptr<http::WebSocketHandler> station_line(std::shared_ptr<MessageLog> ear) {
    auto opened = open("/live/station", station("token-1"));
    auto talk = std::get<std::shared_ptr<http::WebSocketHandler>>(opened);
    talk->begin(std::move(ear));
    talks_.push_back(talk);
    return talk;
  }
  int refused(const std::string& path, const std::map<std::string, std::string>& headers) {
    const auto opened = open(path, headers);
    const auto* response = std::get_if<http::Response>(&opened);
    return response ? response->status : 101;
  }
  static std::string at_work(const std::string& case_id) {
    return core::Json{{"kind", "state"},
                      {"state", "trial"},
                      {"trial",
                       {{"trial_id", std::string(32, '1')},
                        {"rig", "palpation"},
                        {"case_id", case_id},
                        {"t_s", 1.0},
                        {"samples", 4000},
                        {"force_N", 1.0},
                        {"depth_m", 0.01},
                        {"late_ticks", 0}}}}
        .dump();
  }
  /// The slot of tom's assignment, given to station s1.
  std::string toms_slot() {
    auto slots = store_.read([](store::Reading& tx) {
      return store::study_slots(tx, store::find_assignment(tx, "a-tom").value());
    });
    EXPECT_TRUE(slots);
    const std::string id = slots->front().id;
    EXPECT_TRUE(store_.write([&](store::Writing& tx) {
      return tx.query("update study_slots set station_id = 's1' where id = ?", {id});
    }));
    return id;
  }

  std::vector<std::shared_ptr<http::WebSocketHandler>> talks_;
};

TEST_F(LiveRoutes, WhoIsAtAStationIsToldToThoseWhoMaySeeThem) {
  const auto line = station_line(std::make_shared<MessageLog>());
  std::map<std::string, std::shared_ptr<MessageLog>> ears;
  for (const char* name : {"ann", "dora", "fay", "flo", "ted"}) ears[name] = watching(name);
  ASSERT_TRUE(line->on_message(at_work(toms_slot())));
  hub_.catch_up();
  for (const char* name : {"ann", "dora", "fay"})
    EXPECT_EQ(ears[name]->said["s1"]["station"]["trial"]["person"], "tom") << name;
  for (const char* name : {"flo", "ted"})
    EXPECT_TRUE(ears[name]->said["s1"]["station"]["trial"]["person"].is_null()) << name;
  EXPECT_EQ(ears["ted"]->said["s1"]["station"]["trial"]["t_s"], 1.0) << "but that it works";
  EXPECT_TRUE(ears["ann"]->said["s1"]["station"]["trial"]["case_title"].is_null())
      << "an assigned case has its blind name alone";
  const auto person_in_list = [&](const char* account) {
    return json(get(account, "/stations"))["stations"][0]["trial"]["person"];
  };
  EXPECT_EQ(person_in_list("fay"), "tom");
  EXPECT_TRUE(person_in_list("flo").is_null());
}

TEST_F(LiveRoutes, AStationThatShowsAnothersSlotShowsNobody) {
  const std::string slot = toms_slot();
  auto opened = open("/live/station", station("token-2"));
  auto talk = std::get<std::shared_ptr<http::WebSocketHandler>>(opened);
  talk->begin(std::make_shared<MessageLog>());
  const auto ear = watching("ann");
  ASSERT_TRUE(talk->on_message(at_work(slot)));
  hub_.catch_up();
  EXPECT_TRUE(ear->said["s2"]["station"]["trial"]["person"].is_null());
  talk->ended(http::CloseReason::disconnected);
}

TEST_F(LiveRoutes, ACaseThatIsNotAssignedIsShownByItsTitle) {
  const auto line = station_line(std::make_shared<MessageLog>());
  const auto ear = watching("ann");
  ASSERT_TRUE(line->on_message(at_work(testing::kCase)));
  hub_.catch_up();
  EXPECT_EQ(ear->said["s1"]["station"]["trial"]["case_title"], "L3");
}

TEST_F(LiveRoutes, AWallIsForPagesOfOurOwn) {
  auto headers = as("ann");
  EXPECT_EQ(refused("/live", headers), 403) << "no Origin";
  for (const char* origin : {"https://evil.example", "null", "https://tractus.example.evil.example",
                             "https://tractus.example:8443", ""}) {
    headers["origin"] = origin;
    EXPECT_EQ(refused("/live", headers), 403) << origin;
  }
  EXPECT_EQ(refused("/live", {}), 401);
  EXPECT_EQ(refused("/live/station", station("token-1")), 101);
}

/// Every cell of roles × routes that are WebSockets, as the catalogue says.
TEST_F(LiveRoutes, EveryWebSocketIsRefusedToWhoIsNotNamed) {
  int cells = 0;
  for (const RouteInfo& route : routes()) {
    if (!route.converse) continue;
    for (const Role role : kRoles) {
      static const std::map<Role, std::string> names{
          {Role::admin, "ann"},      {Role::director, "dora"},  {Role::faculty, "fay"},
          {Role::researcher, "rex"}, {Role::technician, "ted"}, {Role::trainee, "tom"}};
      auto headers = role == Role::station ? station("token-1") : as(names.at(role));
      headers["origin"] = "https://tractus.example";
      const bool named =
          std::ranges::any_of(route.who, [&](const Grant& grant) { return grant.role == role; });
      EXPECT_EQ(refused(route.path.substr(7), headers), named ? 101 : 403)
          << route.id << " by " << name(role);
      ++cells;
    }
  }
  EXPECT_EQ(cells, 14) << "two WebSockets, seven roles";
}

TEST_F(LiveRoutes, ACommandGoesToTheStationsLineAndIntoTheTrail) {
  const auto ear = std::make_shared<MessageLog>();
  EXPECT_EQ(post("ted", "/stations/s1/limits", {{"force_N", 2.0}}).status, 409) << "it is away";
  const auto line = station_line(ear);
  EXPECT_EQ(post("fay", "/stations/s1/stop", {{"reason", "look"}}).status, 202);
  EXPECT_EQ(ear->said["stop"], (core::Json{{"kind", "stop"}, {"reason", "look"}}));
  EXPECT_EQ(post("fay", "/stations/s1/limits", {{"force_N", 2.0}}).status, 403);
  EXPECT_EQ(post("ted", "/stations/s1/limits", {{"force_N", 2.0}}).status, 202);
  EXPECT_EQ(ear->said["limits"], (core::Json{{"kind", "limits"}, {"force_N", 2.0}}));
  EXPECT_EQ(post("ted", "/stations/s1/limits", {{"force_N", -1.0}}).status, 400);
  auto rows = store_.read([](store::Reading& tx) { return store::audit_before(tx, 1000, 100); });
  ASSERT_TRUE(rows);
  const auto noted = [&](const std::string& what, const std::string& who) {
    return std::ranges::any_of(*rows, [&](const store::AuditRow& row) {
      return row.act.what == what && row.act.who == who;
    });
  };
  EXPECT_TRUE(noted("stopStation", "fay"));
  EXPECT_TRUE(noted("limitStation", "ted"));
}

TEST_F(LiveRoutes, WhoIsSignedOutMayNotStay) {
  auto headers = as("ann");
  headers["origin"] = "https://tractus.example";
  const auto opened = open("/live", headers);
  const auto talk = std::get<std::shared_ptr<http::WebSocketHandler>>(opened);
  EXPECT_TRUE(talk->still_allowed());
  EXPECT_EQ(ask(request("DELETE", "/api/v1/session", headers)).status, 204);
  EXPECT_FALSE(talk->still_allowed());
}

TEST_F(LiveRoutes, AnOpenWallIsNobodysPresence) {
  auto headers = as("ann");
  headers["origin"] = "https://tractus.example";
  const auto opened = open("/live", headers);
  const auto talk = std::get<std::shared_ptr<http::WebSocketHandler>>(opened);
  for (int minutes = 0; minutes < 115; minutes += 5) {
    now_ += 5ll * 60 * 1'000'000;
    EXPECT_TRUE(talk->still_allowed()) << minutes;
  }
  now_ += 10ll * 60 * 1'000'000;
  EXPECT_FALSE(talk->still_allowed()) << "idle for two hours";
}

TEST_F(LiveRoutes, RefusalsOfAStationAreNotedAndCannotFloodTheTrail) {
  for (int i = 0; i < 1000; ++i)
    EXPECT_EQ(ask(request("GET", "/api/v1/trials", station("token-2"))).status, 403);
  const auto rows_of = [&](const std::string& who) {
    auto rows = store_.read([](store::Reading& tx) { return store::audit_before(tx, 9999, 500); });
    std::vector<store::AuditRow> out;
    for (const auto& row : *rows)
      if (row.act.who == who) out.push_back(row);
    return out;
  };
  EXPECT_EQ(rows_of("station-2").size(), std::size_t(RefusalLimit::kBurst));
  now_ += 5ll * 60 * 1'000'000;
  EXPECT_EQ(ask(request("GET", "/api/v1/trials", station("token-2"))).status, 403);
  const auto rows = rows_of("station-2");
  ASSERT_EQ(rows.size(), std::size_t(RefusalLimit::kBurst) + 1);
  EXPECT_NE(rows.front().act.detail.find("\"refusals_not_noted\":990"), std::string::npos)
      << rows.front().act.detail;
  EXPECT_EQ(rows_of("station-1").size(), 0u) << "of its own allowance";
}

TEST_F(LiveRoutes, WhoseSessionsEndIsHungUpOnAtOnce) {
  const core::Json none = core::Json::object();
  for (const auto& [path, body] :
       {std::pair<std::string, core::Json>{"role", {{"role", "trainee"}}},
        {"state", {{"state", "disabled"}}},
        {"password", none},
        {"badge", none}}) {
    const auto watcher = watching("fay"), other = watching("flo");
    ASSERT_EQ(post("ann", "/accounts/fay/" + path, body).status, 200) << path;
    EXPECT_TRUE(watcher->ended) << path;
    EXPECT_FALSE(other->ended) << path;
    EXPECT_EQ(post("ann", "/accounts/fay/role", {{"role", "faculty"}}).status, 200);
    EXPECT_EQ(post("ann", "/accounts/fay/state", {{"state", "active"}}).status, 200);
    ASSERT_TRUE(store_.write([](store::Writing& tx) {
      return tx.query("update accounts set must_change = 0 where id = 'fay'");
    }));
  }
}

}  // namespace
}  // namespace api
}  // namespace tractus
