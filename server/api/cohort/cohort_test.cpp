/// A cohort's table, locked plans and analyses of it, from trials put into the store.
#include <gmock/gmock.h>

#include <cmath>

#include "core/try.hpp"
#include "db/store/cohort/analyses.hpp"
#include "db/store/people/pseudonyms.hpp"
#include "db/store/studies/study_slots.hpp"
#include "db/store/trials/trials.hpp"
#include "db/store/trials/uploads.hpp"
#include "server/api/api_test_support.hpp"
#include "server/jobs/analyse.hpp"

namespace tractus {
namespace api::testing {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// A study of a resident (P1) and a senior (P2), three trials each that count; the resident has a
/// fourth that does not, the senior a fourth without scores. Beside it a trial of no study.
class Cohort : public ApiTest {
 protected:
  Cohort() {
    backend_.pseudonym_key.emplace();
    backend_.pseudonym_key->fill(std::byte{7});
    const auto made = store_.write([&](store::Writing& tx) -> core::Result<void> {
      const store::Study study{.id = "spine",
                               .title = "",
                               .ordering = store::CaseOrder::random,
                               .on_invalid = store::Repetition::never};
      TRY(store::add_study(tx, study, {kCase}, deed_));
      const std::vector<std::string> cases(4, kCase);
      for (const auto& person :
           {store::Participant{.name = "P1", .level = "resident", .experience_years = 2.5},
            store::Participant{.name = "P2", .level = "senior", .simulated = true}})
        TRY(store::add_participant(tx, store::find_study(tx, "spine").value(), person, cases,
                                   deed_));
      return {};
    });
    EXPECT_TRUE(made);
    const auto slots = store_
                           .read([](store::Reading& tx) {
                             return store::study_slots(tx, store::find_study(tx, "spine").value());
                           })
                           .value();
    for (int i = 0; i < 8; ++i) add(i, slots[std::size_t(i)].id, values_[std::size_t(i)]);
    add(8, "", 7.5);
    const auto judged = store_.write([&](store::Writing& tx) {
      return store::set_trial_invalid(tx, store::find_study(tx, "spine").value(), id_of(3),
                                      {"ada", 3, "phone rang"});
    });
    EXPECT_TRUE(judged) << judged.error().what;
  }

  store::Pseudonyms names() const { return store::Pseudonyms(*backend_.pseudonym_key); }
  std::string trial_name(int i) const { return names().trial(id_of(i)); }
  std::string person_name(const std::string& participant) const {
    return names().person("participant:spine/" + participant);
  }
  /// Of a participant of the study, by a form.
  void agree(const std::string& participant, const std::string& tier) {
    const auto noted = ask(request(
        "POST", "/api/v1/consents", own_,
        core::Json{
            {"study", "spine"}, {"participant", participant}, {"tier", tier}, {"basis", "folder 3"}}
            .dump()));
    EXPECT_EQ(noted.status, 204) << text(noted);
  }
  /// The participant has one more trial to do.
  void reopen(const std::string& participant) {
    const auto opened = store_.write([&](store::Writing& tx) {
      return tx.query(
          "update study_slots set state = 'waiting' where participant = ? and position "
          "= 3",
          {participant});
    });
    EXPECT_TRUE(opened);
  }
  static std::string id_of(int i) { return std::string(31, '0') + std::to_string(i); }

  /// One trial; without scores when there is no value.
  void add(int i, const std::string& slot, std::optional<double> value) {
    const std::string id = id_of(i), sha(64, char('0' + i));
    store::TrialRecord trial;
    trial.summary.id = id;
    trial.summary.case_id = kCase;
    trial.summary.operator_name = "=HYPERLINK(\"x\"), \nEve";
    trial.summary.simulated = i >= 4;
    trial.summary.started_utc_us = 10 + i;
    trial.station_id = "s1";
    trial.sha256 = sha;
    trial.complete = true;
    trial.header = trial.events = "{}";
    const auto added = store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(store::add_upload(tx, {id, "s1", kCase, 1, sha, store::UploadPhase::receiving}, 1));
      if (!slot.empty()) TRY(store::announce_for_slot(tx, id, slot, 1));
      TRY(store::add_object(tx, sha, 1, 1));
      TRY(store::add_trial(tx, trial, 1));
      if (!slot.empty()) TRY(store::record_for_slot(tx, id, true, deed_));
      if (!value) return {};
      return store::set_assessment(tx, id, {{"score_N", *value, ""}, {"none_s", {}, "no contact"}},
                                   i % 2 == 0, "{}");
    });
    EXPECT_TRUE(added) << added.error().what;
  }

