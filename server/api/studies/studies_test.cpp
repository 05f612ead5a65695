/// Studies over the API: what a person can ask for, and what a station is told.
#include <gmock/gmock.h>

#include "db/store/studies/study_slots.hpp"
#include "db/store/trials/trials.hpp"
#include "scenarios/scenario.hpp"
#include "server/api/api_test_support.hpp"
#include "server/api/trials/uploads.hpp"
#include "study/sealed_law.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace api {
namespace {
using testing::ApiTest;
using ::testing::HasSubstr;

core::Json plan() {
  return {{"id", "probing-1"},
          {"title", "Twelve trials"},
          {"scenarios",
           {{{"tuned", "hard"}},
            {{"tuned", "soft"}},
            {{"tuned", "lateral_breach"}},
            {{"tuned", "in_out_in"}}}},
          {"repeats", 3},
          {"ordering", "random"},
          {"seed", 42},
          {"participants",
           {{{"name", "P1"}, {"level", "senior"}, {"experience_years", 6}},
            {{"name", "P2"}, {"simulated", true}}}}};
}

class StudyRoutes : public ApiTest {
 protected:
  http::Response post(const std::string& path, const core::Json& body) {
    return ask(request("POST", "/api/v1/studies" + path, own_, body.dump()));
  }
  core::Json read(const std::string& path) {
    const auto response = ask(request("GET", "/api/v1/studies" + path, own_));
    EXPECT_EQ(response.status, 200) << text(response);
    return json(response);
  }
  http::Response take(const std::string& token, const std::string& name, int ahead = 1) {
    return ask(request(
        "POST",
        "/api/v1/studies/probing-1/participants/" + name + "/take?ahead=" + std::to_string(ahead),
        station(token)));
  }
  /// A whole trial of a slot, uploaded by station 1.
  void bring(const std::string& trial_id, const std::string& slot,
             world::Cut cut = world::Cut::no) {
    const Caller one{Role::station, "s1", "station-1", ""};
    const std::string bytes = world::probing_bytes(folder_.path(), trial_id, slot, 250, cut);
    ASSERT_TRUE(announce_upload(backend_, one, trial_id,
                                {slot, bytes.size(), core::sha256(core::bytes_of(bytes))}));
    const auto view = core::bytes_of(bytes);
    ASSERT_TRUE(append_upload(backend_, one, trial_id, 0, core::crc32c(view), view));
    const auto state = commit_upload(backend_, one, trial_id);
    ASSERT_TRUE(state) << state.error().what;
  }
  /// Every participant is through.
  void end_all() {
    const auto ended = store_.write([](store::Writing& tx) {
      return tx.query(
          "update study_slots set state = 'recorded' where state in ('waiting', 'taken')");
    });
    EXPECT_TRUE(ended);
  }
  std::string next_slot() {
    return json(take("token-1", "P1"))["trials"][0]["slot"].get<std::string>();
  }

