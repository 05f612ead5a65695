/// The list of trials: searched, filtered, sorted and in parts.
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
            "correct = null where operator_name <> 'P-tom'"})
        TRY(tx.query(sql));
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

TEST_F(FindTrials, SortsAndGivesParts) {
  EXPECT_EQ(people("sort=person&order=ascending"), (People{"tia", "tom"}));
  EXPECT_EQ(people("sort=duration&order=ascending"), (People{"tia", "tom"}));
  EXPECT_EQ(people("sort=started&order=ascending"), (People{"tom", "tia"}));
  const Json part = found("dora", "limit=1&offset=1");
  EXPECT_EQ(part["trials"].size(), 1u);
  EXPECT_EQ(part["total"], 2);
  EXPECT_EQ(part["more"], false);
  EXPECT_EQ(found("dora", "limit=1")["more"], true);
}

TEST_F(FindTrials, ReachesNobodysTrialsBesideThoseOfTheCaller) {
  EXPECT_EQ(found("fay", "search=tia")["total"], 0);
  EXPECT_EQ(found("tom", "")["total"], 1);
  EXPECT_EQ(found("tom", "search=tia")["total"], 0);
}

TEST_F(FindTrials, RefusesWordsThatItDoesNotKnow) {
  for (const char* query : {"sort=size", "order=up", "answer=maybe", "offset=-1"})
    EXPECT_EQ(get("dora", std::string("/trials?") + query).status, 400) << query;
  EXPECT_EQ(get("dora", "/trials?search=" + std::string(201, 'a')).status, 400);
}

}  // namespace
}  // namespace api
}  // namespace tractus
