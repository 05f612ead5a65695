/// What passing is and who has passed, through the routes.
#include "db/store/studies/criteria.hpp"

#include <algorithm>

#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::kCase;
using testing::PeopleTest;

Json recognition(double share) {
  return {{"format", "tractus-criteria/1"},
          {"requirements", {{{"kind", "recognition"}, {"share", share}}}}};
}

class CriteriaRoutes : public PeopleTest {
 protected:
  CriteriaRoutes() {
    EXPECT_EQ(post("fay", "/accounts/tom/badge", {{"badge", "4711"}, {"pin", "2468"}}).status, 200);
    const auto set = store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(store::add_case(tx, {other_, "L4, lateral breach", "made", 2, 0}, {}, 0));
      for (const char* who : {"tom", "tia"}) TRY(assess(tx, trial_of(who), true, 40.0));
      return {};
    });
    EXPECT_TRUE(set) << set.error().what;
  }
  static core::Result<void> assess(store::Writing& tx, const std::string& trial, bool right,
                                   double time_s) {
    return store::set_assessment(tx, trial, {{"operation_time", time_s, ""}}, right, "{}");
  }
  Json read(const char* who, const std::string& path, int status = 200) {
    const auto answer = get(who, path);
    EXPECT_EQ(answer.status, status) << path << text(answer);
    return json(answer);
  }
  Json state(const char* who, const Json& body, int status = 200) {
    const auto answer = post(who, "/criteria", body);
    EXPECT_EQ(answer.status, status) << text(answer);
    return json(answer);
  }
  /// A station takes tom's next trial and brings it back; "" if there is none.
  std::string does_next(bool right) {
    const auto in = ask(request("POST", "/api/v1/work/sign-in", with_json(),
                                Json{{"badge", "4711"}, {"pin", "2468"}}.dump()));
    const auto next = ask(request("POST", "/api/v1/work/next", with_json(),
                                  Json{{"ticket", json(in)["ticket"]}}.dump()));
    EXPECT_EQ(next.status, 200) << text(next);
    if (!json(next).contains("trial") || json(next)["trial"].is_null()) return "";
    const Json trial = json(next)["trial"];
    const std::string id = core::new_id();
    const auto brought = store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(furnish_trial(tx, id, trial["slot"].get<std::string>()));
      return assess(tx, id, right, 30.0);
    });
    EXPECT_TRUE(brought) << brought.error().what;
    return trial["assignment"].get<std::string>();
  }
  static std::map<std::string, std::string> with_json() {
    auto out = station("token-1");
    out["content-type"] = "application/json";
    return out;
  }
  /// Two steps of one case each, the second after the first; a low end of 0.2 is one right answer.
  Json two_steps() {
    const auto step = [&](const char* id, const std::string& of_case, const Json& after) {
      return Json{{"id", id},
                  {"name", std::string("Step ") + id},
                  {"cases", {{{"case", of_case}}}},
                  {"repeats", 2},
                  {"after", after},
                  {"criteria", recognition(0.2)}};
    };
    return {{"title", "Year 1"},
            {"steps", {step("a", kCase, Json::array()), step("b", other_, {"a"})}}};
  }
  Json given(const char* release = "released") {
    const auto made = post("dora", "/curricula", two_steps());
    EXPECT_EQ(made.status, 201) << text(made);
    const std::string id = json(made)["curricula"][0]["id"];
    const auto answer =
        post("fay", "/curricula/" + id + "/cohorts", {{"cohort", "c-tom"}, {"release", release}});
    EXPECT_EQ(answer.status, 201) << text(answer);
    return json(answer)["people"];
  }
  const std::string other_ = std::string(64, 'd');
};

TEST_F(CriteriaRoutes, AreStatedInVersionsThatStay) {
  EXPECT_EQ(read("fay", "/criteria")["criteria"].size(), 0u);
  EXPECT_EQ(read("fay", "/criteria")["usual"][0]["adequate"], 0.10);
  state("fay", {{"assignment", "a-tom"}, {"criteria", recognition(0.5)}});
  const Json list = state(
      "fay", {{"assignment", "a-tom"}, {"criteria", recognition(0.6)}, {"reason", "stricter"}});
  ASSERT_EQ(list["criteria"].size(), 1u);
  EXPECT_EQ(list["criteria"][0]["kind"], "assignment");
  ASSERT_EQ(list["criteria"][0]["versions"].size(), 2u);
  EXPECT_EQ(list["criteria"][0]["versions"][0]["requirements"][0]["share"], 0.5);
  EXPECT_EQ(list["criteria"][0]["versions"][1]["reason"], "stricter");
  EXPECT_EQ(list["criteria"][0]["versions"][1]["made_by"], "fay");
}