  http::Response post(const std::string& what, const core::Json& asked) {
    return ask(request("POST", "/api/v1/cohort/" + what, own_, asked.dump()));
  }
  http::Response get(const std::string& what) {
    return ask(request("GET", "/api/v1/cohort/" + what, own_));
  }
  /// Asks, does the job, and gives what the server then says.
  core::Json analysed(const core::Json& asked) {
    ++now_;
    const auto queued = post("analyses", asked);
    EXPECT_EQ(queued.status, 201) << text(queued);
    const std::string id = json(queued).value("id", "");
    EXPECT_EQ(json(get("analyses/" + id))["state"], "queued");
    const auto done =
        jobs::analyse(store_, objects_, backend_.pseudonym_key, id, [] { return false; });
    if (!done) {
      const auto failed = store_.write([&](store::Writing& tx) {
        return store::end_analysis(tx, id, store::AnalysisState::failed, done.error().what, 2);
      });
      EXPECT_TRUE(failed);
    }
    return json(get("analyses/" + id));
  }
  /// Two means compared, and a question that these data cannot answer.
  static core::Json plan() {
    return {{"format", "tractus-plan/1"},
            {"title", "Seniors and residents"},
            {"question", "Do seniors score higher?"},
            {"endpoint", "score_N"},
            {"subject", "participant"},
            {"correction", "holm"},
            {"exclusions",
             core::Json::array({{{"where", "number > 3"}, {"reason", "a fourth trial"}}})},
            {"analyses", core::Json::array({{{"id", "levels"},
                                             {"question", "Do levels differ?"},
                                             {"family", "primary"},
                                             {"method", "anova"},
                                             {"formula", "score_N ~ level"}},
                                            {{"id", "nothing"},
                                             {"question", "Of a column that is not there"},
                                             {"family", "primary"},
                                             {"method", "ols"},
                                             {"formula", "score_N ~ luck"}}})}};
  }
  std::string table(const std::string& query = "") {
    const auto response = ask(request("GET", "/api/v1/cohort/table" + query, own_));
    EXPECT_EQ(response.status, 200);
    return text(response);
  }

  const store::AuditStamp deed_{"ada", 1};
  const std::vector<std::optional<double>> values_{1, 2, 3, 1000, 4, 5, 9, std::nullopt};
  const std::map<std::string, std::string> own_{
      {"cookie", cookie()}, {"x-tractus", "1"}, {"content-type", "application/json"}};
};

TEST_F(Cohort, ComparesTwoLevelsAsAHandDoes) {
  const auto answer =
      analysed({{"method", "anova"}, {"formula", "score_N ~ level"}, {"study", "spine"}});
  ASSERT_EQ(answer["state"], "done") << answer.dump();
  // Means 2 and 6 about 4: between 3·4 + 3·4 = 24 of 1 degree; within 2 + 14 = 16 of 4; F = 24/4.
  const auto& found = answer["result"]["analyses"][0]["report"]["analysis"];
  EXPECT_NEAR(found["F"].get<double>(), 6.0, 1e-12);
  EXPECT_EQ(found["df_within"], 4.0);
  // Student's t of 4 degrees in closed form (Abramowitz & Stegun 26.7.4), t² = 6:
  // sin² = 6/10, cos² = 4/10, p = 1 − sin(1 + cos²/2).
  EXPECT_NEAR(found["p"].get<double>(), 1.0 - std::sqrt(0.6) * 1.2, 1e-9);
  EXPECT_EQ(answer["plan"], nullptr);
  EXPECT_FALSE(answer["result"]["plan"].contains("lock"));
  EXPECT_EQ(answer["data"]["rows"], 6);
  EXPECT_EQ(answer["data"]["rows_simulated"], 3);
  EXPECT_EQ(answer["data"]["simulated"], true);
  EXPECT_EQ(answer["data"]["left_out"]["invalid"], 1);
  EXPECT_EQ(answer["data"]["left_out"]["unscored"], 1);
  EXPECT_EQ(woken_, 1);
}

