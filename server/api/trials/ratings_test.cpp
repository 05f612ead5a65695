/// Ratings by people: who rates whose trial, who sees a rating and when, and how far raters agree.
#include "db/store/trials/ratings.hpp"

#include "server/api/people/people_test_support.hpp"
#include "server/jobs/publish.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::PeopleTest;

/// fay and flo both teach tom; flo alone teaches tia.
class RatingsByPeople : public PeopleTest {
 protected:
  RatingsByPeople() {
    world::make_case(folder_.path() / "case");
    const auto made = jobs::publish_bundle(store_, objects_, folder_.path() / "case");
    EXPECT_TRUE(made);
    const std::string header = world::header_of(trial_of("tom"), *made).to_json().dump();
    EXPECT_TRUE(store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(
          tx.query("update trials set operator_name = 'Tom Tell', case_id = ?, header = ? where id "
                   "= ?",
                   {*made, header, trial_of("tom")}));
      return store::put_into_cohort(tx, "c-tom", "flo", store::CohortPart::faculty, 0);
    }));
    EXPECT_EQ(post("dora", "/rubrics", {{"id", "osats"}, {"rubric", rubric()}}).status, 201);
  }
  static Json rubric() {
    const auto item = [](const char* label) {
      return Json{{"label", label}, {"low_text", "poor"}, {"high_text", "excellent"}};
    };
    return {{"format", "tractus-rubric/1"},
            {"title", "Global rating"},
            {"items", {item("Respect for tissue"), item("Time and motion")}}};
  }
  static std::string of(const std::string& trainee, const char* tail = "/ratings") {
    return "/trials/" + trial_of(trainee) + tail;
  }
  void ask_for(const Json& more = Json::object()) {
    Json body{{"rubric", "osats"}};
    body.update(more);
    const auto asked = post("fay", of("tom", "/rating-requests"), body);
    EXPECT_EQ(asked.status, 201) << text(asked);
  }
  http::Response rate(const char* who, std::vector<int> scores, const std::string& reason = "") {
    Json body{{"rubric", "osats"}, {"scores", std::move(scores)}};
    if (!reason.empty()) body["reason"] = reason;
    return post(who, of("tom"), body);
  }
  Json request_seen_by(const char* who) {
    const Json all = json(get(who, of("tom")))["requests"];
    return all.empty() ? Json() : all[0];
  }
  std::string operator_seen_by(const char* who) {
    return json(get(who, "/trials/" + trial_of("tom")))["operator_name"];
  }
};

TEST_F(RatingsByPeople, OfOthersAreSeenOnceAllHaveRated) {
  ask_for();
  ASSERT_EQ(rate("fay", {4, 5}).status, 201);
  EXPECT_EQ(request_seen_by("fay")["ratings"].size(), 1u) << "the own one";
  for (const char* other : {"flo", "dora", "ann"}) {
    const Json seen = request_seen_by(other);
    EXPECT_EQ(seen["ratings"].size(), 0u) << other;
    EXPECT_EQ(seen["submitted"], 1) << other;
    EXPECT_EQ(seen["may_rate"], true) << other;
  }
  EXPECT_EQ(json(rate("flo", {2, 3}))["requests"][0]["ratings"].size(), 2u);
  const Json seen = request_seen_by("fay");
  EXPECT_EQ(seen["complete"], true);
  ASSERT_EQ(seen["ratings"].size(), 2u);
  EXPECT_EQ(seen["ratings"][1]["rater"], "flo");
  EXPECT_EQ(seen["ratings"][1]["total"], 5);
  EXPECT_EQ(seen["ratings"][1]["own"], false);
  EXPECT_EQ(rate("dora", {1, 1}).status, 409) << "it has its two";
  EXPECT_EQ(request_seen_by("dora")["may_rate"], false);
}

