/// Comments, examples and authored scenarios: who may say what of whose trial, and who sees it.
#include "db/store/trials/debriefs.hpp"
#include "scenarios/scenario.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using testing::kCase;
using testing::PeopleTest;

class Debrief : public PeopleTest {
 protected:
  std::string comments_of(const std::string& trainee) {
    return "/trials/" + trial_of(trainee) + "/comments";
  }
  void set_release(const std::string& release) {
    EXPECT_EQ(post("fay", "/assignments/a-tom/release", {{"release", release}}).status, 200);
  }
  http::Response remove(const std::string& account, const std::string& path) {
    return ask(request("DELETE", "/api/v1" + path, as(account)));
  }
};

TEST_F(Debrief, ACommentIsSeenByItsTraineeOnceResultsAreReleased) {
  set_release("held");
  const auto said = post("fay", comments_of("tom"), {{"at_s", 2.5}, {"text", "Here you slipped."}});
  ASSERT_EQ(said.status, 201) << text(said);
  EXPECT_EQ(get("tom", comments_of("tom")).status, 404);
  set_release("released");
  const core::Json seen = json(get("tom", comments_of("tom")))["comments"];
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0]["at_s"], 2.5);
  EXPECT_EQ(seen[0]["text"], "Here you slipped.");
  EXPECT_EQ(seen[0]["by"], "fay");
  EXPECT_EQ(seen[0]["own"], false);
  set_release("held");
  EXPECT_EQ(get("tom", comments_of("tom")).status, 404) << "a release can be taken back";
}

TEST_F(Debrief, NobodyCommentsOnTrialsOfOthersTrainees) {
  const core::Json words{{"text", "Well done."}};
  EXPECT_EQ(post("flo", comments_of("tom"), words).status, 404);
  EXPECT_EQ(post("tom", comments_of("tom"), words).status, 403);
  EXPECT_EQ(get("tia", comments_of("tom")).status, 404);
}

TEST_F(Debrief, ACommentOfTheWholeTrialComesBeforeThoseOfItsMoments) {
  post("fay", comments_of("tom"), {{"at_s", 3.0}, {"text", "second"}});
  post("fay", comments_of("tom"), {{"at_s", 1.0}, {"text", "first"}});
  const core::Json all = json(post("fay", comments_of("tom"), {{"text", "whole"}}))["comments"];
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0]["text"], "whole");
  EXPECT_EQ(all[0]["at_s"], nullptr);
  EXPECT_EQ(all[1]["text"], "first");
}

TEST_F(Debrief, ACommentIsTakenBackByItsMakerAlone) {
  const core::Json made = json(post("fay", comments_of("tom"), {{"text", "hm"}}))["comments"][0];
  const std::string one = comments_of("tom") + "/" + made["id"].get<std::string>();
  EXPECT_EQ(remove("ann", one).status, 404) << "an administrator's are others'";
  EXPECT_EQ(json(remove("fay", one))["comments"].size(), 0u);
  EXPECT_EQ(remove("fay", one).status, 404);
}

TEST_F(Debrief, RefusesAnEmptyCommentAndAMomentThatIsNone) {
  EXPECT_EQ(post("fay", comments_of("tom"), {{"text", " \n"}}).status, 400);
  EXPECT_EQ(post("fay", comments_of("tom"), {{"text", "x"}, {"at_s", -1.0}}).status, 400);
  EXPECT_EQ(post("fay", comments_of("tom"), {{"text", std::string(5000, 'x')}}).status, 400);
  EXPECT_EQ(post("ann", "/trials/" + std::string(32, '0') + "/comments", {{"text", "x"}}).status,
            404);
}

TEST_F(Debrief, AnExampleIsOfferedToTrialsOfTheSameCaseWithoutANameToTrainees) {
  const std::string toms = trial_of("tom"), tias = trial_of("tia");
  EXPECT_EQ(json(get("fay", "/trials/" + toms + "/references"))["trials"].size(), 0u);
  ASSERT_EQ(post("flo", "/trials/" + tias + "/reference", {{"reference", true}}).status, 200);
  const core::Json offered = json(get("fay", "/trials/" + toms + "/references"));
  ASSERT_EQ(offered["trials"].size(), 1u);
  EXPECT_EQ(offered["trials"][0]["id"], tias);
  EXPECT_EQ(offered["reference"], false);
  EXPECT_EQ(json(get("flo", "/trials/" + tias + "/references"))["trials"].size(), 0u)
      << "it is no example for itself";
  EXPECT_EQ(json(get("tom", "/trials/" + toms + "/references"))["trials"][0]["operator"], "");
  EXPECT_EQ(post("fay", "/trials/" + tias + "/reference", {{"reference", false}}).status, 404);
  EXPECT_EQ(get("tom", "/trials/" + toms + "/references/" + toms).status, 404)
      << "only what is offered";
}