TEST_F(Cohort, ALockedPlanRunsToAReportWithItsDataAndDictionary) {
  const auto locked = post("plans", {{"plan", plan()}, {"study", "spine"}});
  ASSERT_EQ(locked.status, 201) << text(locked);
  const std::string id = json(locked)["id"];
  // Six trials were there to be seen, whatever is said.
  EXPECT_EQ(json(locked)["data_seen"], true);
  EXPECT_EQ(json(locked)["trials_then"], 6);
  EXPECT_EQ(json(locked)["made_by"], "ada");
  const auto answer = analysed({{"plan", id}});
  ASSERT_EQ(answer["state"], "done") << answer.dump();
  const auto& result = answer["result"];
  EXPECT_EQ(result["plan"]["lock"]["who"], "ada");
  // What cannot be done counts as p = 1; Holm doubles the smaller of two.
  const auto& tests = result["families"][0]["tests"];
  ASSERT_EQ(tests.size(), 2u);
  EXPECT_NEAR(tests[0]["p_adjusted"].get<double>(), 2.0 * (1.0 - std::sqrt(0.6) * 1.2), 1e-9);
  EXPECT_EQ(tests[1]["p"], 1.0);
  EXPECT_THAT(result["analyses"][1]["error"].get<std::string>(), HasSubstr("luck"));
  const std::string run = "analyses/" + answer["id"].get<std::string>() + "/";
  const auto page = get(run + "report.html");
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(std::string(page.header("Content-Security-Policy")), HasSubstr("sandbox"));
  const auto csv = get(run + "data.csv");
  EXPECT_EQ(csv.status, 200);
  const auto dictionary = json(get(run + "dictionary.json"));
  ASSERT_EQ(dictionary.size(), 16u);  // fifteen columns and why a row is left out
  EXPECT_EQ(dictionary[15]["name"], "excluded_because");
  EXPECT_EQ(dictionary[14]["unit"], "N");
  EXPECT_EQ(get(run + "password.txt").status, 404);
  const auto listed = json(get("plans/" + id));
  EXPECT_EQ(listed["plan"]["lock"]["data_seen"], true);
  EXPECT_EQ(listed["analyses"].size(), 1u);
  EXPECT_EQ(json(get("plans"))["plans"].size(), 1u);
}

TEST_F(Cohort, ARunOnTheSameSnapshotGivesTheSameDigitsWhateverCameSince) {
  const std::string id = json(post("plans", {{"plan", plan()}, {"study", "spine"}}))["id"];
  const auto first = analysed({{"plan", id}});
  ASSERT_EQ(first["state"], "done") << first.dump();
  EXPECT_EQ(first["repeats"], nullptr);
  const auto judged = store_.write([&](store::Writing& tx) {
    return store::set_trial_invalid(tx, store::find_study(tx, "spine").value(), id_of(0),
                                    {"ada", 4, "wrong probe"});
  });
  ASSERT_TRUE(judged);
  const auto again = analysed({{"plan", id}, {"snapshot", first["snapshot"]}});
  ASSERT_EQ(again["state"], "done") << again.dump();
  EXPECT_EQ(again["repeats"], first["id"]);
  EXPECT_EQ(again["same_digits"], true);
  EXPECT_EQ(again["result"], first["result"]);
  const auto fresh = analysed({{"plan", id}});
  EXPECT_EQ(fresh["data"]["rows"], 5);
  EXPECT_NE(fresh["snapshot"], first["snapshot"]);
  EXPECT_EQ(fresh["same_digits"], nullptr);
}

TEST_F(Cohort, APlanThatIsWrongOrLockedAlreadyIsRefused) {
  const auto refused = [&](const core::Json& asked) {
    const auto response = post("plans", asked);
    EXPECT_GE(response.status, 400) << asked.dump();
    return json(response).value("error", "");
  };
  auto wrong = plan();
  wrong["analyses"][0]["method"] = "tarot";
  EXPECT_THAT(refused({{"plan", wrong}}), HasSubstr("tarot"));
  EXPECT_THAT(refused({{"plan", plan()}, {"study", "knee"}}), HasSubstr("knee"));
  EXPECT_THAT(refused({{"plan", plan()}, {"data_seen", "no"}}), HasSubstr("data_seen"));
  EXPECT_THAT(refused({{"plan", 3}}), HasSubstr("object"));
  EXPECT_THAT(refused(core::Json::object()), HasSubstr("plan"));
  auto locked = plan();
  locked["lock"] = {{"who", "eve"}, {"utc", "then"}, {"data_seen", false}, {"sha256", "0"}};
  EXPECT_THAT(refused({{"plan", locked}}), HasSubstr("eve"));
  EXPECT_EQ(json(get("plans"))["plans"].size(), 0u);
}