TEST_F(RatingsByPeople, AreNotChangedButSupersededWithAReason) {
  ask_for();
  ASSERT_EQ(rate("fay", {4, 5}).status, 201);
  EXPECT_EQ(rate("fay", {4, 4}).status, 409);
  ASSERT_EQ(rate("fay", {4, 4}, "wrong line").status, 201);
  ASSERT_EQ(rate("flo", {2, 3}).status, 201);
  ASSERT_EQ(rate("fay", {2, 3}, "talked it over").status, 201);
  const Json all = request_seen_by("flo")["ratings"];
  ASSERT_EQ(all.size(), 4u) << all;
  EXPECT_EQ(all[0]["scores"], (Json{4, 5}));
  EXPECT_EQ(all[0]["reason"], "");
  EXPECT_EQ(all[0]["holds"], false);
  EXPECT_EQ(all[1]["reason"], "wrong line");
  EXPECT_EQ(all[1]["independent"], true);
  EXPECT_EQ(all[2]["holds"], true);
  EXPECT_EQ(all[2]["independent"], false) << "flo's was seen by then";
}

TEST_F(RatingsByPeople, OfABlindTrialHideTheNameUntilAllHaveRated) {
  ask_for({{"blind", true}});
  for (const char* who : {"fay", "flo", "dora", "ann"}) {
    EXPECT_EQ(operator_seen_by(who), "") << who;
    EXPECT_EQ(json(get(who, "/trials/" + trial_of("tom")))["person"], "") << who;
    EXPECT_EQ(json(get(who, "/trials?search=tell"))["trials"].size(), 0u) << who;
    EXPECT_EQ(json(get(who, "/trials?search=tom"))["trials"].size(), 0u) << who;
    const Json listed = json(get(who, "/trials?sort=person"));
    EXPECT_EQ(listed.dump().find("Tell"), std::string::npos) << who << listed;
  }
  const auto in_table = [&] { return json(get("fay", "/assignments/a-tom"))["trials"].size(); };
  EXPECT_EQ(in_table(), 0u) << "the assignment's table names the person of each trial";
  EXPECT_EQ(operator_seen_by("tom"), "Tom Tell") << "tom knows";
  ASSERT_EQ(rate("fay", {4, 5}).status, 201);
  EXPECT_EQ(operator_seen_by("fay"), "");
  ASSERT_EQ(rate("flo", {4, 5}).status, 201);
  EXPECT_EQ(operator_seen_by("fay"), "Tom Tell");
  EXPECT_EQ(json(get("fay", "/trials?search=tell"))["trials"].size(), 1u);
  EXPECT_EQ(in_table(), 1u);
}

TEST_F(RatingsByPeople, OfABlindTrialLeaveNoWayFromTheNameToTheTrial) {
  ASSERT_TRUE(store_.write([](store::Writing& tx) -> core::Result<void> {
    TRY(tx.query("update trials set state = 'assessed', correct = 1 where id = ?",
                 {trial_of("tom")}));
    TRY(
        tx.query("update trials set case_id = (select case_id from trials where id = ?) where id = "
                 "?",
                 {trial_of("tom"), trial_of("tia")}));
    return {};
  }));
  ASSERT_EQ(post("fay", of("tom", "/reference"), {{"reference", true}}).status, 200);
  const auto attempt = [&](const char* who) {
    return json(get(who, "/cohort/trainees/tom"))["attempts"].at(0);
  };
  const auto place = [&](const char* who) {
    return json(get(who, "/trials/" + trial_of("tom")))["study"];
  };
  const auto example = [&] {
    return json(get("flo", of("tia", "/references")))["trials"].at(0)["operator"];
  };
  ask_for({{"blind", true}});
  for (const char* who : {"fay", "flo", "dora", "ann"}) {
    EXPECT_EQ(attempt(who)["trial"], Json()) << who;
    EXPECT_EQ(attempt(who)["started_utc_us"], Json()) << who;
    EXPECT_EQ(attempt(who)["correct"], true) << who << ": the curve stays";
    EXPECT_EQ(place(who), Json()) << who << ": the assignment's page lists its people";
  }
  EXPECT_EQ(example(), "");
  EXPECT_EQ(attempt("tom")["trial"], trial_of("tom"));
  EXPECT_EQ(place("tom")["id"], "a-tom");
  ASSERT_EQ(rate("fay", {4, 5}).status, 201);
  ASSERT_EQ(rate("flo", {4, 5}).status, 201);
  EXPECT_EQ(attempt("fay")["trial"], trial_of("tom"));
  EXPECT_EQ(place("fay")["participant"], "P-tom");
  EXPECT_EQ(example(), "Tom Tell");
}