  const std::map<std::string, std::string> own_{
      {"cookie", cookie()}, {"x-tractus", "1"}, {"content-type", "application/json"}};
};

TEST_F(StudyRoutes, MakeAStudyWithAPlaceForEveryTrial) {
  const auto made = post("", plan());
  ASSERT_EQ(made.status, 200) << text(made);
  const auto study = json(made);
  EXPECT_EQ(study["scenarios"].size(), 4u);
  ASSERT_EQ(study["participants"].size(), 2u);
  EXPECT_EQ(study["participants"][0]["slots"].size(), 12u);
  EXPECT_EQ(study["participants"][0]["experience_years"], 6.0);
  EXPECT_EQ(study["participants"][1]["simulated"], true);
  EXPECT_EQ(study["made_by"], "ada");
  EXPECT_EQ(read("")["studies"][0]["planned"], 24);
  EXPECT_EQ(read("/probing-1/events")["events"].size(), 3u);  // made, two enrolled
}

TEST_F(StudyRoutes, RefuseAPlanThatIsNotOneAndNameTheField) {
  const auto refused = [&](const char* pointer, const core::Json& value) {
    auto wrong = plan();
    wrong[core::Json::json_pointer(pointer)] = value;
    const auto response = post("", wrong);
    EXPECT_EQ(response.status, 400) << pointer;
    return json(response).value("error", "");
  };
  EXPECT_THAT(refused("/id", "Probing 1"), HasSubstr("id"));
  EXPECT_THAT(refused("/id", "../../etc"), HasSubstr("id"));
  EXPECT_THAT(refused("/repeats", 0), HasSubstr("repeats"));
  EXPECT_THAT(refused("/repeats", 1e9), HasSubstr("repeats"));
  EXPECT_THAT(refused("/ordering", "by taste"), HasSubstr("ordering"));
  EXPECT_THAT(refused("/on_invalid", "delete"), HasSubstr("on_invalid"));
  EXPECT_THAT(refused("/scenarios", core::Json::array()), HasSubstr("/scenarios"));
  EXPECT_THAT(refused("/scenarios/1", {{"tuned", "hard"}}), HasSubstr("/scenarios/1"));
  EXPECT_THAT(refused("/scenarios/1", {{"tuned", "harder"}}), HasSubstr("/scenarios/1/tuned"));
  EXPECT_THAT(refused("/scenarios/0", 7), HasSubstr("/scenarios/0"));
  EXPECT_THAT(refused("/participants/1/name", "P1"), HasSubstr("P1 occurs twice"));
  EXPECT_THAT(refused("/participants/0/name", "a b"), HasSubstr("name"));
  EXPECT_THAT(refused("/participants/0/experience_years", -1), HasSubstr("experience_years"));
  EXPECT_THAT(refused("/colour", "red"), HasSubstr("colour"));
  auto negative = scenarios::tuned(scenarios::Kind::hard)->to_json();
  negative["bone"]["stiffness_N_per_m"] = -1.0;
  EXPECT_THAT(refused("/scenarios/0", negative), HasSubstr("stiffness_N_per_m"));
  EXPECT_EQ(read("")["studies"].size(), 0u) << "nothing of a refused study is left";
}

TEST_F(StudyRoutes, RefuseASecondStudyOfTheSameName) {
  ASSERT_EQ(post("", plan()).status, 200);
  EXPECT_EQ(post("", plan()).status, 409);
}

TEST_F(StudyRoutes, GiveAStationTheLawOfExactlyTheNextTrial) {
  ASSERT_EQ(post("", plan()).status, 200);
  const auto taken = json(take("token-1", "P1"));
  ASSERT_EQ(taken["trials"].size(), 1u);
  EXPECT_EQ(taken["unfinished"], 12);
  EXPECT_EQ(taken["trials"][0]["number"], 1);
  const std::string slot = taken["trials"][0]["slot"];
  const auto law = study::opened_law(taken["trials"][0]["sealed"].get<std::string>(), slot,
                                     study::StationKey(token_hash("token-1")));
  ASSERT_TRUE(law) << law.error().what;
  const auto slots = store_.read([](store::Reading& tx) {
    return store::study_slots(tx, store::find_study(tx, "probing-1").value());
  });
  int fits = 0;
  for (int kind = 0; kind < scenarios::kKinds; ++kind) {
    const auto scenario = scenarios::tuned(scenarios::Kind(kind)).value();
    if (scenario.id() != slots->front().case_id) continue;
    ++fits;
    EXPECT_EQ(law->layers.size(), scenario.expanded()->layers.size());
    EXPECT_EQ(law->walls.size(), scenario.walls_m.size());
    EXPECT_EQ(law->travel_m, scenario.travel_m);
  }
  EXPECT_EQ(fits, 1);
}

TEST_F(StudyRoutes, GiveAStationTheRemainingTrialsAheadForAnOutage) {
  ASSERT_EQ(post("", plan()).status, 200);
  const auto taken = json(take("token-1", "P1", 400));
  ASSERT_EQ(taken["trials"].size(), 12u);
  EXPECT_EQ(taken["trials"][11]["number"], 12);
  EXPECT_EQ(take("token-2", "P1").status, 409) << "another station must not have them too";
  EXPECT_EQ(take("token-2", "P2").status, 200);
  EXPECT_EQ(take("token-1", "P9").status, 404);
}

TEST_F(StudyRoutes, TellAStationNothingThatNamesOrTellsApartItsTrials) {
  ASSERT_EQ(post("", plan()).status, 200);
  const auto all = text(take("token-1", "P1", 400));
  std::vector<std::string> telling{"breach", "hard",  "soft",  "lateral", "in_out", "scenario",
                                   "kind",   "walls", "layer", "seed",    "tuned",  "order"};
  for (int kind = 0; kind < scenarios::kKinds; ++kind) {
    const auto scenario = scenarios::tuned(scenarios::Kind(kind)).value();
    telling.push_back(scenario.id());
    telling.push_back(scenario.name);
  }
  auto readable = core::Json::parse(all);
  std::set<std::size_t> sizes;
  std::set<std::string> names;
  for (auto& trial : readable["trials"]) {
    sizes.insert(trial["sealed"].get<std::string>().size());
    names.insert(trial["slot"].get<std::string>());
    trial.erase("sealed");  // random characters spell anything
    trial.erase("slot");
  }
  EXPECT_EQ(sizes.size(), 1u);
  EXPECT_EQ(names.size(), 12u);
  for (const auto& word : telling) EXPECT_EQ(readable.dump().find(word), std::string::npos) << word;
}

TEST_F(StudyRoutes, AreClosedToAStationButForTakingTrials) {
  ASSERT_EQ(post("", plan()).status, 200);
  const auto status = [&](const char* method, const std::string& path) {
    return ask(request(method, "/api/v1" + path, station("token-1"))).status;
  };
  for (const char* path : {"/studies", "/studies/probing-1", "/studies/probing-1/events"})
    EXPECT_EQ(status("GET", path), 403) << path;
  const std::string hard = scenarios::tuned(scenarios::Kind::hard)->id();
  const auto unknown = ask(request(
      "GET", "/api/v1/cases/" + std::string(64, 'e') + "/parts/scenario.json", station("token-1")));
  const auto known =
      ask(request("GET", "/api/v1/cases/" + hard + "/parts/scenario.json", station("token-1")));
  EXPECT_EQ(known.status, unknown.status) << "a station cannot find out which scenarios are here";
  const auto list = text(ask(request("GET", "/api/v1/cases", station("token-1"))));
  EXPECT_EQ(list.find(hard), std::string::npos);
}

TEST_F(StudyRoutes, DoNotTellWhoRunsTheStudyWhatComesNext) {
  ASSERT_EQ(post("", plan()).status, 200);
  auto study = read("/probing-1");
  EXPECT_TRUE(study["seed"].is_null());
  for (const auto& slot : study["participants"][0]["slots"])
    EXPECT_TRUE(slot["scenario"].is_null());
  bring(std::string(32, 'a'), next_slot());
  study = read("/probing-1");
  EXPECT_TRUE(study["participants"][0]["slots"][0]["scenario"].is_null());
  EXPECT_EQ(study["participants"][0]["slots"][0]["state"], "recorded");
}

TEST_F(StudyRoutes, TellTheScenariosOnceTheParticipantIsThroughAndTheSeedOnceAllAre) {
  auto short_plan = plan();
  short_plan["repeats"] = 1;
  short_plan["scenarios"] = {{{"tuned", "hard"}}};
  short_plan["participants"] = {{{"name", "P1"}}};
  ASSERT_EQ(post("", short_plan).status, 200);
  bring(std::string(32, 'a'), next_slot());
  const auto study = read("/probing-1");
  EXPECT_EQ(study["participants"][0]["slots"][0]["scenario"], "Hard bone");
  EXPECT_EQ(study["seed"], 42);
  EXPECT_EQ(json(take("token-1", "P1"))["unfinished"], 0);
}

TEST_F(StudyRoutes, ATrialComesBackUnderItsSlotsNameAndIsOneOfItsScenario) {
  ASSERT_EQ(post("", plan()).status, 200);
  const std::string trial(32, 'a'), slot = next_slot();
  bring(trial, slot);
  const Caller one{Role::station, "s1", "station-1", ""};
  EXPECT_EQ(commit_upload(backend_, one, trial)->state, trial::UploadPhase::complete)
      << "repeating it is harmless";
  const auto study = read("/probing-1");
  const auto& place = study["participants"][0]["slots"][0];
  ASSERT_EQ(place["trials"].size(), 1u);
  EXPECT_EQ(place["trials"][0]["id"], trial);
  EXPECT_EQ(place["trials"][0]["state"], "counts");
  EXPECT_EQ(place["trials"][0]["samples"], 250);
  EXPECT_EQ(place["trials"][0]["station"], "station-1");
  EXPECT_EQ(study["participants"][0]["done"], 1);
  const auto kept = store_.read([&](store::Reading& tx) { return store::trial_of(tx, trial); });
  EXPECT_NE((*kept)->summary.case_id, slot);
  EXPECT_EQ(place["trials"][0]["correct"], nullptr);
  EXPECT_EQ(ask(request("GET", "/api/v1/trials/" + trial, own_)).status, 403) << "not through";
  end_all();
  const auto page = json(ask(request("GET", "/api/v1/trials/" + trial, own_)));
  EXPECT_EQ(page["scenario"]["name"], (*kept)->summary.case_title);
  EXPECT_EQ(page["answer"]["depth_m"], 0.021);
}

TEST_F(StudyRoutes, ATrialCutShortByACrashIsKeptAndItsPlaceRepeated) {
  ASSERT_EQ(post("", plan()).status, 200);
  bring(std::string(32, 'a'), next_slot(), world::Cut::yes);
  const auto who = read("/probing-1")["participants"][0];
  EXPECT_EQ(who["slots"][0]["trials"][0]["state"], "invalid");
  EXPECT_THAT(who["slots"][0]["trials"][0]["reason"], HasSubstr("cut short"));
  EXPECT_EQ(who["slots"].size(), 13u);
}

TEST_F(StudyRoutes, ATrialOfTheOtherRigIsRefused) {
  ASSERT_EQ(post("", plan()).status, 200);
  const std::string trial(32, 'a'), slot = next_slot();
  const Caller one{Role::station, "s1", "station-1", ""};
  const std::string bytes = world::trial_bytes(folder_.path(), trial, slot, 250);
  const auto view = core::bytes_of(bytes);
  ASSERT_TRUE(announce_upload(backend_, one, trial, {slot, bytes.size(), core::sha256(view)}));
  ASSERT_TRUE(append_upload(backend_, one, trial, 0, core::crc32c(view), view));
  const auto refused = commit_upload(backend_, one, trial);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("palpation"));
}

