#include "db/store/studies/assignments.hpp"

#include <fmt/format.h>

#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using testing::kCase;
using testing::PeopleTest;

/// fay assigns to her cohort, in which tom learns; he signs in at stations 1 and 2.
class Assignments : public PeopleTest {
 protected:
  Assignments() {
    EXPECT_EQ(post("fay", "/accounts/tom/badge", {{"badge", "4711"}, {"pin", "2468"}}).status, 200);
    const auto added = store_.write([&](store::Writing& tx) {
      return store::add_case(tx, {other_, "L4, lateral breach", "made", 2, 0}, {}, 0);
    });
    EXPECT_TRUE(added);
  }
  core::Json two_cases(core::Json more = core::Json::object()) {
    core::Json out{{"title", "Week 1"},
                   {"cohort", "c-tom"},
                   {"cases", {{{"case", kCase}}, {{"case", other_}}}},
                   {"ordering", "fixed"}};
    out.update(more);
    return out;
  }
  std::string assigned(const core::Json& plan) {
    const auto made = post("fay", "/assignments", plan);
    EXPECT_EQ(made.status, 201) << text(made);
    return json(made).value("id", "");
  }
  http::Response work(const std::string& tail, const core::Json& body,
                      const std::string& token = "token-1") {
    return ask(request("POST", "/api/v1/work/" + tail, station(token), body.dump()));
  }
  std::string ticket(const std::string& token = "token-1") {
    const auto in = work("sign-in", {{"badge", "4711"}, {"pin", "2468"}}, token);
    EXPECT_EQ(in.status, 200) << text(in);
    return json(in).value("ticket", "");
  }
  core::Json next(const std::string& with, const std::string& token = "token-1") {
    const auto given = work("next", {{"ticket", with}}, token);
    EXPECT_EQ(given.status, 200) << text(given);
    return json(given);
  }
  /// The trial of a slot arrives; its id.
  std::string hand_over(const std::string& slot, const store::Tool& tool = {}) {
    const std::string id = core::new_id();
    const auto done =
        store_.write([&](store::Writing& tx) { return furnish_trial(tx, id, slot, tool); });
    EXPECT_TRUE(done) << done.error().what;
    return id;
  }
  const std::string other_ = std::string(64, 'd');
};

TEST_F(Assignments, ATraineeGetsExactlyTheNextCaseUntilNoneIsLeft) {
  assigned(two_cases({{"repeats", 2}}));
  const std::string in = ticket();
  std::vector<std::string> cases;
  for (int left = 4; left > 0; --left) {
    const core::Json first = next(in), again = next(in);
    EXPECT_EQ(first, again) << "asking twice takes nothing twice";
    EXPECT_EQ(first["left"], left);
    EXPECT_EQ(first["trial"]["number"], 5 - left);
    EXPECT_EQ(first["participant"], "P-tom");
    cases.push_back(first["trial"]["case_id"]);
    hand_over(first["trial"]["slot"]);
  }
  EXPECT_EQ(cases, (std::vector<std::string>{kCase, other_, kCase, other_}));
  EXPECT_EQ(next(in)["trial"], nullptr);
  EXPECT_EQ(next(in)["left"], 0);
}

TEST_F(Assignments, AStationReadsTheResultThatTheTraineesOwnPageShows) {
  const std::string id = assigned(two_cases());
  const std::string in = ticket();
  const std::string trial = hand_over(next(in)["trial"]["slot"]);
  const auto result = [&](const std::string& of, const std::string& with) {
    const auto answer = work("result", {{"ticket", with}, {"trial", of}});
    EXPECT_EQ(answer.status, 200) << text(answer);
    return json(answer);
  };
  const core::Json held{{"state", "held"}, {"correct", nullptr}, {"scores", core::Json::array()}};
  const auto assessed = store_.write([&](store::Writing& tx) {
    // force_rate_max is on no trainee's page (no `followed` in its file); operation_time is.
    return store::set_assessment(
        tx, trial, {{"force_rate_max", 9.0, ""}, {"operation_time", 12.5, ""}}, true, "{}");
  });
  ASSERT_TRUE(assessed) << assessed.error().what;
  EXPECT_EQ(result(trial, in), held) << "nobody has released it";
  EXPECT_EQ(post("fay", "/assignments/" + id + "/release", {{"release", "released"}}).status, 200);
  const core::Json shown = result(trial, in);
  EXPECT_EQ(shown["state"], "assessed");
  EXPECT_EQ(shown["correct"], true);
  ASSERT_EQ(shown["scores"].size(), 1u) << shown;
  EXPECT_EQ(
      shown["scores"][0],
      (core::Json{
          {"label", "Operation time"}, {"unit", "s"}, {"shown_as", "number"}, {"value", 12.5}}));
  EXPECT_EQ(result(trial_of("tia"), in), held) << "another's trial";
  EXPECT_EQ(result(std::string(32, '0'), in), held) << "no trial looks the same";
  EXPECT_EQ(work("result", {{"ticket", "guessed"}, {"trial", trial}}).status, 403);
}

