/// The columns of the cohort's table that say who did a trial, where and when.
#include <gmock/gmock.h>

#include "db/store/people/consent.hpp"
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// tom did two trials, tia one; both agree.
class CohortColumns : public PeopleTest {
 protected:
  CohortColumns() {
    backend_.pseudonym_key.emplace();
    backend_.pseudonym_key->fill(std::byte{7});
    const auto set = store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(store::set_assessment(tx, trial_of("tom"), {}, true, "{}"));
      TRY(store::set_assessment(tx, trial_of("tia"), {}, false, "{}"));
      // date -u -d 2026-07-02T09:00 +%s
      TRY(tx.query("update trials set started_utc_us = ? where id = ?",
                   {std::int64_t{1'782'982'800'000'000}, trial_of("tom")}));
      for (const char* who : {"tom", "tia"})
        TRY(store::set_consent(tx, {.account_id = who,
                                    .study_id = "",
                                    .participant = "",
                                    .tier = store::Tier::metrics,
                                    .basis = "own word",
                                    .noted_utc_us = 0,
                                    .noted_by = who}));
      return {};
    });
    EXPECT_TRUE(set) << set.error().what;
  }
  std::string table(const char* who, int status = 200) {
    const auto answer = get(who, "/cohort/table");
    EXPECT_EQ(answer.status, status) << text(answer);
    return text(answer);
  }
};

TEST_F(CohortColumns, NameTheCohortTheDayAndTheRunningNumber) {
  const std::string csv = table("dora");
  EXPECT_THAT(csv, HasSubstr("trial,participant,study,number,running_number,cohort,level,"
                             "experience_years,date,year,case,rig,simulated,correct\n"));
  // Day 183 of 365: 182 / 365 = 0.4986.
  EXPECT_THAT(csv, HasSubstr(",a-tom,1,1,c-tom,,,2026-07-02,2026.4986,L3,palpation,0,1\n"));
  EXPECT_THAT(csv, HasSubstr(",a-tia,1,1,c-tia,,,1970-01-01,1970.0000,L3,palpation,0,0\n"));
  EXPECT_THAT(csv, Not(HasSubstr("P-tom")));
}

TEST_F(CohortColumns, TakeTheCohortOfTheAssignmentBeforeAnother) {
  const auto moved = store_.write([&](store::Writing& tx) -> core::Result<void> {
    TRY(store::take_from_cohort(tx, "c-tom", "tom"));
    TRY(store::put_into_cohort(tx, "c-tia", "tom", store::CohortPart::trainee, 5));
    return {};
  });
  ASSERT_TRUE(moved) << moved.error().what;
  EXPECT_THAT(table("dora"), HasSubstr(",a-tom,1,1,c-tom,"));
  const auto none = store_.write([&](store::Writing& tx) {
    return tx.query("update assignments set cohort_id = null where study_id = 'a-tom'");
  });
  ASSERT_TRUE(none) << none.error().what;
  EXPECT_THAT(table("dora"), HasSubstr(",a-tom,1,1,c-tia,"));
}

TEST_F(CohortColumns, AreForDirectorsAndResearchersAlone) {
  for (const char* who : {"ann", "rex", "dora"}) table(who);
  for (const char* who : {"fay", "ted", "tom"}) table(who, 403);
}

}  // namespace
}  // namespace api::testing
}  // namespace tractus