TEST_F(Cohort, TheTableIsOneRowPerTrialThatCounts) {
  const std::string head =
      "trial,participant,study,number,running_number,cohort,level,experience_years,date,year,case,"
      "rig,simulated,correct,score_N\n";
  const std::string csv = table("?study=spine");
  const std::string p1 = "," + person_name("P1"), p2 = "," + person_name("P2");
  EXPECT_TRUE(csv.starts_with(head + trial_name(0) + p1 +
                              ",spine,1,1,,resident,2.5,1970-01-01,1970.0000,L3,palpation,0,1,1\n" +
                              trial_name(1) + p1 +
                              ",spine,2,2,,resident,2.5,1970-01-01,1970.0000,L3,palpation,0,0,2\n"))
      << csv;
  EXPECT_THAT(csv, HasSubstr(trial_name(4) + p2 +
                             ",spine,1,1,,senior,,1970-01-01,1970.0000,L3,palpation,1,1,4\n"));
  EXPECT_EQ(std::ranges::count(csv, '\n'), 7);
  EXPECT_EQ(
      analysed(
          {{"method", "anova"}, {"formula", "score_N ~ level"}, {"study", "spine"}})["snapshot"],
      core::sha256(core::bytes_of(csv)));
}

TEST_F(Cohort, ANameWithCommasAndLineBreaksStaysOneCell) {
  const std::string csv = table();
  EXPECT_EQ(std::ranges::count(csv, '\n'), 8);
  EXPECT_THAT(csv, Not(HasSubstr("Eve")));
  EXPECT_THAT(csv, ContainsRegex(trial_name(8) +
                                 ",P[0-9a-f]+,,,1,,,,1970-01-01,1970.0000,L3,palpation,1,1,7.5\n"));
  EXPECT_EQ(analysed({{"method", "describe"}, {"formula", "score_N ~ rig"}})["data"]["rows"], 7);
}

TEST_F(Cohort, TheTableNamesNobodyAndNoTrial) {
  const std::string csv = table();
  for (int i = 0; i < 9; ++i) EXPECT_THAT(csv, Not(HasSubstr(id_of(i))));
  EXPECT_THAT(csv, Not(HasSubstr(",P1,")));
}

/// Simulated P2 needs to agree to nothing; P1 gave scores by taking part, until a form says less.
TEST_F(Cohort, WhoDoesNotAgreeIsInNoTableAndNoAnalysis) {
  const core::Json question{{"method", "describe"}, {"formula", "score_N ~ level"}};
  EXPECT_EQ(std::ranges::count(table("?study=spine"), '\n'), 7);
  agree("P1", "summary");
  const std::string csv = table("?study=spine");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
  EXPECT_THAT(csv, Not(HasSubstr(person_name("P1"))));
  const auto answer = analysed(question);
  EXPECT_EQ(answer["data"]["rows"], 4) << answer.dump();
  EXPECT_EQ(answer["data"]["left_out"]["without_consent"], 4);
}

TEST_F(Cohort, WhoseTrialsAreNotDoneIsInNoTableAndNoAnalysis) {
  reopen("P2");
  EXPECT_THAT(table(), Not(HasSubstr(person_name("P2"))));
  const auto answer = analysed({{"method", "describe"}, {"formula", "score_N ~ rig"}});
  EXPECT_EQ(answer["data"]["rows"], 4) << answer.dump();
  EXPECT_EQ(answer["data"]["left_out"]["blind"], 4);
  EXPECT_EQ(get("trainees/P2").status, 404);
  EXPECT_EQ(json(get("trainees/P1"))["trials"], 3);
}

TEST_F(Cohort, DataFrozenBeforeAWithdrawalAreHandedOutNoMore) {
  const std::string id = json(post("plans", {{"plan", plan()}, {"study", "spine"}}))["id"];
  const auto first = analysed({{"plan", id}});
  ASSERT_EQ(first["state"], "done") << first.dump();
  const std::string data = "analyses/" + first["id"].get<std::string>() + "/data.csv";
  EXPECT_EQ(get(data).status, 200);
  agree("P1", "none");
  EXPECT_EQ(get(data).status, 403);
  const auto again = post("analyses", {{"plan", id}, {"snapshot", first["snapshot"]}});
  EXPECT_EQ(again.status, 403) << text(again);
  EXPECT_EQ(get("analyses/" + first["id"].get<std::string>() + "/result.json").status, 200);
}