TEST_F(Assignments, NothingThatAStationOrATraineeIsToldNamesTheCase) {
  const std::string id = assigned(two_cases());
  const std::string told = next(ticket()).dump() + text(get("tom", "/assignments")) +
                           text(get("tom", "/assignments/" + id));
  for (const char* secret : {"lateral", "L4", "L3", "ordering", "seed"})
    EXPECT_EQ(told.find(secret), std::string::npos) << secret << " in " << told;
  EXPECT_NE(told.find("Trial 1"), std::string::npos);
}

TEST_F(Assignments, BlindNamesAreThoseThatWereGiven) {
  assigned(two_cases({{"cases", {{{"case", other_}, {"name", "Case A"}}}}}));
  EXPECT_EQ(next(ticket())["trial"]["name"], "Case A");
}

TEST_F(Assignments, AScenarioIsSealedForTheStation) {
  assigned({{"title", "Rig"},
            {"people", {"tom"}},
            {"cases", {{{"scenario", {{"tuned", "lateral_breach"}}}}}}});
  const core::Json trial = next(ticket())["trial"];
  EXPECT_EQ(trial["rig"], "probing");
  EXPECT_EQ(trial["case_id"], "");
  EXPECT_FALSE(trial["sealed"].get<std::string>().empty());
  EXPECT_EQ(trial.dump().find("lateral"), std::string::npos);
}

TEST_F(Assignments, WholeBoneIsToBeDrilledAndThenItsChannelFelt) {
  const std::string whole(64, 'e');
  ASSERT_TRUE(store_.write([&](store::Writing& tx) {
    return store::add_case(
        tx, {whole, "L5, whole", "made", 3, 0, trial::Rig::palpation, false, true}, {}, 0);
  }));
  const std::string id = assigned(two_cases({{"cases", {{{"case", whole}}, {{"case", kCase}}}}}));
  const std::string in = ticket();
  const core::Json first = next(in)["trial"];
  EXPECT_EQ(first["tool"], "burr");
  EXPECT_FALSE(first.contains("drilled"));
  EXPECT_EQ(json(get("tom", "/assignments/" + id))["to_drill"], 1);

  const std::string drilling = hand_over(first["slot"], {.burr = true});
  const core::Json then = next(in);
  EXPECT_EQ(then["trial"]["slot"], first["slot"]);
  EXPECT_EQ(then["trial"]["drilled"], drilling);
  EXPECT_FALSE(then["trial"].contains("tool"));
  EXPECT_EQ(then["trial"]["number"], 1);
  EXPECT_EQ(then["left"], 2);
  EXPECT_EQ(json(get("fay", "/assignments/" + id))["done"], 0);

  hand_over(first["slot"], {.burr = false, .drilled = drilling});
  const core::Json seen = json(get("fay", "/assignments/" + id));
  EXPECT_EQ(seen["done"], 1);
  EXPECT_EQ(seen["planned"], 2);
  EXPECT_EQ(seen["to_drill"], 1);
  ASSERT_EQ(seen["trials"].size(), 2u);
  EXPECT_NE(seen["trials"][0]["tool"], seen["trials"][1]["tool"]);
  const core::Json ordinary = next(in)["trial"];
  EXPECT_EQ(ordinary["case_id"], kCase);
  EXPECT_FALSE(ordinary.contains("tool") || ordinary.contains("drilled"))
      << "stations that know no drilling read it as ever";
}

