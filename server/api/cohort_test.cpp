/// The table of a cohort and a method on it, from trials put into the store.
#include <gmock/gmock.h>

#include <cmath>

#include "db/store/study_slots.hpp"
#include "db/store/trials.hpp"
#include "db/store/uploads.hpp"
#include "server/api/api_test_support.hpp"

namespace api::testing {
namespace {

using ::testing::HasSubstr;

/// A study of a resident (P1) and a senior (P2), three trials each that count; the resident has a
/// fourth that does not, the senior a fourth without scores. Beside it a trial of no study.
class Cohort : public ApiTest {
 protected:
  Cohort() {
    const auto made = store_.write([&](store::Writing& tx) -> core::Result<void> {
      const store::Study study{.id = "spine", .title = "", .ordering = "random"};
      if (auto done = store::add_study(tx, study, {kCase}, deed_); !done) return done;
      const std::vector<std::string> cases(4, kCase);
      for (const auto& person :
           {store::Participant{.name = "P1", .level = "resident", .experience_years = 2.5},
            store::Participant{.name = "P2", .level = "senior", .simulated = true}})
        if (auto done = store::add_participant(tx, "spine", person, cases, deed_); !done)
          return done;
      return {};
    });
    EXPECT_TRUE(made);
    const auto slots =
        store_.read([](store::Reading& tx) { return store::study_slots(tx, "spine"); }).value();
    for (int i = 0; i < 8; ++i) add(i, slots[std::size_t(i)].id, values_[std::size_t(i)]);
    add(8, "", 7.5);
    const auto judged = store_.write([&](store::Writing& tx) {
      return store::set_trial_invalid(tx, "spine", id_of(3), {"ada", 3, "phone rang"});
    });
    EXPECT_TRUE(judged) << judged.error().what;
  }

  static std::string id_of(int i) { return std::string(31, '0') + std::to_string(i); }

  /// One trial; without scores when there is no value.
  void add(int i, const std::string& slot, std::optional<double> value) {
    const std::string id = id_of(i), sha(64, char('0' + i));
    store::TrialRecord trial;
    trial.summary.id = id;
    trial.summary.case_id = kCase;
    trial.summary.operator_name = "=HYPERLINK(\"x\"), \nEve";
    trial.summary.simulated = i >= 4 && i < 8;
    trial.summary.started_utc_us = 10 + i;
    trial.station_id = "s1";
    trial.sha256 = sha;
    trial.complete = true;
    trial.header = trial.events = "{}";
    const auto added = store_.write([&](store::Writing& tx) -> core::Result<void> {
      if (auto done = store::add_upload(tx, {id, "s1", kCase, 1, sha, 1, 0, "receiving"}, 1); !done)
        return done;
      if (!slot.empty())
        if (auto done = store::announce_for_slot(tx, id, slot, 1); !done) return done;
      if (auto done = store::add_object(tx, sha, 1, 1); !done) return done;
      if (auto done = store::add_trial(tx, trial, 1); !done) return done;
      if (!slot.empty())
        if (auto done = store::record_for_slot(tx, id, true, deed_); !done) return done;
      if (!value) return {};
      return store::set_assessment(tx, id, {{"score_N", *value, ""}, {"none_s", {}, "no contact"}},
                                   i % 2 == 0, "{}");
    });
    EXPECT_TRUE(added) << added.error().what;
  }

  http::Response analyse(const core::Json& asked) {
    return ask(request("POST", "/api/v1/cohort/analyses", own_, asked.dump()));
  }
  std::string table(const std::string& query = "") {
    const auto response = ask(request("GET", "/api/v1/cohort/table" + query, own_));
    EXPECT_EQ(response.status, 200);
    return text(response);
  }