TEST_F(RatingsByPeople, AreSeenByTheTraineeOnceReleasedAndComplete) {
  ask_for();
  rate("fay", {4, 5});
  EXPECT_EQ(request_seen_by("tom"), Json()) << "not complete";
  rate("flo", {3, 3});
  rate("flo", {3, 4}, "a slip");
  const Json seen = request_seen_by("tom");
  ASSERT_EQ(seen["ratings"].size(), 2u) << "those that hold: " << seen;
  EXPECT_EQ(seen["ratings"][1]["total"], 7);
  EXPECT_EQ(seen["may_rate"], false);
  ASSERT_TRUE(store_.write([](store::Writing& tx) {
    return tx.query("update assignments set release = 'held' where study_id = 'a-tom'");
  }));
  EXPECT_EQ(get("tom", of("tom")).status, 404);
}

TEST_F(RatingsByPeople, AreOfThoseWhoTeachTheTrainee) {
  EXPECT_EQ(post("fay", of("tia", "/rating-requests"), {{"rubric", "osats"}}).status, 404);
  ASSERT_EQ(post("flo", of("tia", "/rating-requests"), {{"rubric", "osats"}}).status, 201);
  EXPECT_EQ(get("fay", of("tia")).status, 404);
  EXPECT_EQ(post("fay", of("tia"), {{"rubric", "osats"}, {"scores", {1, 1}}}).status, 404);
  EXPECT_EQ(post("tia", of("tia"), {{"rubric", "osats"}, {"scores", {5, 5}}}).status, 403);
  EXPECT_EQ(get("tom", of("tia")).status, 404);
  EXPECT_EQ(get("rex", of("tia")).status, 403);
  EXPECT_EQ(json(get("fay", "/ratings"))["requests"].size(), 0u);
  EXPECT_EQ(json(get("flo", "/ratings"))["requests"].size(), 1u);
  EXPECT_EQ(json(get("dora", "/ratings"))["requests"][0]["own"], false);
}

TEST_F(RatingsByPeople, TakeScoresOnTheScale) {
  ask_for();
  EXPECT_EQ(rate("fay", {4}).status, 400);
  EXPECT_EQ(rate("fay", {0, 5}).status, 400);
  EXPECT_EQ(rate("fay", {4, 6}).status, 400);
  EXPECT_EQ(post("fay", of("tom"), {{"rubric", "osats"}, {"scores", {4.5, 1.0}}}).status, 400);
  EXPECT_EQ(post("fay", of("tom"), {{"rubric", "none"}, {"scores", {4, 4}}}).status, 404);
  EXPECT_EQ(post("fay", of("tom", "/rating-requests"), {{"rubric", "none"}}).status, 404);
  EXPECT_EQ(post("fay", of("tom", "/rating-requests"), {{"rubric", "osats"}}).status, 409);
  EXPECT_EQ(request_seen_by("fay")["submitted"], 0);
}

TEST_F(RatingsByPeople, ARequestIsWithdrawnWhileNobodyHasRated) {
  const auto withdraw = [&] {
    return ask(request("DELETE", "/api/v1" + of("tom", "/rating-requests/osats"), as("fay")))
        .status;
  };
  ask_for();
  EXPECT_EQ(withdraw(), 200);
  EXPECT_EQ(withdraw(), 404);
  ask_for();
  rate("flo", {3, 3});
  EXPECT_EQ(withdraw(), 409);
}