TEST_F(Cohort, WithoutTheKeyOfPseudonymsThereIsNoTableAndNoAnalysis) {
  backend_.pseudonym_key.reset();
  EXPECT_EQ(get("table").status, 503);
  EXPECT_EQ(analysed({{"method", "describe"}, {"formula", "score_N ~ rig"}})["state"], "failed");
}

/// Of a study whose participant is not through, nobody sees a trial, whoever they are.
TEST_F(Cohort, ABlindTrialIsShownToNobody) {
  const auto trial = [&](const std::string& tail) {
    return ask(request("GET", "/api/v1/trials/" + id_of(4) + tail, own_)).status;
  };
  const auto listed = [&] {
    return text(ask(request("GET", "/api/v1/trials", own_))).find(id_of(4)) != std::string::npos;
  };
  EXPECT_TRUE(listed());
  EXPECT_EQ(trial("/comments"), 200);
  reopen("P2");
  EXPECT_FALSE(listed());
  for (const char* tail : {"", "/signals", "/path", "/force-depth", "/comments", "/references"})
    EXPECT_EQ(trial(tail), 403) << tail;
  const auto study = json(ask(request("GET", "/api/v1/studies/spine", own_)));
  for (const auto& person : study["participants"]) {
    const bool through = person["name"] == "P1";
    EXPECT_EQ(person["judged"], through ? 3 : 0);
    if (through) continue;
    for (const auto& slot : person["slots"])
      for (const auto& one : slot["trials"]) EXPECT_EQ(one["correct"], nullptr);
  }
  EXPECT_EQ(study["seed"], nullptr);
}

/// An example that was offered before its participant had to go on is not shown meanwhile.
TEST_F(Cohort, ABlindTrialIsNobodysExample) {
  const auto offered = [&] {
    return json(ask(request("GET", "/api/v1/trials/" + id_of(0) + "/references", own_)))["trials"];
  };
  const auto offer = ask(request("POST", "/api/v1/trials/" + id_of(4) + "/reference", own_,
                                 core::Json{{"reference", true}}.dump()));
  ASSERT_EQ(offer.status, 200) << text(offer);
  EXPECT_EQ(offered().size(), 1u);
  reopen("P2");
  EXPECT_EQ(offered().size(), 0u);
  EXPECT_EQ(
      ask(request("GET", "/api/v1/trials/" + id_of(0) + "/references/" + id_of(4), own_)).status,
      403);
}

TEST_F(Cohort, RefusesWhatIsWrongAndNamesIt) {
  const auto refused = [&](const core::Json& asked) {
    const auto response = post("analyses", asked);
    EXPECT_EQ(response.status, 400) << asked.dump();
    return json(response).value("error", "");
  };
  const std::string formula = "score_N ~ level";
  EXPECT_THAT(refused({{"formula", formula}}), HasSubstr("method"));
  EXPECT_THAT(refused({{"method", "tarot"}, {"formula", formula}}), HasSubstr("tarot"));
  EXPECT_THAT(refused({{"method", "anova"}}), HasSubstr("formula"));
  EXPECT_THAT(refused({{"method", "anova"}, {"formula", "score_N ~ "}}), HasSubstr("formula"));
  EXPECT_THAT(refused({{"method", "anova"}, {"formula", formula}, {"study", "knee"}}),
              HasSubstr("knee"));
  EXPECT_THAT(refused({{"method", "anova"}, {"formula", formula}, {"options", {{"hue", 1}}}}),
              HasSubstr("hue"));
  EXPECT_THAT(refused({{"method", "anova"}, {"formula", formula}, {"options", 3}}),
              HasSubstr("options"));
  EXPECT_THAT(refused({{"method", "anova"}, {"formula", formula}, {"colour", "red"}}),
              HasSubstr("colour"));
  EXPECT_THAT(refused({{"plan", "none"}}), HasSubstr("none"));
  EXPECT_THAT(refused({{"plan", "none"}, {"method", "anova"}}), HasSubstr("method"));
  EXPECT_EQ(woken_, 0);
  EXPECT_EQ(get("table?study=knee").status, 404);
  EXPECT_EQ(get("analyses/none").status, 404);
  EXPECT_EQ(get("plans/none").status, 404);
  // A column that is not there is known when the table is: the run fails and says so.
  const auto failed = analysed({{"method", "anova"}, {"formula", "luck ~ level"}});
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_THAT(failed["error"].get<std::string>(), HasSubstr("luck"));
  const std::string id = failed["id"];
  EXPECT_EQ(get("analyses/" + id + "/report.html").status, 404);
  EXPECT_EQ(get("analyses/" + id + "/dictionary.json").status, 404);
}