  const store::Deed deed_{"ada", 1};
  const std::vector<std::optional<double>> values_{1, 2, 3, 1000, 4, 5, 9, std::nullopt};
  const std::map<std::string, std::string> own_{
      {"cookie", cookie()}, {"x-tractus", "1"}, {"content-type", "application/json"}};
};

TEST_F(Cohort, ComparesTwoLevelsAsAHandDoes) {
  const auto response =
      analyse({{"method", "anova"}, {"formula", "score_N ~ level"}, {"study", "spine"}});
  ASSERT_EQ(response.status, 200) << text(response);
  const auto answer = json(response);
  // Means 2 and 6 about 4: between 3·4 + 3·4 = 24 of 1 degree; within 2 + 14 = 16 of 4; F = 24/4.
  const auto& found = answer["report"]["analysis"];
  EXPECT_NEAR(found["F"].get<double>(), 6.0, 1e-12);
  EXPECT_EQ(found["df_within"], 4.0);
  // Student's t of 4 degrees in closed form (Abramowitz & Stegun 26.7.4), t² = 6:
  // sin² = 6/10, cos² = 4/10, p = 1 − sin(1 + cos²/2).
  EXPECT_NEAR(found["p"].get<double>(), 1.0 - std::sqrt(0.6) * 1.2, 1e-9);
  EXPECT_EQ(answer["rows"], 6);
  EXPECT_EQ(answer["rows_simulated"], 3);
  EXPECT_EQ(answer["left_out"]["invalid"], 1);
  EXPECT_EQ(answer["left_out"]["unscored"], 1);
}

TEST_F(Cohort, TheTableIsOneRowPerTrialThatCounts) {
  const std::string head =
      "trial,participant,study,number,level,experience_years,case,rig,simulated,correct,score_N\n";
  const std::string csv = table("?study=spine");
  EXPECT_TRUE(csv.starts_with(head + id_of(0) + ",P1,spine,1,resident,2.5,L3,palpation,0,1,1\n" +
                              id_of(1) + ",P1,spine,2,resident,2.5,L3,palpation,0,0,2\n"))
      << csv;
  EXPECT_THAT(csv, HasSubstr(id_of(4) + ",P2,spine,1,senior,,L3,palpation,1,1,4\n"));
  EXPECT_EQ(std::ranges::count(csv, '\n'), 7);
  EXPECT_EQ(
      json(analyse(
          {{"method", "anova"}, {"formula", "score_N ~ level"}, {"study", "spine"}}))["sha256"],
      core::sha256(core::bytes_of(csv)));
}

TEST_F(Cohort, ANameWithCommasAndLineBreaksStaysOneCell) {
  const std::string csv = table();
  EXPECT_EQ(std::ranges::count(csv, '\n'), 8);
  EXPECT_THAT(csv, HasSubstr(id_of(8) + ",\"'=HYPERLINK('x'),  Eve\",,,,,L3,palpation,0,1,7.5\n"));
  EXPECT_EQ(json(analyse({{"method", "describe"}, {"formula", "score_N ~ rig"}}))["rows"], 7);
}

TEST_F(Cohort, RefusesWhatIsWrongAndNamesIt) {
  const auto refused = [&](const core::Json& asked) {
    const auto response = analyse(asked);
    EXPECT_EQ(response.status, 400) << asked.dump();
    return json(response).value("error", "");
  };
  const std::string formula = "score_N ~ level";
  EXPECT_THAT(refused({{"formula", formula}}), HasSubstr("method"));
  EXPECT_THAT(refused({{"method", "tarot"}, {"formula", formula}}), HasSubstr("tarot"));
  EXPECT_THAT(refused({{"method", "anova"}}), HasSubstr("formula"));
  EXPECT_THAT(refused({{"method", "anova"}, {"formula", "luck ~ level"}}), HasSubstr("luck"));
  EXPECT_THAT(refused({{"method", "anova"}, {"formula", formula}, {"study", "knee"}}),
              HasSubstr("knee"));
  EXPECT_THAT(refused({{"method", "anova"}, {"formula", formula}, {"options", {{"hue", 1}}}}),
              HasSubstr("hue"));
  EXPECT_THAT(refused({{"method", "anova"}, {"formula", formula}, {"options", 3}}),
              HasSubstr("options"));
  EXPECT_THAT(refused({{"method", "anova"}, {"formula", formula}, {"colour", "red"}}),
              HasSubstr("colour"));
  EXPECT_EQ(ask(request("GET", "/api/v1/cohort/table?study=knee", own_)).status, 400);
}

}  // namespace
}  // namespace api::testing
