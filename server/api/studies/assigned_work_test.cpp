/// A trainee's trials at more stations than one, through the routes.
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::kCase;
using testing::PeopleTest;

class AssignedWork : public PeopleTest {
 protected:
  AssignedWork() {
    EXPECT_EQ(post("fay", "/accounts/tom/badge", {{"badge", "4711"}, {"pin", "2468"}}).status, 200);
    const auto made = post("fay", "/assignments",
                           {{"title", "Practice"},
                            {"people", {"tom"}},
                            {"cases", {{{"case", kCase}}}},
                            {"repeats", 2},
                            {"release", "at_once"}});
    EXPECT_EQ(made.status, 201) << text(made);
  }
  http::Response work(const char* token, const std::string& tail, const Json& body) {
    return ask(request("POST", "/api/v1/work/" + tail, station(token), body.dump()));
  }
  std::string ticket(const char* token) {
    return json(work(token, "sign-in", {{"badge", "4711"}, {"pin", "2468"}}))["ticket"];
  }
  std::string next_slot(const char* token, const std::string& ticket) {
    const auto next = work(token, "next", {{"ticket", ticket}});
    EXPECT_EQ(next.status, 200) << text(next);
    return next.status == 200 ? json(next)["trial"]["slot"].get<std::string>() : "";
  }
};

TEST_F(AssignedWork, GoesOnAtAnotherStationOnceTheUnstartedTrialWasGivenBack) {
  const std::string first = ticket("token-1"), slot = next_slot("token-1", first);
  const std::string second = ticket("token-2");
  EXPECT_EQ(work("token-2", "next", {{"ticket", second}}).status, 409) << "the first has it";
  EXPECT_EQ(work("token-2", "sign-out", {{"ticket", second}, {"unstarted", slot}}).status, 204);
  const std::string third = ticket("token-2");
  EXPECT_EQ(work("token-2", "next", {{"ticket", third}}).status, 409) << "not the second's to give";
  EXPECT_EQ(work("token-1", "sign-out", {{"ticket", first}, {"unstarted", slot}}).status, 204);
  EXPECT_EQ(next_slot("token-2", third), slot);
}

TEST_F(AssignedWork, TellsTheStationTheLanguageThatThePersonChose) {
  const auto signed_in = [&] {
    return json(work("token-1", "sign-in", {{"badge", "4711"}, {"pin", "2468"}}));
  };
  EXPECT_FALSE(signed_in().contains("language"));
  EXPECT_EQ(post("tom", "/session/language", {{"language", "de"}}).status, 204);
  EXPECT_EQ(signed_in()["language"], "de");
}

TEST_F(AssignedWork, OfAnotherPersonOrOfNobodyIsNotReleased) {
  const std::string toms = ticket("token-1"), slot = next_slot("token-1", toms);
  ASSERT_EQ(post("flo", "/accounts/tia/badge", {{"badge", "4712"}, {"pin", "1357"}}).status, 200);
  const std::string tias =
      json(work("token-1", "sign-in", {{"badge", "4712"}, {"pin", "1357"}}))["ticket"];
  EXPECT_EQ(work("token-1", "sign-out", {{"ticket", tias}, {"unstarted", slot}}).status, 204);
  EXPECT_EQ(
      work("token-1", "sign-out", {{"ticket", toms}, {"unstarted", std::string(64, '0')}}).status,
      204);
  EXPECT_EQ(work("token-2", "next", {{"ticket", ticket("token-2")}}).status, 409);
}

TEST_F(AssignedWork, WithAnAnnouncedTrialIsNotReleased) {
  const std::string first = ticket("token-1"), slot = next_slot("token-1", first);
  const auto announced = store_.write([&](store::Writing& tx) -> core::Result<void> {
    const std::string id = core::new_id();
    TRY(store::add_upload(
        tx, {id, "s1", kCase, 1, std::string(64, 'a'), store::UploadPhase::receiving}, 1));
    return store::announce_for_slot(tx, id, slot, 1);
  });
  ASSERT_TRUE(announced) << announced.error().what;
  EXPECT_EQ(work("token-1", "sign-out", {{"ticket", first}, {"unstarted", slot}}).status, 204);
  EXPECT_EQ(work("token-2", "next", {{"ticket", ticket("token-2")}}).status, 409);
}

TEST_F(AssignedWork, ATextThatIsNoTicketReleasesNothing) {
  const std::string first = ticket("token-1"), slot = next_slot("token-1", first);
  EXPECT_EQ(work("token-1", "sign-out", {{"ticket", "rubbish"}, {"unstarted", slot}}).status, 403);
  EXPECT_EQ(work("token-1", "sign-out", {{"ticket", first}, {"unstarted", 7}}).status, 400);
  EXPECT_EQ(next_slot("token-1", first), slot) << "still signed in";
}

}  // namespace
}  // namespace api
}  // namespace tractus