TEST_F(CriteriaRoutes, WhoBeganWithAVersionIsJudgedByIt) {
  // tom's trial started at 10 µs; what is stated now comes after it, and nothing was before.
  state("fay", {{"assignment", "a-tom"}, {"criteria", recognition(0.2)}});
  now_ += 1000;
  state("fay", {{"assignment", "a-tom"}, {"criteria", recognition(0.9)}});
  const Json tom = read("fay", "/assignments/a-tom/passing")["people"][0];
  EXPECT_EQ(tom["name"], "tom");
  EXPECT_EQ(tom["version"], 1);
  EXPECT_EQ(tom["passed"], true);
  // 1 of 1 right: 1 / (1 + 1.96²) = 0.2065 (Wilson 1927).
  EXPECT_EQ(tom["requirements"][0]["found"], "1 of 1 right, low end 20.7 %");
  read("flo", "/assignments/a-tom/passing", 404);
}

TEST_F(CriteriaRoutes, OfACaseTellEachTeacherOfTheirOwn) {
  state("fay", {{"case", kCase}, {"criteria", recognition(0.2)}});
  const std::string path = "/cases/" + kCase + "/passing";
  EXPECT_EQ(read("dora", path)["people"].size(), 2u);
  ASSERT_EQ(read("fay", path)["people"].size(), 1u);
  EXPECT_EQ(read("fay", path)["people"][0]["name"], "tom");
}

TEST_F(CriteriaRoutes, OfTheProgrammeDecideTheTraineesPage) {
  EXPECT_EQ(read("dora", "/cohort/trainees")["rule"]["adequate"], 0.10);
  state("fay", {{"criteria", recognition(0.2)}}, 403);
  state("dora", {{"criteria",
                  {{"format", "tractus-criteria/1"},
                   {"requirements",
                    {{{"kind", "lc_cusum"}, {"adequate", 0.05}, {"inadequate", 0.30}},
                     {{"kind", "recognition"}, {"share", 0.2}}}}}}});
  const Json list = read("dora", "/cohort/trainees");
  EXPECT_EQ(list["rule"]["adequate"], 0.05);
  EXPECT_EQ(list["rule"]["version"], 1);
  EXPECT_EQ(list["rule"]["requirements"].size(), 2u);
  EXPECT_EQ(list["trainees"][0]["certified"], false) << "one of the two is not met";
}

TEST_F(CriteriaRoutes, RefuseWhatIsNone) {
  state("fay", {{"criteria", {{"format", "tractus-criteria/1"}}}, {"case", kCase}}, 400);
  state("fay", {{"criteria", recognition(0.2)}, {"case", std::string(64, 'e')}}, 404);
  state("fay", {{"criteria", recognition(0.2)}, {"case", kCase}, {"assignment", "a-tom"}}, 400);
  state("fay", {{"criteria", recognition(0.2)}, {"assignment", "a-tia"}}, 404);
  state("fay", {{"case", kCase}}, 400);
}

TEST_F(CriteriaRoutes, ABoundComesFromExpertsTrials) {
  // tom 40 s as the expert, tia as the novice, whose trial is made slow.
  ASSERT_TRUE(
      store_.write([&](store::Writing& tx) { return assess(tx, trial_of("tia"), false, 60); }));
  const std::string of = "/criteria/bound?metric=operation_time&side=at_most&experts=c-tom&method=";
  const Json cut = read("dora", of + "youden&novices=c-tia");
  EXPECT_EQ(cut["bound"], 50.0) << "half-way between 40 and 60";
  EXPECT_EQ(cut["area"], 1.0);
  EXPECT_EQ(cut["experts"]["values"], Json::parse("[40.0]"));
  EXPECT_EQ(cut["novices"]["people"], 1);
  EXPECT_EQ(read("dora", of + "percentile&share=0.9")["bound"], 40.0);
  read("dora", of + "mean_sd", 400);  // one value has no deviation
  read("dora", of + "guess", 400);
  read("fay", of + "youden&novices=c-tia", 404);  // not fay's cohort
  read("dora", "/criteria/bound?metric=none&side=at_most&experts=c-tom&method=youden", 400);
}

