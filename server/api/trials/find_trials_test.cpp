/// The list of trials: searched, filtered, sorted and in parts.
#include "db/store/trials/summary_row.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::PeopleTest;

class FindTrials : public PeopleTest {
 protected:
  FindTrials() {
    const auto set = store_.write([](store::Writing& tx) -> core::Result<void> {
      for (const char* sql :
           {"update trials set operator_name = 'P-tom', started_utc_us = 10, duration_s = 5, "
            "correct = 1 where id in (select trial_id from study_trials t join study_slots s on "
            "s.id = t.slot_id where s.study_id = 'a-tom')",
            "update trials set operator_name = '50%_hand', started_utc_us = 20, duration_s = 3, "
            "correct = null where operator_name <> 'P-tom'",
            "delete from trial_entries"})
        TRY(tx.query(sql));
      for (const char* trainee : {"tom", "tia"}) TRY(store::add_trial_entry(tx, trial_of(trainee)));
      return {};
    });
    EXPECT_TRUE(set) << set.error().what;
  }
  Json found(const std::string& who, const std::string& query) {
    const auto answer = get(who, "/trials?" + query);
    EXPECT_EQ(answer.status, 200) << text(answer);
    return json(answer);
  }
  std::vector<std::string> people(const std::string& query) {
    std::vector<std::string> out;
    const Json list = found("dora", query);
    for (const Json& trial : list["trials"]) out.push_back(trial["person"]);
    return out;
  }
};
using People = std::vector<std::string>;

TEST_F(FindTrials, NamesThePersonToWhomATrialWasAssigned) {
  EXPECT_EQ(people(""), (People{"tia", "tom"}));  // newest first
}

TEST_F(FindTrials, SearchesPersonOperatorCaseAndStationWithoutRegardToCase) {
  EXPECT_EQ(people("search=TOM"), People{"tom"});
  EXPECT_EQ(people("search=p-t"), People{"tom"});
  EXPECT_EQ(people("search=no%20such"), People{});
  EXPECT_EQ(people("search=0%25_h"), People{"tia"}) << "% and _ are themselves";
  EXPECT_EQ(people("search=0_h"), People{});
}

TEST_F(FindTrials, FiltersByAnswer) {
  EXPECT_EQ(people("answer=correct"), People{"tom"});
  EXPECT_EQ(people("answer=none"), People{"tia"});
  EXPECT_EQ(people("answer=incorrect"), People{});
}

TEST_F(FindTrials, FiltersByState) {
  EXPECT_EQ(people("state=assessing"), (People{"tia", "tom"}));
  EXPECT_EQ(people("state=failed"), People{});
}

TEST_F(FindTrials, SortsAndGivesParts) {
  EXPECT_EQ(people("sort=person&order=ascending"), (People{"tia", "tom"}));
  EXPECT_EQ(people("sort=duration&order=ascending"), (People{"tia", "tom"}));
  EXPECT_EQ(people("sort=started&order=ascending"), (People{"tom", "tia"}));
  const Json first = found("dora", "limit=1");
  EXPECT_EQ(first["trials"][0]["person"], "tia");
  EXPECT_EQ(first["total"], 2);
  EXPECT_EQ(first["more_than_total"], false);
  EXPECT_EQ(first["more"], true);
  EXPECT_EQ(first["previous"], nullptr);
  const Json second = found("dora", "limit=1&cursor=" + first["next"].get<std::string>());
  EXPECT_EQ(second["trials"][0]["person"], "tom");
  EXPECT_EQ(second["more"], false);
  EXPECT_EQ(second["next"], nullptr);
  const Json back = found("dora", "limit=1&cursor=" + second["previous"].get<std::string>());
  EXPECT_EQ(back["trials"], first["trials"]);
  EXPECT_EQ(back["previous"], nullptr);
}

TEST_F(FindTrials, ReachesNobodysTrialsBesideThoseOfTheCaller) {
  EXPECT_EQ(found("fay", "search=tia")["total"], 0);
  EXPECT_EQ(found("tom", "")["total"], 1);
  EXPECT_EQ(found("tom", "search=tia")["total"], 0);
  const std::string behind = found("dora", "limit=1")["next"];
  EXPECT_EQ(found("tom", "limit=1&cursor=" + behind)["trials"].size(), 1u) << "tom's own";
  EXPECT_EQ(found("flo", "limit=1&cursor=" + behind)["trials"].size(), 0u) << "tom is not flo's";
  EXPECT_EQ(found("flo", "limit=1&cursor=" + behind)["total"], 1) << "tia's, whom she teaches";
}

/// The list finds trials by a copy of what they hold: a copy that says more shows no more.
TEST_F(FindTrials, ShowsNobodyATrialByWhatOnlyTheListSays) {
  ASSERT_TRUE(store_.write([](store::Writing& tx) {
    return tx.query("update trial_entries set account_id = 'tom', study_id = 'a-tom'");
  }));
  EXPECT_EQ(found("tom", "")["trials"].size(), 1u);
  EXPECT_EQ(found("fay", "")["trials"].size(), 1u);
}

TEST_F(FindTrials, RefusesWordsThatItDoesNotKnow) {
  for (const char* query :
       {"sort=size", "order=up", "answer=maybe", "state=lost", "offset=1", "limit=201", "cursor=x",
        "cursor=W10", "search=%FF", "sort=", "cursor=%27%20or%201=1--"})
    EXPECT_EQ(get("dora", std::string("/trials?") + query).status, 400) << query;
  const std::string next = found("dora", "limit=1")["next"];
  EXPECT_EQ(get("dora", "/trials?sort=case&cursor=" + next).status, 400);
  EXPECT_EQ(get("dora", "/trials?order=ascending&cursor=" + next).status, 400);
  // A cursor of this order with a text in place of the time: ["started","down","next","x","y"].
  const std::string forged =
      core::base64url(core::bytes_of(R"(["started","down","next","x","y"])"));
  EXPECT_EQ(get("dora", "/trials?cursor=" + forged).status, 400);
  EXPECT_EQ(get("dora", "/trials?search=" + std::string(201, 'a')).status, 400);
}

}  // namespace
}  // namespace api
}  // namespace tractus