TEST_F(StudyRoutes, ATrialOfAnotherPlaceIsRefused) {
  ASSERT_EQ(post("", plan()).status, 200);
  const auto taken = json(take("token-1", "P1", 2));
  const std::string trial(32, 'a'), first = taken["trials"][0]["slot"],
                                    second = taken["trials"][1]["slot"];
  const Caller one{Role::station, "s1", "station-1", ""};
  const std::string bytes = world::probing_bytes(folder_.path(), trial, second, 250);
  const auto view = core::bytes_of(bytes);
  ASSERT_TRUE(announce_upload(backend_, one, trial, {first, bytes.size(), core::sha256(view)}));
  ASSERT_TRUE(append_upload(backend_, one, trial, 0, core::crc32c(view), view));
  const auto refused = commit_upload(backend_, one, trial);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::bad_input);
}

TEST_F(StudyRoutes, ASlotIsHandedOverByStationsThatTookItAlone) {
  ASSERT_EQ(post("", plan()).status, 200);
  const std::string trial(32, 'a'), slot = next_slot();
  const wire::UploadAnnouncement announced{slot, 10, std::string(64, 'e')};
  const auto stolen =
      announce_upload(backend_, {Role::station, "s2", "station-2", ""}, trial, announced);
  ASSERT_FALSE(stolen);
  EXPECT_EQ(stolen.error().code, core::Errc::not_found);
  ASSERT_EQ(post("/probing-1/participants/P1/release", {{"reason", "it broke"}}).status, 200);
  EXPECT_TRUE(announce_upload(backend_, {Role::station, "s1", "station-1", ""}, trial, announced))
      << "what was recorded before the release is not lost";
}