TEST_F(Cohort, StopsAnAnalysisThatWaitsOrRuns) {
  const core::Json asked{{"method", "anova"}, {"formula", "score_N ~ level"}};
  const auto queued = [&] { return json(post("analyses", asked)).value("id", ""); };
  const auto done = [&](const std::string& id, const std::function<bool()>& ending) {
    return jobs::analyse(store_, objects_, backend_.pseudonym_key, id, ending);
  };
  const auto stop = [&](const std::string& id) {
    return ask(request("POST", "/api/v1/cohort/analyses/" + id + "/stop", own_, ""));
  };
  const std::string waiting = queued();
  const auto stopped = stop(waiting);
  EXPECT_EQ(stopped.status, 200) << text(stopped);
  EXPECT_EQ(json(stopped)["state"], "cancelled");
  EXPECT_THAT(json(stopped).value("error", ""), HasSubstr("stopped by "));
  EXPECT_TRUE(done(waiting, [] { return false; }));
  EXPECT_EQ(json(get("analyses/" + waiting))["state"], "cancelled") << "its job does nothing";

  const std::string running = queued();
  const auto ended = done(running, [&] {
    stop(running);
    return false;
  });
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().code, core::Errc::cancelled);
  EXPECT_EQ(json(get("analyses/" + running))["state"], "cancelled");

  const std::string finished = analysed(asked)["id"];
  EXPECT_EQ(stop(finished).status, 200);
  EXPECT_EQ(json(get("analyses/" + finished))["state"], "done");
  EXPECT_EQ(stop("none").status, 404);
}

TEST_F(Cohort, TellsHowFarATraineeIsByTheTrialsThatCountAlone) {
  // Right, wrong, right. By hand: a right answer adds ln(0.90/0.75), a wrong one ln(0.10/0.25),
  // never below zero; Wilson's 95 % interval of 2 in 3 is 0.2077 to 0.9385.
  const auto one = json(get("trainees/P1"));
  EXPECT_EQ(one["trials"], 3);
  EXPECT_EQ(one["right"], 2);
  EXPECT_NEAR(one["wilson_low"].get<double>(), 0.2077, 1e-4);
  EXPECT_NEAR(one["wilson_high"].get<double>(), 0.9385, 1e-4);
  EXPECT_EQ(one["state"], "learning");
  EXPECT_EQ(one["certified"], false);
  ASSERT_EQ(one["attempts"].size(), 3U);
  const double up = std::log(0.90 / 0.75);
  EXPECT_NEAR(one["attempts"][0]["sum"].get<double>(), up, 1e-12);
  EXPECT_EQ(one["attempts"][1]["sum"], 0.0);
  EXPECT_NEAR(one["attempts"][2]["sum"].get<double>(), up, 1e-12);
  EXPECT_TRUE(one["attempts"][0]["confidence"].is_null());
  EXPECT_EQ(one["calibration"].size(), 0U);
}

TEST_F(Cohort, ListsTraineesByNameAndSaysWhoIsAMachine) {
  const auto all = json(get("trainees?study=spine"))["trainees"];
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0]["trainee"], "P1");
  EXPECT_EQ(all[0]["simulated"], false);
  EXPECT_EQ(all[1]["trainee"], "P2");
  EXPECT_EQ(all[1]["simulated"], true);
  EXPECT_EQ(json(get("trainees"))["trainees"].size(), 3U);  // the trial of no study too
}

TEST_F(Cohort, KnowsNoTraineeAndNoStudyThatIsNotThere) {
  EXPECT_EQ(get("trainees/P9").status, 404);
  EXPECT_EQ(get("trainees?study=none").status, 400);
}

}  // namespace
}  // namespace api::testing
}  // namespace tractus