TEST_F(CriteriaRoutes, ACurriculumHandsOutItsStepsInOrder) {
  const Json people = given();
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0]["steps"][0]["state"], "open");
  EXPECT_EQ(people[0]["steps"][1]["state"], "waiting");
  EXPECT_EQ(people[0]["next"]["step"], "a");
  EXPECT_EQ(people[0]["next"]["case"], "L3");
  EXPECT_EQ(does_next(false), "Year 1: Step a");
  EXPECT_EQ(does_next(true), "Year 1: Step a") << "one wrong is no pass: the second trial";
  const std::string id = people[0]["curriculum_id"];
  const std::string where = "/curricula/" + id + "/progress";
  // 1 of 2 right: low end 0.0945 (R: prop.test(1, 2, correct = FALSE)), less than 0.2.
  EXPECT_EQ(read("fay", where)["people"][0]["steps"][0]["state"], "used_up");
  EXPECT_EQ(does_next(true), "") << "the second step waits";
  const auto again = post("fay", "/curricula/" + id + "/people/tom/again", {{"step", "a"}});
  EXPECT_EQ(again.status, 201) << text(again);
  EXPECT_EQ(does_next(true), "Year 1: Step a (again)");
  // 2 of 3 right: low end 0.2077: passed, and what is left of the step is offered no more.
  EXPECT_EQ(does_next(true), "Year 1: Step b");
  const Json passed = read("tom", "/accounts/tom/curricula")["people"][0];
  EXPECT_EQ(passed["passed"], true);
  EXPECT_EQ(passed["steps"][0]["rests_on"]["trials"], 3);
  EXPECT_EQ(passed["steps"][0]["rests_on"]["digest"].get<std::string>().size(), 64u);
  EXPECT_EQ(does_next(true), "");
  EXPECT_EQ(read("flo", where)["people"].size(), 0u) << "tom is not flo's";
  read("tom", "/accounts/tia/curricula", 404);
}

TEST_F(CriteriaRoutes, TheTraineesPageNamesTheCurriculumsNextCase) {
  given();
  const Json list = read("dora", "/cohort/trainees")["trainees"];
  const auto tom =
      std::ranges::find(list, Json("tom"), [](const Json& one) { return one["trainee"]; });
  ASSERT_NE(tom, list.end());
  EXPECT_EQ((*tom)["next"]["scenario"], "L3");
  EXPECT_NE((*tom)["next"]["why"].get<std::string>().find("Step a"), std::string::npos);
}

TEST_F(CriteriaRoutes, WhatIsHeldIsNotTold) {
  given("held");
  does_next(true);
  const Json own = read("tom", "/accounts/tom/curricula")["people"][0];
  EXPECT_EQ(own["steps"][0]["state"], "held");
  EXPECT_EQ(own["steps"][0]["passed"], false);
  EXPECT_EQ(own["steps"][0]["rests_on"]["trials"], 0);
  EXPECT_TRUE(own["next"]["case"].is_null());
  EXPECT_EQ(read("fay", "/accounts/tom/curricula")["people"][0]["steps"][0]["state"], "passed");
}

TEST_F(CriteriaRoutes, ANewVersionIsForThoseToCome) {
  const Json people = given();
  const std::string id = people[0]["curriculum_id"];
  Json changed = two_steps();
  changed["id"] = id;
  changed["steps"].erase(1);
  EXPECT_EQ(post("dora", "/curricula", changed).status, 201);
  EXPECT_EQ(read("dora", "/curricula")["curricula"][0]["versions"].size(), 2u);
  EXPECT_EQ(read("fay", "/curricula/" + id + "/progress")["people"][0]["steps"].size(), 2u);
  EXPECT_EQ(post("flo", "/curricula/" + id + "/cohorts", {{"cohort", "c-tia"}}).status, 201);
  const Json all = read("dora", "/curricula/" + id + "/progress")["people"];
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0]["name"], "tia");
  EXPECT_EQ(all[0]["version"], 2);
  EXPECT_EQ(all[0]["steps"].size(), 1u);
  EXPECT_EQ(all[1]["version"], 1);
  EXPECT_EQ(post("flo", "/curricula/" + id + "/cohorts", {{"cohort", "c-tia"}}).status, 409);
}

TEST_F(CriteriaRoutes, RefuseCurriculaThatAreNone) {
  const auto refused = [&](const char* pointer, const Json& value, int status) {
    Json body = two_steps();
    body[Json::json_pointer(pointer)] = value;
    const auto answer = post("dora", "/curricula", body);
    EXPECT_EQ(answer.status, status) << pointer << text(answer);
  };
  refused("/title", " ", 400);
  refused("/id", "nothing", 404);
  refused("/steps/0/cases", Json::array(), 400);
  refused("/steps/0/cases", {{{"case", std::string(64, 'e')}}}, 404);
  refused("/steps/0/after", {"b"}, 400);
  refused("/steps/0/criteria", {{"format", "x"}}, 400);
  EXPECT_EQ(read("dora", "/curricula")["curricula"].size(), 0u);
}

}  // namespace
}  // namespace api
}  // namespace tractus