TEST_F(StudyRoutes, PauseKeepsTrialsBackUntilItIsOver) {
  ASSERT_EQ(post("", plan()).status, 200);
  ASSERT_EQ(post("/probing-1/state", {{"state", "paused"}, {"reason", "lunch"}}).status, 200);
  EXPECT_EQ(take("token-1", "P1").status, 409);
  ASSERT_EQ(post("/probing-1/state", {{"state", "running"}}).status, 200);
  EXPECT_EQ(take("token-1", "P1").status, 200);
  ASSERT_EQ(post("/probing-1/participants/P1/state", {{"state", "paused"}}).status, 200);
  EXPECT_EQ(take("token-1", "P1").status, 409);
  EXPECT_EQ(take("token-1", "P2").status, 200);
  const auto events = read("/probing-1/events")["events"];
  EXPECT_EQ(events[1]["what"], "paused");
  EXPECT_EQ(events[1]["participant"], "P1");
  EXPECT_EQ(post("/probing-1/state", {{"state", "ended"}}).status, 400);
  EXPECT_EQ(post("/probing-1/participants/P9/state", {{"state", "paused"}}).status, 404);
}

TEST_F(StudyRoutes, AnInvalidTrialNeedsAReasonStaysAndIsRepeated) {
  ASSERT_EQ(post("", plan()).status, 200);
  const std::string trial(32, 'a');
  bring(trial, next_slot());
  const std::string path = "/probing-1/trials/" + trial + "/invalid";
  EXPECT_EQ(post(path, {{"reason", "  "}}).status, 400);
  EXPECT_EQ(post(path, core::Json::object()).status, 400);
  const auto marked = post(path, {{"reason", "the cable came loose"}});
  ASSERT_EQ(marked.status, 200) << text(marked);
  const auto who = json(marked)["participants"][0];
  ASSERT_EQ(who["slots"].size(), 13u);
  EXPECT_EQ(who["slots"][0]["trials"][0]["state"], "invalid");
  EXPECT_EQ(who["slots"][0]["trials"][0]["reason"], "the cable came loose");
  EXPECT_EQ(who["slots"][12]["repeat_of"], 1);
  EXPECT_EQ(who["planned"], 12);
  EXPECT_EQ(who["done"], 0);
  EXPECT_EQ(post(path, {{"reason", "again"}}).status, 409);
  EXPECT_EQ(
      post("/probing-1/trials/" + std::string(32, 'b') + "/invalid", {{"reason", "x"}}).status,
      404);
  end_all();
  const auto kept = ask(request("GET", "/api/v1/trials/" + trial, own_));
  EXPECT_EQ(kept.status, 200) << "nothing is deleted: " << text(kept);
  EXPECT_EQ(json(kept)["study"]["state"], "invalid");
  EXPECT_EQ(json(kept)["study"]["participant"], "P1");
}