TEST_F(Debrief, ATraineeSeesTheOwnTrialsOfAnAssignmentOnceReleased) {
  post("fay", comments_of("tom"), {{"text", "Good."}});
  set_release("held");
  EXPECT_EQ(json(get("tom", "/assignments/a-tom")).contains("trials"), false);
  set_release("released");
  const core::Json own = json(get("tom", "/assignments/a-tom"));
  ASSERT_EQ(own["trials"].size(), 1u) << own;
  EXPECT_EQ(own["trials"][0]["trial_id"], trial_of("tom"));
  EXPECT_EQ(own["trials"][0]["comments"], 1);
  EXPECT_EQ(own["trials"][0]["number"], 1);
  EXPECT_EQ(own.contains("trainees"), false);
}

TEST_F(Debrief, ARetiredCaseIsAssignedNoMoreUntilItIsOfferedAgain) {
  const core::Json plan{{"title", "t"}, {"cohort", "c-tom"}, {"cases", {{{"case", kCase}}}}};
  ASSERT_EQ(post("fay", "/cases/" + kCase + "/retire", {{"retired", true}}).status, 204);
  EXPECT_EQ(post("fay", "/assignments", plan).status, 409);
  EXPECT_EQ(json(get("fay", "/cases"))["cases"][0]["retired"], true);
  ASSERT_EQ(post("fay", "/cases/" + kCase + "/retire", {{"retired", false}}).status, 204);
  EXPECT_EQ(post("fay", "/assignments", plan).status, 201);
  EXPECT_EQ(post("fay", "/cases/none/retire", {{"retired", true}}).status, 404);
}

/// Authored scenarios.
class Authored : public Debrief {
 protected:
  core::Json draft() {
    core::Json out = scenarios::tuned(scenarios::Kind::lateral_breach)->to_json();
    out.erase("origin");
    out["name"] = "a wall early on";
    return out;
  }
};

TEST_F(Authored, ADraftIsCheckedWithThePointerOfWhatIsWrong) {
  const core::Json fine = json(post("fay", "/scenarios/check", draft()));
  EXPECT_EQ(fine["ok"], true) << fine;
  ASSERT_EQ(fine["curve"]["at"].size(), 3u);
  EXPECT_EQ(fine["curve"]["at"][0]["force_N"].size(), fine["curve"]["depth_m"].size());
  EXPECT_EQ(fine["curve"]["walls"].size(), 1u);
  core::Json wrong = draft();
  wrong["bone"]["stiffness_N_per_m"] = -1;
  const core::Json said = json(post("fay", "/scenarios/check", wrong));
  EXPECT_EQ(said["ok"], false);
  EXPECT_EQ(said["field"], "/bone/stiffness_N_per_m") << said;
  EXPECT_NE(said["error"].get<std::string>().find("-1 is outside"), std::string::npos) << said;
  EXPECT_EQ(said["curve"], nullptr);
}

TEST_F(Authored, AVersionSaysWhoMadeItOfWhatAndIsAssignedOncePublished) {
  const auto made =
      post("fay", "/scenarios", {{"scenario", draft()}, {"parent", "lateral_breach"}});
  ASSERT_EQ(made.status, 201) << text(made);
  const std::string id = json(made)["id"];
  const core::Json file = json(get("fay", "/scenarios/" + id));
  EXPECT_EQ(file["origin"]["who"], "fay");
  EXPECT_EQ(file["origin"]["parent"], scenarios::tuned(scenarios::Kind::lateral_breach)->id());
  const core::Json plan{{"title", "Rig"}, {"people", {"tom"}}, {"cases", {{{"case", id}}}}};
  EXPECT_EQ(post("fay", "/assignments", plan).status, 404) << "not offered yet";
  ASSERT_EQ(post("fay", "/scenarios/" + id + "/publish", {{"published", true}}).status, 200);
  EXPECT_EQ(post("fay", "/assignments", plan).status, 201);
  ASSERT_EQ(post("fay", "/scenarios/" + id + "/publish", {{"published", false}}).status, 200);
  EXPECT_EQ(post("fay", "/assignments", plan).status, 409) << "offered no more";
  EXPECT_EQ(json(get("fay", "/cases"))["cases"].size(), 1u) << "scenarios are not listed as cases";
}

TEST_F(Authored, VersionsAreOfThoseWhoTeach) {
  for (const char* nosy : {"tom", "ted"}) {
    EXPECT_EQ(get(nosy, "/scenarios").status, 403) << nosy;
    EXPECT_EQ(get(nosy, "/scenarios/hard").status, 403) << nosy;
  }
  EXPECT_EQ(json(get("fay", "/scenarios"))["tuned"].size(), 4u);
  EXPECT_EQ(get("fay", "/scenarios/none").status, 404);
  EXPECT_EQ(post("fay", "/scenarios", {{"scenario", 5}}).status, 400);
}

}  // namespace
}  // namespace api
}  // namespace tractus
