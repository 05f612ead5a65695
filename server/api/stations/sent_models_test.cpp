/// Versions of models on their way to stations, as the researcher and the station see it.
#include "db/store/stations/sent_models.hpp"

#include <gtest/gtest.h>

#include "core/try.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api::testing {
namespace {

class SentModels : public PeopleTest {
 protected:
  SentModels() {
    const auto sha = objects_.put(core::bytes_of("{\"a\":1}"));
    EXPECT_TRUE(sha);
    const auto made = store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(store::add_object(tx, *sha, 7, 0));
      for (const char* id : {"m-one", "m-two"}) {
        store::ModelVersion model;
        model.id = id;
        model.name = id;
        model.rig = "probing";
        model.sha256 = *sha;
        TRY(store::add_model(tx, model));
      }
      return {};
    });
    EXPECT_TRUE(made) << made.error().what;
  }
  http::Response send(const std::string& who, const core::Json& body) {
    return post(who, "/lab/models/m-one/send", body);
  }
  http::Response at_station(const std::string& method, const std::string& tail) {
    return ask(request(method, "/api/v1/station/models" + tail, station("token-1")));
  }
  std::string state_of(const std::string& station_id) {
    const core::Json answer = json(get("rex", "/lab/models/m-one/stations"));
    for (const auto& one : answer["stations"])
      if (one["id"] == station_id) return one["state"].get<std::string>();
    return "no such station";
  }
};

TEST_F(SentModels, ReachTheStationThatTheyWereSentToAndItSaysSo) {
  EXPECT_EQ(state_of("s1"), "not_sent");
  EXPECT_TRUE(json(at_station("GET", ""))["models"].empty());
  ASSERT_EQ(send("rex", {{"stations", {"s1"}}}).status, 200);
  EXPECT_EQ(state_of("s1"), "waiting");
  const core::Json given = json(at_station("GET", ""))["models"];
  ASSERT_EQ(given.size(), 1u);
  EXPECT_EQ(given[0]["name"], "m-one");
  EXPECT_EQ(at_station("GET", "/m-one").status, 200);
  EXPECT_EQ(at_station("POST", "/m-one/there").status, 204);
  EXPECT_EQ(state_of("s1"), "there");
}

TEST_F(SentModels, StayThereWhenTheyAreSentAgain) {
  ASSERT_EQ(send("ted", {{"all", true}}).status, 200);
  ASSERT_EQ(at_station("POST", "/m-one/there").status, 204);
  ASSERT_EQ(send("ann", {{"all", true}}).status, 200);
  EXPECT_EQ(state_of("s1"), "there");
}

TEST_F(SentModels, AreNoLongerThereForAStationOnceRecalled) {
  ASSERT_EQ(send("rex", {{"all", true}}).status, 200);
  ASSERT_EQ(at_station("POST", "/m-one/there").status, 204);
  const auto recall = [&](const std::string& who, const std::string& tail) {
    return ask(request("DELETE", "/api/v1/lab/models/" + tail, as(who))).status;
  };
  EXPECT_EQ(recall("fay", "m-one/stations/s1"), 403);
  EXPECT_EQ(recall("rex", "m-two/stations/s1"), 404);
  EXPECT_EQ(recall("rex", "m-one/stations/s1"), 200);
  EXPECT_EQ(state_of("s1"), "not_sent");
  EXPECT_TRUE(json(at_station("GET", ""))["models"].empty());
  EXPECT_EQ(at_station("GET", "/m-one").status, 404);
  EXPECT_EQ(recall("rex", "m-one/stations/s1"), 404) << "it is recalled already";
}

TEST_F(SentModels, AreNotForAStationThatTheyWereNotSentTo) {
  EXPECT_EQ(at_station("GET", "/m-two").status, 404);
  EXPECT_EQ(at_station("POST", "/m-two/there").status, 404);
}

TEST_F(SentModels, AreRefusedWithoutAStationAndForOneThatThereIsNot) {
  EXPECT_EQ(send("rex", core::Json::object()).status, 400);
  EXPECT_EQ(send("rex", {{"stations", core::Json::array()}}).status, 400);
  EXPECT_EQ(send("rex", {{"stations", {"s1"}}, {"all", true}}).status, 400);
  EXPECT_EQ(send("rex", {{"stations", {"s1", "nowhere"}}}).status, 404);
  EXPECT_EQ(state_of("s1"), "not_sent") << "all of it or nothing";
  EXPECT_EQ(post("rex", "/lab/models/none/send", {{"all", true}}).status, 404);
  EXPECT_EQ(send("fay", {{"all", true}}).status, 403);
}

}  // namespace
}  // namespace api::testing
}  // namespace tractus