TEST_F(Assignments, TheEarliestDueComesFirst) {
  assigned(two_cases({{"title", "no date"}}));
  assigned(two_cases({{"title", "later"}, {"due_utc_us", now_ + 2'000}}));
  assigned(two_cases({{"title", "soon"}, {"due_utc_us", now_ + 1'000}}));
  const core::Json given = next(ticket());
  EXPECT_EQ(given["trial"]["assignment"], "soon");
  EXPECT_EQ(given["left"], 6);
}

TEST_F(Assignments, RefusesADueTimeInThePast) {
  const auto made =
      post("fay", "/assignments", two_cases({{"title", "x"}, {"due_utc_us", now_ - 1}}));
  EXPECT_EQ(made.status, 400);
  EXPECT_NE(text(made).find("in the past"), std::string::npos) << text(made);
  const std::string id = assigned(two_cases({{"title", "x"}}));
  const std::string due = "/assignments/" + id + "/due";
  EXPECT_EQ(post("fay", due, {{"due_utc_us", now_ - 1}}).status, 400);
  EXPECT_EQ(post("fay", due, {{"due_utc_us", now_ + 1}}).status, 200);
}

TEST_F(Assignments, ReleasesManyAtOnceOrNone) {
  const std::string one = assigned(two_cases({{"title", "1"}})),
                    two = assigned(two_cases({{"title", "2"}}));
  const auto states = [&] {
    return json(get("fay", "/assignments/" + one))["release"].get<std::string>() + " " +
           json(get("fay", "/assignments/" + two))["release"].get<std::string>();
  };
  const auto release = [&](const core::Json& ids) {
    return post("fay", "/assignment-releases", {{"assignments", ids}, {"release", "released"}})
        .status;
  };
  EXPECT_EQ(release({one, "a-tia"}), 404);
  EXPECT_EQ(states(), "held held");
  EXPECT_EQ(release({one, two}), 200);
  EXPECT_EQ(states(), "released released");
  EXPECT_EQ(release(core::Json::array()), 400);
}

TEST_F(Assignments, TheSameSeedGivesTheSameOrders) {
  const auto order = [&](std::int64_t seed) {
    const std::string id = assigned(two_cases({{"title", "x"},
                                               {"ordering", "random"},
                                               {"repeats", 8},
                                               {"seed", seed},
                                               {"due_utc_us", now_ + 1000 + seed}}));
    const auto all = store_.read([&](store::Reading& tx) {
      return tx.query("select case_id from study_slots where study_id = ? order by position", {id});
    });
    std::string out;
    for (const auto& row : *all) out += row.text(0).front();
    return out;
  };
  const std::string first = order(7);
  EXPECT_EQ(first.size(), 16u);
  EXPECT_EQ(std::ranges::count(first, 'd'), 8);
  EXPECT_EQ(order(7), first);
  EXPECT_NE(order(8), first);
}

TEST_F(Assignments, FiveWrongPinsSlowTheBadgeDownUntilItHasANewPin) {
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(work("sign-in", {{"badge", "4711"}, {"pin", "0000"}}).status, 401);
  EXPECT_EQ(work("sign-in", {{"badge", "4711"}, {"pin", "2468"}}).status, 429);
  EXPECT_EQ(post("fay", "/accounts/tom/badge", {{"badge", "4711"}, {"pin", "1357"}}).status, 200);
  EXPECT_EQ(work("sign-in", {{"badge", "4711"}, {"pin", "1357"}}).status, 200) << "a new PIN opens";
  EXPECT_EQ(work("sign-in", {{"badge", "9999"}, {"pin", "2468"}}).status, 401);
}

TEST_F(Assignments, ATicketEndsWhenTheBadgeOrThePinIsTakenAwayOrChanged) {
  assigned(two_cases());
  for (const core::Json& badge :
       {core::Json{{"badge", "4711"}, {"pin", "1357"}},
        core::Json{{"badge", "4712"}, {"pin", "2468"}}, core::Json::object()}) {
    EXPECT_EQ(post("fay", "/accounts/tom/badge", {{"badge", "4711"}, {"pin", "2468"}}).status, 200);
    const std::string in = ticket("token-1");
    EXPECT_EQ(work("next", {{"ticket", in}}).status, 200);
    EXPECT_EQ(post("fay", "/accounts/tom/badge", badge).status, 200);
    EXPECT_EQ(work("next", {{"ticket", in}}).status, 403) << badge;
  }
}

TEST_F(Assignments, ATicketIsOfOneStationAndNoCookie) {
  assigned(two_cases());
  const std::string in = ticket("token-1");
  EXPECT_EQ(work("next", {{"ticket", in}}, "token-2").status, 403);
  EXPECT_EQ(
      ask(request("GET", "/api/v1/trials", {{"cookie", std::string(kSessionCookie) + "=" + in}}))
          .status,
      401);
  EXPECT_EQ(work("sign-out", {{"ticket", in}}).status, 204);
  EXPECT_EQ(work("next", {{"ticket", in}}).status, 403);
}

TEST_F(Assignments, WhatOneStationHoldsAnotherDoesNotGetUntilItIsFreed) {
  const std::string id = assigned(two_cases());
  const std::string slot = next(ticket("token-1"))["trial"]["slot"];
  const std::string at_two = ticket("token-2");
  EXPECT_EQ(work("next", {{"ticket", at_two}}, "token-2").status, 409);
  EXPECT_EQ(post("fay", "/assignments/" + id + "/people/tom/free").status, 200);
  EXPECT_EQ(next(at_two, "token-2")["trial"]["slot"], slot);
}

TEST_F(Assignments, ResultsAreSeenWhenTheyAreReleased) {
  const std::string id = assigned(two_cases());
  hand_over(next(ticket())["trial"]["slot"]);
  const auto seen = [&] { return json(get("tom", "/trials"))["trials"].size(); };
  EXPECT_EQ(seen(), 1u) << "the one of before";
  EXPECT_EQ(post("fay", "/assignments/" + id + "/release", {{"release", "released"}}).status, 200);
  EXPECT_EQ(seen(), 2u);
  EXPECT_EQ(post("fay", "/assignments/" + id + "/release", {{"release", "held"}}).status, 200);
  EXPECT_EQ(seen(), 1u);
}

TEST_F(Assignments, ATrialThatDoesNotCountIsRepeated) {
  const std::string id = assigned(two_cases({{"on_invalid", "at_once"}}));
  const std::string in = ticket();
  hand_over(next(in)["trial"]["slot"]);
  const std::string trial = json(get("fay", "/assignments/" + id))["trials"][0]["trial_id"];
  EXPECT_EQ(
      post("fay", "/assignments/" + id + "/trials/" + trial + "/invalid", {{"reason", " "}}).status,
      400);
  EXPECT_EQ(post("fay", "/assignments/" + id + "/trials/" + trial + "/invalid",
                 {{"reason", "phone rang"}})
                .status,
            200);
  EXPECT_EQ(next(in)["trial"]["case_id"], kCase);
  EXPECT_EQ(next(in)["left"], 2);
}

TEST_F(Assignments, WhoJoinsTheCohortLaterGetsThemToo) {
  const std::string id = assigned(two_cases());
  EXPECT_EQ(post("dora", "/cohorts/c-tom/people", {{"name", "tia"}}).status, 200);
  EXPECT_EQ(json(get("fay", "/assignments/" + id))["trainees"].size(), 2u);
}

TEST_F(Assignments, FacultyAssignsToItsOwnPeopleAlone) {
  EXPECT_EQ(post("fay", "/assignments", two_cases({{"cohort", "c-tia"}})).status, 404);
  EXPECT_EQ(post("fay", "/assignments",
                 {{"title", "x"}, {"people", {"tia"}}, {"cases", {{{"case", kCase}}}}})
                .status,
            404);
  EXPECT_EQ(post("ann", "/assignments", two_cases({{"cohort", "c-tia"}})).status, 201);
}

/// Refused in time, before the trainee has done anything that could be lost.
TEST_F(Assignments, AFullDiskGivesNoNewTrialAndTakesWhatIsOnItsWay) {
  assigned(two_cases());
  const std::string in = ticket();
  std::uint64_t free_bytes = 10ull << 30;
  backend_.free_bytes = [&] { return free_bytes; };
  EXPECT_EQ(ask(request("GET", "/api/v1/health")).status, 200);
  const std::string bytes = "one piece of a trial", trial(32, 'b');
  const auto headers = station("token-1");
  const auto announced = ask(request(
      "PUT", "/api/v1/uploads/" + trial, headers,
      core::Json{{"case_id", kCase}, {"size_bytes", bytes.size()}, {"sha256", std::string(64, 'e')}}
          .dump()));
  ASSERT_EQ(announced.status, 200) << text(announced);
  free_bytes = 100u << 20;
  EXPECT_EQ(work("next", {{"ticket", in}}).status, 503);
  EXPECT_EQ(ask(request("GET", "/api/v1/health")).status, 503);
  auto piece = headers;
  piece["x-crc32c"] = fmt::format("{:08x}", core::crc32c(core::bytes_of(bytes)));
  const auto taken =
      ask(request("PATCH", "/api/v1/uploads/" + trial + "?offset_bytes=0", piece, bytes));
  EXPECT_EQ(taken.status, 200) << text(taken);
}

TEST_F(Assignments, AreNotAmongTheStudies) {
  assigned(two_cases());
  EXPECT_EQ(json(get("rex", "/studies"))["studies"].size(), 0u);
}

TEST_F(Assignments, RubbishIsRefusedByField) {
  for (const core::Json& bad :
       {two_cases({{"ordering", "backwards"}}), two_cases({{"repeats", 0}}),
        two_cases({{"release", "never"}}), two_cases({{"cases", core::Json::array()}}),
        two_cases({{"cases", {{{"case", kCase}}, {{"case", kCase}}}}}),
        two_cases({{"cases", {{{"name", "x"}}}}}), two_cases({{"people", "tom"}}),
        two_cases({{"extra", 1}}), core::Json{{"title", "x"}}})
    EXPECT_EQ(post("fay", "/assignments", bad).status, 400) << bad;
  EXPECT_EQ(post("fay", "/assignments", two_cases({{"cases", {{{"case", "none"}}}}})).status, 404);
  EXPECT_EQ(post("ann", "/assignments", two_cases({{"protocol", "x"}})).status, 400)
      << "cases and a protocol";
}

}  // namespace
}  // namespace api
}  // namespace tractus