TEST_F(RatingsByPeople, ARubricHasVersionsAndARequestKeepsItsOwn) {
  ask_for();
  Json changed = rubric();
  changed["items"].push_back(
      {{"label", "Flow"}, {"low_text", "often stops"}, {"high_text", "moves on"}});
  const Json body{{"id", "osats"}, {"rubric", changed}, {"reason", "flow was missing"}};
  EXPECT_EQ(post("fay", "/rubrics", body).status, 403);
  const Json list = json(post("dora", "/rubrics", body))["rubrics"];
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[1]["version"], 2);
  EXPECT_EQ(list[1]["items"].size(), 3u);
  EXPECT_EQ(list[0]["items"].size(), 2u);
  EXPECT_EQ(request_seen_by("fay")["rubric"]["version"], 1);
  EXPECT_EQ(rate("fay", {3, 3}).status, 201);
  EXPECT_EQ(post("dora", "/rubrics", {{"id", "Osats!"}, {"rubric", rubric()}}).status, 400);
}

TEST_F(RatingsByPeople, ACompleteOneIsAScoreOfItsTrial) {
  const auto scores = [&] {
    const auto all = store_.read([](store::Reading& tx) { return store::rating_scores(tx); });
    const auto found = all.value().find(trial_of("tom"));
    return found == all.value().end() ? std::map<std::string, double>() : found->second;
  };
  ask_for();
  rate("fay", {4, 5});
  EXPECT_TRUE(scores().empty());
  rate("flo", {2, 3});
  EXPECT_EQ(scores().at("rating.osats_v1"), 7.0) << "the mean of 9 and 5";
}

/// Four trials of tom's, rated by fay and flo.
TEST_F(RatingsByPeople, AgreementIsOfTrialsThatTheCallerMaySee) {
  const std::vector<std::array<std::vector<int>, 2>> given{
      {{{5, 5}, {5, 4}}}, {{{4, 4}, {4, 5}}}, {{{2, 3}, {2, 2}}}, {{{3, 4}, {1, 4}}}};
  ASSERT_TRUE(store_.write([&](store::Writing& tx) -> core::Result<void> {
    const auto id = TRY(store::find_assignment(tx, "a-tom"));
    for (std::size_t i = 0; i < given.size(); ++i) {
      const auto slots = TRY(store::study_slots(tx, id));
      const std::string trial = core::sha256(core::bytes_of("t" + std::to_string(i))).substr(0, 32);
      TRY(furnish_trial(tx, trial, slots.front().id));
      TRY(store::add_rating_request(
          tx, {.trial_id = trial, .rubric_id = "osats", .version = 1, .made_by = "fay"}));
      for (std::size_t r = 0; r < 2; ++r)
        TRY(store::add_rating(tx, {.trial_id = trial,
                                   .rubric_id = "osats",
                                   .rater_id = r == 0 ? "fay" : "flo",
                                   .scores = given[i][r]}));
    }
    return {};
  }));
  const std::string path = "/ratings/agreement?rubric=osats&version=1";
  const Json groups = json(get("fay", path))["groups"];
  ASSERT_EQ(groups.size(), 1u) << text(get("fay", path));
  EXPECT_EQ(groups[0]["raters"], (Json{"fay", "flo"}));
  EXPECT_EQ(groups[0]["trials"], 4);
  EXPECT_EQ(groups[0]["items"][1]["label"], "Time and motion");
  EXPECT_TRUE(groups[0]["total"]["single"].is_number());
  EXPECT_EQ(groups[0]["total"]["kappa"], nullptr);
  EXPECT_TRUE(groups[0]["items"][0]["kappa"].is_number());
  // Sums: fay 10, 8, 5, 7; flo 9, 9, 4, 5. Differences 1, −1, 1, 2.
  EXPECT_NEAR(groups[0]["differences"]["mean"].get<double>(), 0.75, 1e-12);
  EXPECT_EQ(json(get("dora", path))["groups"].size(), 1u);
  ASSERT_TRUE(
      store_.write([](store::Writing& tx) { return store::take_from_cohort(tx, "c-tom", "flo"); }));
  EXPECT_EQ(json(get("flo", path))["groups"].size(), 0u) << "flo teaches tom no more";
  EXPECT_EQ(get("fay", "/ratings/agreement?rubric=none&version=1").status, 404);
  EXPECT_EQ(get("rex", path).status, 403);
}

}  // namespace
}  // namespace api
}  // namespace tractus
