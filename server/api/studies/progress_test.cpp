/// The progress of cohorts through the routes: what it says, and to whom.
#include "server/api/people/people_test_support.hpp"

namespace tractus {
namespace api {
namespace {
using core::Json;
using testing::PeopleTest;

class ProgressRoutes : public PeopleTest {
 protected:
  ProgressRoutes() {
    const auto set = store_.write([&](store::Writing& tx) -> core::Result<void> {
      for (const char* who : {"tom", "tia"})
        TRY(store::set_assessment(tx, trial_of(who), {{"operation_time", 40.0, ""}},
                                  who == std::string("tom"), "{}"));
      TRY(store::add_account(
          tx, {.id = "lea", .name = "lea", .role = Role::trainee, .password_hash = quick_hash()},
          0));
      return store::put_into_cohort(tx, "c-tom", "lea", store::CohortPart::trainee, 0);
    });
    EXPECT_TRUE(set) << set.error().what;
  }
  Json cohorts(const char* who) {
    const auto answer = get(who, "/cohort/progress");
    EXPECT_EQ(answer.status, 200) << text(answer);
    return json(answer)["cohorts"];
  }
};

TEST_F(ProgressRoutes, ListWhoCameAndWhoNeverCame) {
  const Json of_fay = cohorts("fay");
  ASSERT_EQ(of_fay.size(), 1u);
  EXPECT_EQ(of_fay[0]["name"], "c-tom");
  EXPECT_EQ(of_fay[0]["bins"], Json::array()) << "one trial is not five";
  ASSERT_EQ(of_fay[0]["trainees"].size(), 2u);
  EXPECT_EQ(of_fay[0]["trainees"][0]["trainee"], "lea");
  EXPECT_EQ(of_fay[0]["trainees"][0]["trials"], 0);
  EXPECT_EQ(of_fay[0]["trainees"][0]["last_utc_us"], nullptr);
  const Json& tom = of_fay[0]["trainees"][1];
  EXPECT_EQ(tom["recent_right"], 1);
  EXPECT_EQ(tom["last_utc_us"], 10);
  EXPECT_EQ(tom["others_share"], nullptr) << "nobody else did a trial";
  EXPECT_EQ(tom["behind"], false);
}

TEST_F(ProgressRoutes, CountOnlyActiveTrainees) {
  const auto off = store_.write([&](store::Writing& tx) -> core::Result<void> {
    auto lea = TRY(store::account_of(tx, "lea"));
    lea->state = store::AccountState::disabled;
    return store::set_account(tx, *lea);
  });
  ASSERT_TRUE(off) << off.error().what;
  EXPECT_EQ(cohorts("fay")[0]["trainees"].size(), 1u);
}

TEST_F(ProgressRoutes, ShowFacultyTheCohortsThatTheyLeadAndNoOther) {
  const auto added = store_.write([&](store::Writing& tx) {
    return store::put_into_cohort(tx, "c-tia", "fay", store::CohortPart::trainee, 0);
  });
  ASSERT_TRUE(added) << added.error().what;
  ASSERT_EQ(cohorts("fay").size(), 1u) << "a member of a cohort does not lead it";
  EXPECT_EQ(cohorts("fay")[0]["id"], "c-tom");
  ASSERT_EQ(cohorts("flo").size(), 1u);
  EXPECT_EQ(cohorts("flo")[0]["id"], "c-tia");
  EXPECT_EQ(cohorts("flo").dump().find("tom"), std::string::npos);
  for (const char* who : {"dora", "ann"}) EXPECT_EQ(cohorts(who).size(), 2u) << who;
  for (const char* who : {"rex", "ted", "tom"})
    EXPECT_EQ(get(who, "/cohort/progress").status, 403) << who;
}

}  // namespace
}  // namespace api
}  // namespace tractus