TEST_F(StudyRoutes, WhatAStationHoldsIsReleasedToAnother) {
  ASSERT_EQ(post("", plan()).status, 200);
  const std::string slot = next_slot();
  ASSERT_EQ(post("/probing-1/participants/P1/release", {{"reason", "station broke"}}).status, 200);
  const auto taken = json(take("token-2", "P1"));
  EXPECT_EQ(taken["trials"][0]["slot"], slot);
  // The first station comes back with its trial after all: nothing is lost.
  bring(std::string(32, 'a'), slot);
  EXPECT_EQ(read("/probing-1")["participants"][0]["slots"][0]["state"], "recorded");
}

TEST_F(StudyRoutes, AParticipantEnrolledLaterGetsAnOrderOfTheirOwn) {
  ASSERT_EQ(post("", plan()).status, 200);
  ASSERT_EQ(post("/probing-1/participants", {{"name", "P3"}}).status, 200);
  EXPECT_EQ(post("/probing-1/participants", {{"name", "P3"}}).status, 409);
  EXPECT_EQ(post("/nowhere/participants", {{"name", "P3"}}).status, 404);
  std::map<std::string, std::string> orders;
  const auto slots = store_.read([](store::Reading& tx) {
    return store::study_slots(tx, store::find_study(tx, "probing-1").value());
  });
  for (const auto& slot : slots.value()) orders[slot.participant] += slot.case_id;
  ASSERT_EQ(orders.size(), 3u);
  EXPECT_EQ(orders["P3"].size(), 12u * 64);
  EXPECT_NE(orders["P3"], orders["P1"]);
}

}  // namespace
}  // namespace api
}  // namespace tractus
